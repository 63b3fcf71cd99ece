//! Stream compaction: the ordered list of elements whose flag is set, and the arguments of a dispatch over it.
//!
//! # How it works
//!
//! A [scan](crate::scan) of the flags gives the position of each selected element; another pass writes the elements
//! there. The list may be shorter than the flags, because few blocks of a grid contain fluid: elements that do not fit
//! are counted but not written.
//!
//! # Alternatives
//!
//! A counter that every selected element increments atomically takes one dispatch instead of up to four, but the order
//! of the list then differs from run to run.

mod cpu;

use crate::scan::Scan;
use crate::{
    Buffer, BufferSet, DispatchSize, Executor, GpuError, PassDesc, Recording, bindings, gpu_struct, wgsl,
};

gpu_struct! {
    /// Mirrors `CompactParams` in `compact_gather.wgsl`.
    struct CompactParams {
        /// Number of flags.
        len: u32,
        /// Invocations per workgroup of the passes that run over the list.
        workgroup_size: u32,
    }
}

bindings! {
    struct GatherBindings {
        params: uniform CompactParams,
        starts: read [u32],
        indices: write [u32],
        counted: write [u32],
    }
}

static GATHER: PassDesc = PassDesc {
    label: "compact.gather",
    wgsl: include_str!("compact_gather.wgsl"),
    imports: &[wgsl::INDEX],
    entry: "compact_gather",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: GatherBindings::LIST,
    cpu: |_, slots| cpu::gather(slots.into()),
};

pub(crate) static PASSES: [&PassDesc; 1] = [&GATHER];

/// The compaction of a fixed number of flags, with its buffers.
///
/// ```
/// use splashdown_gpu::{CpuExecutor, Executor, Recording, compact::Compact};
/// let mut executor = Executor::from(CpuExecutor::new());
/// let flags = executor.create_from("flags", &[0_u32, 7, 0, 1])?;
/// let indices = executor.create::<u32>("indices", 4)?;
/// let counted = executor.create::<u32>("counted", 4)?;
/// let compact = Compact::new(&mut executor, 4, 64)?;
/// let mut recording = Recording::new("example");
/// compact.record(&mut recording, flags, indices, counted);
/// executor.run(&recording)?;
/// assert_eq!(executor.read(counted)?, [1, 1, 1, 2]);
/// assert_eq!(executor.read_first(indices, 2)?, [1, 3]);
/// # Ok::<(), splashdown_gpu::GpuError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Compact {
    len: u32,
    params: Buffer<CompactParams>,
    scan: Scan,
    starts: Buffer<u32>,
}

impl Compact {
    /// The index of the number of set flags in `counted`; the arguments of [`DispatchSize::Indirect`] precede it.
    pub const COUNT_WORD: u32 = 3;

    /// Prepares compactions of `len` flags into lists over which passes with `workgroup_size` invocations run.
    ///
    /// # Errors
    /// As [`Executor::create`].
    ///
    /// # Panics
    /// If `workgroup_size` is 0.
    pub fn new(executor: &mut Executor, len: u32, workgroup_size: u32) -> Result<Self, GpuError> {
        assert!(workgroup_size > 0, "a workgroup has at least one invocation");
        Ok(Self {
            len,
            params: executor.create_uniform("compact_params", &CompactParams { len, workgroup_size })?,
            scan: Scan::of_flags(executor, len)?,
            starts: executor.create("compact_starts", len as usize + 1)?,
        })
    }

    /// The position of each element in the list. After the recorded commands, element `i` of this buffer is the number of
    /// set flags before flag `i`, which is the position of `i` in the list if its flag is set. The last of its `len + 1`
    /// elements is the number of all set flags.
    pub fn places(&self) -> Buffer<u32> {
        self.starts
    }

    /// Appends the compaction. `indices` becomes the ascending list of every `i` with `flags[i] != 0`, up to its length.
    /// `counted` becomes four words: the arguments of a [`DispatchSize::Indirect`] over the list, then the number of set
    /// flags, which may exceed the length of the list. Passes over the list compare their index with that number and
    /// with the length of the list.
    ///
    /// # Panics
    /// If `flags` has fewer elements than this compaction was prepared for, `indices` none, or `counted` fewer than four.
    pub fn record(
        &self,
        recording: &mut Recording,
        flags: Buffer<u32>,
        indices: Buffer<u32>,
        counted: Buffer<u32>,
    ) {
        assert!(!indices.is_empty(), "a compaction cannot write {indices:?}");
        assert!(counted.len() >= 4, "a compaction writes four words, not {counted:?}");
        self.scan.record(recording, flags, self.starts);
        let buffers = BufferSet::new()
            .with("params", self.params)
            .with("starts", self.starts)
            .with("indices", indices)
            .with("counted", counted);
        recording.dispatch(&GATHER, DispatchSize::Items(self.len.max(1)), &buffers);
    }

    /// Frees the buffers; recordings of this compaction become invalid.
    ///
    /// # Errors
    /// [`GpuError::NoSuchBuffer`] if a copy was freed before.
    pub fn free(self, executor: &mut Executor) -> Result<(), GpuError> {
        self.scan.free(executor)?;
        executor.free([self.params.id(), self.starts.id()])
    }
}
