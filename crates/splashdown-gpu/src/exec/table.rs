//! What both executors know about their buffers, and the check of a dispatch against it.

use crate::{Access, BufferId, GpuElement, GpuError, PassDesc};

/// A buffer's name, type and length.
#[derive(Clone, Debug)]
pub(crate) struct Meta {
    pub label: String,
    pub element: &'static str,
    pub size: usize,
    pub len: usize,
    pub uniform: bool,
}

impl Meta {
    pub fn new<T: GpuElement>(label: &str, len: usize, uniform: bool) -> Self {
        Self { label: label.to_owned(), element: T::WGSL, size: size_of::<T>(), len, uniform }
    }

    /// WebGPU binds no empty buffers, so the smallest has room for one element.
    pub fn bytes(&self) -> usize {
        self.size * self.len.max(1)
    }
}

#[derive(Default)]
pub(crate) struct Table {
    metas: Vec<Meta>,
    pub poison: bool,
}

impl Table {
    pub fn add(&mut self, meta: Meta) -> BufferId {
        self.metas.push(meta);
        BufferId(self.metas.len() as u32 - 1)
    }

    pub fn get(&self, id: BufferId) -> &Meta {
        &self.metas[id.0 as usize]
    }

    pub fn get_mut(&mut self, id: BufferId) -> &mut Meta {
        &mut self.metas[id.0 as usize]
    }

    pub fn bytes(&self) -> u64 {
        self.metas.iter().map(|meta| meta.bytes() as u64).sum()
    }

    /// The byte that new buffers are filled with.
    pub fn fill(&self) -> u8 {
        if self.poison { 0xff } else { 0 }
    }

    /// Compares a dispatch's buffers with the pass's declaration.
    pub fn check(&self, pass: &'static PassDesc, buffers: &[BufferId]) -> Result<(), GpuError> {
        let bad = |reason| Err(GpuError::BadBinding { pass: pass.label, reason });
        if buffers.len() != pass.bindings.len() {
            return bad(format!("{} buffers given, {} declared", buffers.len(), pass.bindings.len()));
        }
        for (i, (binding, id)) in pass.bindings.iter().zip(buffers).enumerate() {
            let meta = self.get(*id);
            if binding.element != meta.element || binding.size != meta.size {
                return bad(format!(
                    "binding {:?} is of {}, buffer {:?} of {}",
                    binding.name, binding.element, meta.label, meta.element
                ));
            }
            if (binding.access == Access::Uniform) != meta.uniform {
                return bad(format!(
                    "binding {:?} and buffer {:?}: one is a uniform",
                    binding.name, meta.label
                ));
            }
            let twice = buffers[..i].iter().zip(pass.bindings).any(|(other, other_binding)| {
                other == id && [binding.access, other_binding.access].contains(&Access::ReadWrite)
            });
            if twice {
                return bad(format!("buffer {:?} is bound twice and written", meta.label));
            }
        }
        Ok(())
    }
}
