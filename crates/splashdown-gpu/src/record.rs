//! Recordings: lists of commands over buffers, independent of the executor.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::{Buffer, BufferId, BufferSet, GpuElement, PassDesc};

/// One 32-bit word of a buffer that ends a repetition when it is not zero.
#[derive(Clone, Copy, Debug)]
pub struct Flag {
    /// The buffer.
    pub buffer: BufferId,
    /// The index of the word in the buffer.
    pub word: u32,
    /// Prefixes of the labels of passes that need not read the flag: see [`Flag::except`].
    pub(crate) repeatable: &'static [&'static str],
}

impl Flag {
    /// The word at `byte_offset` (use `core::mem::offset_of!`) of a buffer that holds one struct.
    pub fn new<T: GpuElement>(buffer: Buffer<T>, byte_offset: usize) -> Self {
        Self { buffer: buffer.id, word: (byte_offset / 4) as u32, repeatable: &[] }
    }

    /// Passes whose labels have one of these prefixes need not bind the flag's buffer: their output depends only on their
    /// input, so running them again after the flag is set has no effect.
    #[must_use]
    pub fn except(self, labels: &'static [&'static str]) -> Self {
        Self { repeatable: labels, ..self }
    }

    /// True if a pass with this label need not bind the flag's buffer.
    pub(crate) fn excepts(&self, label: &str) -> bool {
        self.repeatable.iter().any(|start| label.starts_with(start))
    }
}

/// The number of rounds of a repetition per submission. The host may change it between submissions without recording
/// again: clones share it.
///
/// A GPU cannot skip the rounds after the one that sets the flag; each costs a dispatch without effect. So the host sets
/// the number slightly above the rounds that the last submission needed.
#[derive(Clone, Debug)]
pub struct Rounds {
    most: u32,
    current: Arc<AtomicU32>,
}

impl Rounds {
    /// `most` rounds, until [`set`](Self::set) selects fewer.
    pub fn new(most: u32) -> Self {
        Self { most, current: Arc::new(AtomicU32::new(most)) }
    }

    /// Sets the number of rounds of the next submissions, limited to [`most`](Self::most).
    pub fn set(&self, rounds: u32) {
        self.current.store(rounds.min(self.most), Ordering::Relaxed);
    }

    /// The number of rounds of the next submission.
    pub fn get(&self) -> u32 {
        self.current.load(Ordering::Relaxed)
    }

    /// The largest number of rounds.
    pub fn most(&self) -> u32 {
        self.most
    }
}

/// The number of invocations or workgroups of a dispatch.
#[derive(Clone, Copy, Debug)]
pub enum DispatchSize {
    /// This many invocations in one dimension. Past 65,535 workgroups the GPU uses two dimensions, so shaders compute
    /// their index with `#import gpu/index` and compare it with the number of items themselves.
    Items(u32),
    /// This many workgroups, numbered likewise.
    Groups(u32),
    /// The number of workgroups in each dimension is read from three words of a buffer when the command runs.
    Indirect {
        /// A buffer of `u32`.
        buffer: BufferId,
        /// The index of the first of the three words.
        word: u32,
    },
}

impl DispatchSize {
    /// The number of workgroups in the first three words of this buffer.
    pub fn indirect(buffer: Buffer<u32>) -> Self {
        Self::Indirect { buffer: buffer.id, word: 0 }
    }
}

/// The largest number of workgroups in one dimension of a dispatch, on every adapter.
const MAX_GROUPS: u32 = 65_535;

/// Splits a number of workgroups so that no dimension exceeds 65,535; the last row may be longer than needed.
pub fn dispatch_groups(groups: u32) -> [u32; 3] {
    let rows = groups.div_ceil(MAX_GROUPS).max(1);
    [groups.div_ceil(rows), rows, 1]
}

/// One entry of a [`Recording`].
#[derive(Clone, Debug)]
pub enum Command {
    /// Run a pass.
    Dispatch {
        /// The pass.
        pass: &'static PassDesc,
        /// The size of the dispatch.
        size: DispatchSize,
        /// The buffers, in the order of [`PassDesc::bindings`].
        buffers: Vec<BufferId>,
    },
    /// Copy a whole buffer into the beginning of another one.
    Copy {
        /// Source.
        from: BufferId,
        /// Destination, at least as long.
        to: BufferId,
    },
    /// Set every byte of a buffer to zero.
    Clear {
        /// The buffer.
        buffer: BufferId,
    },
    /// Run the body until the flag is set, at most as often as `rounds` says.
    ///
    /// The CPU tests the flag before every round. A GPU runs all rounds in one submission; the passes of the body read the
    /// flag and do nothing once it is set. Therefore each of them must bind the flag's buffer, and the body must not
    /// contain copies or clears, which cannot read a flag.
    Repeat {
        /// The commands of a round.
        body: Vec<Command>,
        /// The number of rounds, which the host may change between submissions.
        rounds: Rounds,
        /// When to stop.
        until: Flag,
    },
}

/// A list of commands with a name.
#[derive(Clone, Debug)]
pub struct Recording {
    /// The name, shown in graphics debuggers and errors.
    pub label: String,
    /// The commands, in order; each sees the writes of earlier ones.
    pub commands: Vec<Command>,
    /// The first dispatch with a missing buffer: the pass and the reason.
    pub(crate) error: Option<(&'static str, String)>,
}

impl Recording {
    /// An empty list.
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), commands: Vec::new(), error: None }
    }

    /// Appends a dispatch; every binding of the pass gets the buffer of its name. If the set has no such buffer, running
    /// the recording is an error that names pass and binding.
    pub fn dispatch(&mut self, pass: &'static PassDesc, size: DispatchSize, buffers: &BufferSet) {
        match pass.bindings.iter().map(|binding| buffers.find(binding.name)).collect() {
            Ok(buffers) => self.commands.push(Command::Dispatch { pass, size, buffers }),
            Err(reason) => self.note(Some((pass.label, reason))),
        }
    }

    /// Appends a copy of all of `from` to the beginning of `to`.
    pub fn copy<T>(&mut self, from: Buffer<T>, to: Buffer<T>) {
        self.commands.push(Command::Copy { from: from.id, to: to.id });
    }

    /// Appends a clear to zero.
    pub fn clear<T>(&mut self, buffer: Buffer<T>) {
        self.commands.push(Command::Clear { buffer: buffer.id });
    }

    /// Appends all of another recording.
    pub fn append(&mut self, other: &Recording) {
        self.commands.extend(other.commands.iter().cloned());
        self.note(other.error.clone());
    }

    /// Appends a bounded repetition of another recording; see [`Command::Repeat`].
    pub fn repeat(&mut self, body: &Recording, rounds: &Rounds, until: Flag) {
        self.commands.push(Command::Repeat { body: body.commands.clone(), rounds: rounds.clone(), until });
        self.note(body.error.clone());
    }

    fn note(&mut self, error: Option<(&'static str, String)>) {
        self.error = self.error.take().or(error);
    }
}

#[cfg(test)]
mod tests {
    use super::dispatch_groups;

    #[test]
    fn dispatch_groups_respects_the_limit_and_covers_all_groups() {
        for groups in [1, 65_535, 65_536, 131_070, 131_071, 1 << 24, 3_000_000_000] {
            let [x, y, z] = dispatch_groups(groups);
            assert!(x <= 65_535 && y <= 65_535 && z == 1, "{groups}: {x} x {y}");
            assert!(u64::from(x) * u64::from(y) >= u64::from(groups));
        }
        assert_eq!(dispatch_groups(65_535), [65_535, 1, 1]);
        assert_eq!(dispatch_groups(0), [0, 1, 1]);
    }
}
