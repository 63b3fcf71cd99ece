//! The metadata of an executor's buffers, and the validation of commands.

use crate::{
    Access, BufferId, Command, DispatchSize, Flag, GpuElement, GpuError, PassDesc, Recording, Shape,
};

/// How passes may bind a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Storage,
    Uniform,
    /// Either, in different passes.
    Either,
}

/// The largest number of bytes of a uniform on every adapter.
const LARGEST_UNIFORM: u64 = 65_536;

/// A buffer's label, element type and length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meta {
    pub label: &'static str,
    pub element: &'static str,
    pub size: usize,
    pub len: usize,
    pub kind: Kind,
}

impl Meta {
    pub fn new<T: GpuElement>(label: &'static str, len: usize, kind: Kind) -> Self {
        Self { label, element: T::WGSL, size: size_of::<T>(), len, kind }
    }

    /// WebGPU cannot bind an empty buffer, so the smallest has the size of one element.
    pub fn bytes(&self) -> u64 {
        self.size as u64 * self.len.max(1) as u64
    }

    /// Rejects more elements than the 32-bit indices of passes can address, and more bytes than a uniform may have.
    pub fn check_len(&self) -> Result<(), GpuError> {
        let fits = match self.kind {
            Kind::Storage => u64::from(u32::MAX),
            Kind::Uniform | Kind::Either => LARGEST_UNIFORM / self.size as u64,
        };
        if self.len as u64 <= fits {
            return Ok(());
        }
        Err(GpuError::TooLarge {
            label: self.label.into(),
            len: self.len as u64,
            bytes: self.bytes(),
            limit: fits * self.size as u64,
            fits,
        })
    }
}

#[derive(Default)]
pub(crate) struct Table {
    /// By slot; `None` for a freed buffer.
    entries: Vec<Option<(BufferId, Meta)>>,
    free_slots: Vec<u32>,
    pub poison: bool,
}

impl Table {
    pub fn add(&mut self, meta: Meta) -> BufferId {
        let slot = self.free_slots.pop().unwrap_or_else(|| {
            self.entries.push(None);
            self.entries.len() as u32 - 1
        });
        let id = BufferId::new(slot, meta.label);
        self.entries[slot as usize] = Some((id, meta));
        id
    }

    /// Removes a buffer. Its slot is reused, its identifier is not.
    pub fn remove(&mut self, id: BufferId) {
        self.entries[id.slot as usize] = None;
        self.free_slots.push(id.slot);
    }

    pub fn replace(&mut self, id: BufferId, meta: Meta) {
        self.entries[id.slot as usize] = Some((id, meta));
    }

    /// The metadata of a buffer; `None` if it was freed or belongs to another executor.
    pub fn find(&self, id: BufferId) -> Option<&Meta> {
        let (known, meta) = self.entries.get(id.slot as usize)?.as_ref()?;
        (*known == id).then_some(meta)
    }

    pub fn get(&self, id: BufferId) -> Result<&Meta, GpuError> {
        self.find(id).ok_or_else(|| GpuError::NoSuchBuffer { label: id.label().into() })
    }

    pub fn bytes(&self) -> u64 {
        self.entries.iter().flatten().map(|(_, meta)| meta.bytes()).sum()
    }

    /// The byte that new buffers are filled with.
    pub fn fill(&self) -> u8 {
        if self.poison { 0xff } else { 0 }
    }

    /// Validates every command against its buffers, so that executors need no further checks.
    pub fn check(&self, recording: &Recording) -> Result<(), GpuError> {
        if let Some((pass, reason)) = &recording.error {
            return Err(GpuError::BadBinding { pass, reason: reason.clone() });
        }
        let bad = |reason| GpuError::BadCommand { recording: recording.label.clone(), reason };
        self.check_commands(&recording.commands, &mut Vec::new(), &bad)
    }

    /// `flags`: the flags of the enclosing repetitions.
    fn check_commands(
        &self,
        commands: &[Command],
        flags: &mut Vec<Flag>,
        bad: &impl Fn(String) -> GpuError,
    ) -> Result<(), GpuError> {
        for command in commands {
            match command {
                Command::Dispatch { pass, size, buffers } => {
                    self.check_dispatch(pass, buffers)?;
                    let misses = |flag: &&Flag| !buffers.contains(&flag.buffer) && !flag.excepts(pass.label);
                    if let Some(Flag { buffer: flag, .. }) = flags.iter().find(misses) {
                        return Err(bad(format!(
                            "pass {} is repeated until a flag in {flag:?} is set, but does not bind that buffer: on a \
                             GPU it would not stop",
                            pass.label
                        )));
                    }
                    if let DispatchSize::Indirect { buffer, word } = *size {
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
                Command::Copy { .. } | Command::Clear { .. } if !flags.is_empty() => {
                    return Err(bad(
                        "a copy or clear is repeated until a flag is set: on a GPU it would not stop".into(),
                    ));
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
                Command::Repeat { body, until, .. } => {
                    self.check_words(until.buffer, until.word, 1).map_err(bad)?;
                    flags.push(*until);
                    self.check_commands(body, flags, bad)?;
                    flags.pop();
                }
            }
        }
        Ok(())
    }

    fn known(&self, id: BufferId) -> Result<&Meta, String> {
        self.get(id).map_err(|error| error.to_string())
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
            let meta =
                self.known(*id).map_err(|reason| bad(format!("binding {:?}: {reason}", binding.name)))?;
            if binding.element != meta.element || binding.size != meta.size {
                return Err(bad(format!(
                    "binding {:?} has elements of type {}, which {meta} has not",
                    binding.name, binding.element
                )));
            }
            let needed = match binding.shape {
                Shape::Array => 0,
                Shape::One => 1,
                Shape::Fixed(len) => len,
            };
            if meta.len < needed {
                return Err(bad(format!(
                    "binding {:?} has {needed} elements, more than {meta}",
                    binding.name
                )));
            }
            let is_uniform = binding.access == Access::Uniform;
            if meta.kind != Kind::Either && is_uniform != (meta.kind == Kind::Uniform) {
                return Err(bad(format!("binding {:?} and {meta}: only one is a uniform", binding.name)));
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
