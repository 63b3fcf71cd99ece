//! A list of commands over buffers: what a step is, before anybody executes it.

use std::marker::PhantomData;

use crate::{GpuElement, PassDesc};

/// Names a buffer of one [`Executor`](crate::Executor).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BufferId(pub(crate) u32);

/// A buffer of `T` in one [`Executor`](crate::Executor). A plain handle: copying it copies no data.
pub struct Buffer<T> {
    pub(crate) id: BufferId,
    pub(crate) len: u32,
    pub(crate) element: PhantomData<fn() -> T>,
}

impl<T> Clone for Buffer<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Buffer<T> {}

impl<T> std::fmt::Debug for Buffer<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Buffer#{}[{}]", self.id.0, self.len)
    }
}

impl<T> Buffer<T> {
    /// The name by which commands refer to it.
    pub fn id(&self) -> BufferId {
        self.id
    }

    /// Number of elements.
    pub fn len(&self) -> u32 {
        self.len
    }

    /// True if it has no elements.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
}

/// One 32-bit word of a buffer that says "stop" when it is not zero.
#[derive(Clone, Copy, Debug)]
pub struct Flag {
    /// The buffer.
    pub buffer: BufferId,
    /// The word's place in the buffer, in words.
    pub word: u32,
}

impl Flag {
    /// The word at `byte_offset` (use `core::mem::offset_of!`) of a buffer that holds one struct.
    pub fn new<T: GpuElement>(buffer: Buffer<T>, byte_offset: usize) -> Self {
        Self { buffer: buffer.id, word: (byte_offset / 4) as u32 }
    }
}

/// How much of a pass to run.
#[derive(Clone, Copy, Debug)]
pub enum Grid {
    /// This many invocations in one dimension. Past 65,535 workgroups the GPU uses two dimensions, so shaders find
    /// their number with `#import gpu/index`, and check it against the number of items themselves.
    Items(u32),
    /// This many workgroups, numbered likewise.
    Groups(u32),
    /// As many workgroups as the three words of this buffer at `word` say when the command is reached.
    Indirect {
        /// A buffer of `u32`.
        buffer: BufferId,
        /// Where the three words begin.
        word: u32,
    },
}

/// Most workgroups in one dimension of a dispatch, on every adapter.
const MAX_GROUPS: u32 = 65_535;

/// Splits a number of workgroups so that no dimension is past 65,535; the last row may be longer than needed.
pub fn dispatch_groups(groups: u32) -> [u32; 3] {
    let rows = groups.div_ceil(MAX_GROUPS).max(1);
    [groups.div_ceil(rows), rows, 1]
}

/// One entry of a [`Recording`].
#[derive(Clone, Debug)]
pub enum Command {
    /// Run a pass.
    Dispatch {
        /// Which.
        pass: &'static PassDesc,
        /// How much.
        grid: Grid,
        /// Its buffers, in the order of [`PassDesc::bindings`].
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
        /// Which.
        buffer: BufferId,
    },
    /// Run the body until the flag is set, at most `most` times.
    ///
    /// The CPU tests the flag before every round. A GPU cannot, without asking the host: it runs all rounds in one
    /// submission, and the body's passes find the flag set and do nothing.
    Repeat {
        /// The commands of a round.
        body: Vec<Command>,
        /// Most rounds.
        most: u32,
        /// When to stop.
        until: Flag,
    },
}

/// A list of commands with a name.
#[derive(Clone, Debug)]
pub struct Recording {
    /// The name, shown in graphics debuggers and errors.
    pub label: String,
    /// The commands, in order; each sees what those before it wrote.
    pub commands: Vec<Command>,
}

impl Recording {
    /// An empty list.
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), commands: Vec::new() }
    }

    /// Appends a dispatch.
    pub fn dispatch(&mut self, pass: &'static PassDesc, grid: Grid, buffers: &[BufferId]) {
        self.commands.push(Command::Dispatch { pass, grid, buffers: buffers.to_vec() });
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
    }

    /// Appends a bounded repetition of another recording.
    pub fn repeat(&mut self, body: &Recording, most: u32, until: Flag) {
        self.commands.push(Command::Repeat { body: body.commands.clone(), most, until });
    }
}

#[cfg(test)]
mod tests {
    use super::dispatch_groups;

    #[test]
    fn no_dimension_is_past_the_limit_and_none_is_missing() {
        for groups in [1, 65_535, 65_536, 131_070, 131_071, 1 << 24, 3_000_000_000] {
            let [x, y, z] = dispatch_groups(groups);
            assert!(x <= 65_535 && y <= 65_535 && z == 1, "{groups}: {x} x {y}");
            assert!(u64::from(x) * u64::from(y) >= u64::from(groups));
        }
        assert_eq!(dispatch_groups(65_535), [65_535, 1, 1]);
        assert_eq!(dispatch_groups(0), [0, 1, 1]);
    }
}
