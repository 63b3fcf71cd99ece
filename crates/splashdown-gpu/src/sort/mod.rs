//! Bitonic sort of key-value pairs: the neighbour search of the thesis, retained as a baseline.
//!
//! # How it works
//!
//! Batcher's network (K. E. Batcher, *Sorting networks and their applications*, AFIPS 1968) in the form whose
//! comparisons all have the same direction: a merge first compares mirrored positions of two sorted halves (a *flip*),
//! then positions half a span apart, a quarter, and so on. The smaller of two elements always moves to the front, so
//! padding of `u32::MAX` up to the next power of two never moves. It is not stored, and comparisons with it are omitted,
//! so any length is sorted in place.
//!
//! Blocks of 512 are processed in workgroup memory; only longer spans take a dispatch per step: 36 dispatches for 65,536
//! pairs, 78 for a million.
//!
//! Pairs are ordered by key, then by value. If the values are distinct, as particle indices are, the order is total and
//! the result is bit-identical in every run.
//!
//! # Cost
//!
//! On 2 cores, by `cargo run --release -p splashdown-gpu --example primitives`: 65,536 pairs take 4 ms by the
//! CPU side and 27 ms on software Vulkan (lavapipe of Mesa 22.3.6), where the scan of a counting sort takes 0.3
//! ms.
//!
//! # Alternatives
//!
//! A counting sort by cell (histogram, [scan](crate::scan), scatter) reads and writes everything twice, while this sort
//! needs n log² n comparisons. This sort is retained for comparison with the figures of the thesis.

mod cpu;

use glam::UVec2;

use crate::{
    Buffer, BufferSet, DispatchSize, Executor, GpuError, PassDesc, Recording, WgslModule, bindings,
    gpu_struct, wgsl,
};

/// Pairs per workgroup in workgroup memory.
const BLOCK: u32 = 512;

gpu_struct! {
    /// Mirrors `SortParams` in the passes' WGSL.
    struct SortParams {
        /// Number of pairs.
        len: u32,
        /// Pairs in the two halves that a step compares.
        span: u32,
        /// 1 if the step compares mirrored positions.
        flip: u32,
    }
}

bindings! {
    struct SortBindings {
        params: uniform SortParams,
        pairs: write [UVec2],
    }
}

const ORDER: WgslModule = WgslModule { name: "sort/order", source: include_str!("order.wgsl") };

static BLOCKS: PassDesc = PassDesc {
    label: "sort.blocks",
    wgsl: include_str!("sort_local.wgsl"),
    imports: &[wgsl::INDEX, ORDER],
    entry: "sort_local",
    workgroup_size: [256, 1, 1],
    constants: &[("WHOLE", 1.0)],
    bindings: SortBindings::LIST,
    cpu: |_, slots| cpu::blocks(slots.into()),
};

static MERGE: PassDesc = PassDesc {
    label: "sort.merge",
    constants: &[("WHOLE", 0.0)],
    cpu: |_, slots| cpu::merge(slots.into()),
    ..BLOCKS
};

static STEP: PassDesc = PassDesc {
    label: "sort.step",
    wgsl: include_str!("sort_step.wgsl"),
    imports: &[wgsl::INDEX, ORDER],
    entry: "sort_step",
    workgroup_size: [256, 1, 1],
    constants: &[],
    bindings: SortBindings::LIST,
    cpu: |_, slots| cpu::step(slots.into()),
};

pub(crate) static PASSES: [&PassDesc; 3] = [&BLOCKS, &MERGE, &STEP];

/// The sort of a fixed number of pairs.
///
/// ```
/// use splashdown_gpu::{CpuExecutor, Executor, Recording, glam::uvec2, sort::Sort};
/// let mut executor = Executor::from(CpuExecutor::new());
/// let pairs = executor.create_from("pairs", &[uvec2(9, 0), uvec2(3, 2), uvec2(3, 1)])?;
/// let sort = Sort::new(&mut executor, 3)?;
/// let mut recording = Recording::new("example");
/// sort.record(&mut recording, pairs);
/// executor.run(&recording)?;
/// assert_eq!(executor.read(pairs)?, [uvec2(3, 1), uvec2(3, 2), uvec2(9, 0)]);
/// # Ok::<(), splashdown_gpu::GpuError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sort {
    len: u32,
    params: Buffer<SortParams>,
    /// The parameters of a flip of 1024, 2048, ... pairs and of the straight step of the same length.
    steps: Vec<[Buffer<SortParams>; 2]>,
}

impl Sort {
    /// Prepares sorts of `len` pairs, at most 2^31.
    ///
    /// # Errors
    /// As [`Executor::create`].
    ///
    /// # Panics
    /// If `len` is more than 2^31.
    pub fn new(executor: &mut Executor, len: u32) -> Result<Self, GpuError> {
        assert!(len <= 1 << 31, "{len} pairs are more than 2^31");
        let params = executor.create_uniform("sort_params", &SortParams { len, span: BLOCK, flip: 0 })?;
        let mut sort = Self { len, params, steps: Vec::new() };
        let mut span = BLOCK;
        while span < len {
            span *= 2;
            let mut step =
                |flip| executor.create_uniform("sort_step_params", &SortParams { len, span, flip });
            sort.steps.push([step(1)?, step(0)?]);
        }
        Ok(sort)
    }

    /// Appends the sort: the first `len` pairs (key, value) of `pairs` are sorted by ascending key, and by value for equal
    /// keys.
    ///
    /// # Panics
    /// If `pairs` has fewer elements.
    pub fn record(&self, recording: &mut Recording, pairs: Buffer<UVec2>) {
        assert!(pairs.len() >= self.len, "a sort of {} pairs was given {pairs:?}", self.len);
        let blocks = DispatchSize::Groups(self.len.div_ceil(BLOCK));
        let buffers = |params| BufferSet::new().with("params", params).with("pairs", pairs);
        recording.dispatch(&BLOCKS, blocks, &buffers(self.params));
        for (level, [flip, _]) in self.steps.iter().enumerate() {
            let comparisons = |span_level: usize| {
                let half = BLOCK << span_level;
                DispatchSize::Items(self.len.div_ceil(2 * half).saturating_mul(half))
            };
            recording.dispatch(&STEP, comparisons(level), &buffers(*flip));
            for (lower, [_, straight]) in self.steps[..level].iter().enumerate().rev() {
                recording.dispatch(&STEP, comparisons(lower), &buffers(*straight));
            }
            recording.dispatch(&MERGE, blocks, &buffers(self.params));
        }
    }

    /// Frees the buffers; recordings of this sort become invalid.
    ///
    /// # Errors
    /// [`GpuError::NoSuchBuffer`] if a copy was freed before.
    pub fn free(self, executor: &mut Executor) -> Result<(), GpuError> {
        executor.free(self.steps.into_iter().flatten().chain([self.params]))
    }
}

#[cfg(test)]
mod tests {
    use glam::uvec2;

    use super::*;
    use crate::testing;

    /// On any input, not only on sorted halves: a network compares the same positions independent of their contents.
    #[test]
    fn every_step_agrees_on_both_executors() {
        let len = 5000;
        let pairs: Vec<UVec2> = (0..len).map(|i| uvec2(testing::noise(i) % 999, i)).collect();
        let cases = [
            (&BLOCKS, 512, 0),
            (&MERGE, 512, 0),
            (&STEP, 1024, 0),
            (&STEP, 1024, 1),
            (&STEP, 4096, 1),
            (&STEP, 8192, 1),
        ];
        let mut results: Vec<Vec<Vec<UVec2>>> = Vec::new();
        for (_, mut executor) in testing::executors("every_step_agrees_on_both_executors") {
            let run = |(pass, span, flip): (&'static PassDesc, u32, u32)| {
                let buffer = executor.create_from("pairs", &pairs)?;
                let params = executor.create_uniform("params", &SortParams { len, span, flip })?;
                let mut recording = Recording::new("step");
                let step = std::ptr::eq(pass, &STEP);
                let size = if step { DispatchSize::Items(8192) } else { DispatchSize::Groups(10) };
                recording.dispatch(
                    pass,
                    size,
                    &BufferSet::new().with("params", params).with("pairs", buffer),
                );
                executor.run(&recording)?;
                executor.read(buffer)
            };
            results.push(cases.into_iter().map(run).collect::<Result<_, GpuError>>().unwrap());
        }
        for result in &results {
            assert!(*result == results[0]);
            assert!(result.iter().all(|after| *after != pairs), "a step changed nothing");
        }
        let distinct = results[0].iter().enumerate().all(|(i, a)| results[0][..i].iter().all(|b| a != b));
        assert!(distinct, "two different steps have the same result");
    }
}
