//! What both executors know about their buffers, and the check of a dispatch against it.

use crate::{Access, BufferId, Command, Flag, GpuElement, GpuError, Grid, PassDesc, Recording};

/// How passes may bind a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Storage,
    Uniform,
    /// As either, in turn.
    Either,
}

/// Most bytes of a uniform on every adapter.
const LARGEST_UNIFORM: u64 = 65_536;

/// A buffer's name, type and length.
#[derive(Clone, Debug)]
pub(crate) struct Meta {
    pub label: String,
    pub element: &'static str,
    pub size: usize,
    pub len: usize,
    pub kind: Kind,
}

impl Meta {
    pub fn new<T: GpuElement>(label: &str, len: usize, kind: Kind) -> Self {
        Self { label: label.to_owned(), element: T::WGSL, size: size_of::<T>(), len, kind }
    }

    /// WebGPU binds no empty buffers, so the smallest has room for one element.
    pub fn bytes(&self) -> u64 {
        self.size as u64 * self.len.max(1) as u64
    }

    /// Refuses more elements than 32-bit numbers can tell apart, which passes have no others than, and more
    /// bytes than a uniform may have.
    pub fn check_len(&self) -> Result<(), GpuError> {
        let fits = match self.kind {
            Kind::Storage => u64::from(u32::MAX),
            Kind::Uniform | Kind::Either => LARGEST_UNIFORM / self.size as u64,
        };
        if self.len as u64 <= fits {
            return Ok(());
        }
        Err(GpuError::TooLarge {
            label: self.label.clone(),
            len: self.len as u64,
            bytes: self.bytes(),
            limit: fits * self.size as u64,
            fits,
        })
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
        self.metas.iter().map(Meta::bytes).sum()
    }

    /// The byte that new buffers are filled with.
    pub fn fill(&self) -> u8 {
        if self.poison { 0xff } else { 0 }
    }

    /// Compares every command with the buffers it names, so that an executor need not look again.
    pub fn check(&self, recording: &Recording) -> Result<(), GpuError> {
        let bad = |reason| GpuError::BadCommand { recording: recording.label.clone(), reason };
        self.check_commands(&recording.commands, &bad)
    }

    fn check_commands(
        &self,
        commands: &[Command],
        bad: &impl Fn(String) -> GpuError,
    ) -> Result<(), GpuError> {
        for command in commands {
            match command {
                Command::Dispatch { pass, grid, buffers } => {
                    self.check_dispatch(pass, buffers)?;
                    if let Grid::Indirect { buffer, word } = *grid {
                        self.check_words(buffer, word, 3).map_err(bad)?;
                        let written = buffers
                            .iter()
                            .zip(pass.bindings)
                            .any(|(id, binding)| *id == buffer && binding.access == Access::ReadWrite);
                        if written {
                            return Err(bad(format!(
                                "pass {} writes to its own indirect arguments",
                                pass.label
                            )));
                        }
                    }
                }
                Command::Copy { from, to } => {
                    let (source, target) = (self.known(*from).map_err(bad)?, self.known(*to).map_err(bad)?);
                    if from == to || source.element != target.element || source.len > target.len {
                        return Err(bad(format!("{source} cannot be copied to {target}")));
                    }
                }
                Command::Clear { buffer } => {
                    self.known(*buffer).map_err(bad)?;
                }
                Command::Repeat { body, until: Flag { buffer, word }, .. } => {
                    self.check_words(*buffer, *word, 1).map_err(bad)?;
                    self.check_commands(body, bad)?;
                }
            }
        }
        Ok(())
    }

    fn known(&self, id: BufferId) -> Result<&Meta, String> {
        self.metas.get(id.0 as usize).ok_or_else(|| format!("buffer #{} is not of this executor", id.0))
    }

    fn check_words(&self, id: BufferId, word: u32, count: u64) -> Result<(), String> {
        let meta = self.known(id)?;
        if (u64::from(word) + count) * 4 > meta.size as u64 * meta.len as u64 {
            return Err(format!("{meta} has no {count} words from word {word} on"));
        }
        Ok(())
    }

    fn check_dispatch(&self, pass: &'static PassDesc, buffers: &[BufferId]) -> Result<(), GpuError> {
        let bad = |reason| GpuError::BadBinding { pass: pass.label, reason };
        if buffers.len() != pass.bindings.len() {
            return Err(bad(format!("{} buffers given, {} declared", buffers.len(), pass.bindings.len())));
        }
        for (i, (binding, id)) in pass.bindings.iter().zip(buffers).enumerate() {
            let meta = self.known(*id).map_err(bad)?;
            if binding.element != meta.element || binding.size != meta.size {
                return Err(bad(format!(
                    "binding {:?} is of {}, and given is {meta}",
                    binding.name, binding.element
                )));
            }
            let is_uniform = binding.access == Access::Uniform;
            if meta.kind != Kind::Either && is_uniform != (meta.kind == Kind::Uniform) {
                return Err(bad(format!("binding {:?} and {meta}: one is a uniform", binding.name)));
            }
            let twice = buffers[..i].iter().zip(pass.bindings).any(|(other, other_binding)| {
                other == id && [binding.access, other_binding.access].contains(&Access::ReadWrite)
            });
            if twice {
                return Err(bad(format!("{meta} is bound twice and written")));
            }
        }
        Ok(())
    }
}

impl std::fmt::Display for Meta {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "buffer {:?} of {} {}", self.label, self.len, self.element)
    }
}
