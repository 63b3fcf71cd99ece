//! Prefix sums: the start of each cell, block or selected element from the counts.
//!
//! # How it works
//!
//! *Reduce, then scan*, in two dispatches. One workgroup sums each block of 2,048 counts. Then each workgroup adds up the
//! sums of the preceding blocks, with all of its invocations, and scans its block starting from that sum. Up to 8,192
//! blocks (16.8 million counts) this takes at most 32 more reads per invocation, of words that all workgroups
//! share; a separate dispatch between the two costs more. Longer inputs take three dispatches: in the middle, one
//! workgroup scans the sums in a loop over 4,096 sums per round. No further level is needed at any length: the longest
//! buffer a device binds (2^30 counts) takes 128 rounds. Short inputs take only the middle pass.
//!
//! Inside a workgroup each invocation sums eight counts in registers (sixteen in the middle pass), and sixteen invocations combine the 256 sums: two
//! barriers per round, where the usual tree has sixteen.
//!
//! # Cost
//!
//! On 2 cores, by `cargo run --release -p splashdown-gpu --example primitives` with blocks of 4,096 counts: 65,536 counts take 0.04 ms by
//! the CPU side and 0.28 ms on software Vulkan (lavapipe of Mesa 22.3.6), a million counts 0.3 ms and 2.9 ms.
//! There, a single workgroup is as fast as blocks up to 16,384 counts (0.14 ms). A graphics card profits from blocks at
//! shorter lengths, but the difference is small.
//!
//! # Alternatives
//!
//! *Decoupled look-back* (one pass, each block waiting for its predecessor) reads memory once instead of twice, but
//! needs forward progress between workgroups, which neither WebGPU nor a software driver promises.

mod cpu;

use crate::{
    Buffer, BufferSet, DispatchSize, Executor, GpuError, PassDesc, Recording, WgslModule, bindings,
    gpu_struct, wgsl,
};

/// The WGSL side of [`ScanParams`].
pub const PARAMS: WgslModule =
    WgslModule { name: "gpu/scan_params", source: include_str!("scan_params.wgsl") };

/// Up to this length one workgroup computes the whole scan.
const SINGLE_MAX: u32 = 16_384;
/// Up to this many blocks every workgroup adds up the sums of the preceding blocks itself.
const MOST_SUMS: u32 = 8192;
/// Counts per invocation. More of them would leave most of a large GPU without work: 90,000 cells are 46 blocks.
const RUN: usize = 8;
const _: () = assert!(RUN <= 8, "the passes load eight");
/// Counts in a block.
const BLOCK: u32 = 256 * RUN as u32;

gpu_struct! {
    /// What a scan adds up. A pass may set both to zero: the scan then has no effect but to write the zero before the
    /// first count, until they are set again.
    pub struct ScanParams {
        /// Number of counts.
        len: u32,
        /// Number of blocks.
        blocks: u32,
    }
}

bindings! {
    struct ReduceBindings {
        params: uniform ScanParams,
        counts: read [u32],
        sums: write [u32],
    }
}

bindings! {
    struct SingleBindings {
        params: uniform ScanParams,
        counts: read [u32],
        starts: write [u32],
    }
}

bindings! {
    struct SpreadBindings {
        params: uniform ScanParams,
        counts: read [u32],
        sums: read [u32],
        starts: write [u32],
    }
}

/// The value of `MOST` that leaves counts unchanged.
const ANY: u32 = u32::MAX;

static REDUCE: PassDesc = PassDesc {
    label: "scan.reduce",
    wgsl: include_str!("scan_reduce.wgsl"),
    imports: &[wgsl::INDEX, wgsl::WORKGROUP_PREFIX, PARAMS],
    entry: "scan_reduce",
    workgroup_size: [256, 1, 1],
    constants: &[("RUN", RUN as f64), ("MOST", ANY as f64)],
    bindings: ReduceBindings::LIST,
    cpu: |_, slots| cpu::reduce::<RUN, ANY>(slots.into()),
};

static SINGLE: PassDesc = PassDesc {
    label: "scan.single",
    wgsl: include_str!("scan_single.wgsl"),
    imports: &[wgsl::WORKGROUP_PREFIX, PARAMS],
    entry: "scan_single",
    workgroup_size: [256, 1, 1],
    constants: &[("MOST", ANY as f64)],
    bindings: SingleBindings::LIST,
    cpu: |_, slots| cpu::single::<ANY>(slots.into()),
};

static SPREAD: PassDesc = PassDesc {
    label: "scan.spread",
    wgsl: include_str!("scan_spread.wgsl"),
    imports: &[wgsl::INDEX, wgsl::WORKGROUP_PREFIX, PARAMS],
    entry: "scan_spread",
    workgroup_size: [256, 1, 1],
    constants: &[("RUN", RUN as f64), ("MOST", ANY as f64)],
    bindings: SpreadBindings::LIST,
    cpu: |_, slots| cpu::spread::<RUN, ANY, false>(slots.into()),
};

/// The variant for scanned sums.
static SPREAD_SCANNED: PassDesc = PassDesc {
    label: "scan.spread_scanned",
    constants: &[("RUN", RUN as f64), ("MOST", ANY as f64), ("SCANNED", 1.0)],
    cpu: |_, slots| cpu::spread::<RUN, ANY, true>(slots.into()),
    ..SPREAD
};

static FLAGS_REDUCE: PassDesc = PassDesc {
    label: "scan.flags.reduce",
    constants: &[("RUN", RUN as f64), ("MOST", 1.0)],
    cpu: |_, slots| cpu::reduce::<RUN, 1>(slots.into()),
    ..REDUCE
};

static FLAGS_SINGLE: PassDesc = PassDesc {
    label: "scan.flags.single",
    constants: &[("MOST", 1.0)],
    cpu: |_, slots| cpu::single::<1>(slots.into()),
    ..SINGLE
};

static FLAGS_SPREAD: PassDesc = PassDesc {
    label: "scan.flags.spread",
    constants: &[("RUN", RUN as f64), ("MOST", 1.0)],
    cpu: |_, slots| cpu::spread::<RUN, 1, false>(slots.into()),
    ..SPREAD
};

static FLAGS_SPREAD_SCANNED: PassDesc = PassDesc {
    label: "scan.flags.spread_scanned",
    constants: &[("RUN", RUN as f64), ("MOST", 1.0), ("SCANNED", 1.0)],
    cpu: |_, slots| cpu::spread::<RUN, 1, true>(slots.into()),
    ..SPREAD
};

pub(crate) static PASSES: [&PassDesc; 8] = [
    &REDUCE,
    &SINGLE,
    &SPREAD,
    &SPREAD_SCANNED,
    &FLAGS_REDUCE,
    &FLAGS_SINGLE,
    &FLAGS_SPREAD,
    &FLAGS_SPREAD_SCANNED,
];

/// The passes of one kind of scan. Counts above `MOST` are treated as `MOST`: 1 treats them as flags.
#[derive(Debug)]
struct Passes {
    block: u32,
    reduce: &'static PassDesc,
    single: &'static PassDesc,
    spread: &'static PassDesc,
    spread_scanned: &'static PassDesc,
}

static COUNTS: Passes = Passes {
    block: BLOCK,
    reduce: &REDUCE,
    single: &SINGLE,
    spread: &SPREAD,
    spread_scanned: &SPREAD_SCANNED,
};

static FLAGS: Passes = Passes {
    block: BLOCK,
    reduce: &FLAGS_REDUCE,
    single: &FLAGS_SINGLE,
    spread: &FLAGS_SPREAD,
    spread_scanned: &FLAGS_SPREAD_SCANNED,
};

/// Exclusive prefix sums of a fixed number of counts, with the buffers of the scan.
#[derive(Clone, Copy, Debug)]
pub struct Scan {
    len: u32,
    passes: &'static Passes,
    params: Buffer<ScanParams>,
    levels: Option<Levels>,
}

/// The additional buffers of a scan in blocks.
#[derive(Clone, Copy, Debug)]
struct Levels {
    blocks: u32,
    sums: Buffer<u32>,
    /// The buffers of the pass that scans the sums, if there are too many for every workgroup to add them up.
    middle: Option<(Buffer<ScanParams>, Buffer<u32>)>,
}

impl Scan {
    /// Prepares scans of `len` counts.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn new(executor: &mut Executor, len: u32) -> Result<Self, GpuError> {
        Self::with(executor, len, &COUNTS, SINGLE_MAX, MOST_SUMS)
    }

    /// Prepares scans of `len` flags: every value other than 0 counts as 1.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn of_flags(executor: &mut Executor, len: u32) -> Result<Self, GpuError> {
        Self::with(executor, len, &FLAGS, SINGLE_MAX, MOST_SUMS)
    }

    fn with(
        executor: &mut Executor,
        len: u32,
        passes: &'static Passes,
        single_max: u32,
        most_sums: u32,
    ) -> Result<Self, GpuError> {
        let blocks = len.div_ceil(passes.block);
        let params = executor.create_small("scan_params", &[ScanParams { len, blocks }])?;
        let mut scan = Self { len, passes, params, levels: None };
        if len > single_max {
            let mut levels =
                Levels { blocks, sums: executor.create("scan_sums", blocks as usize)?, middle: None };
            if blocks > most_sums {
                let params = ScanParams { len: blocks, blocks: 1 };
                levels.middle = Some((
                    executor.create_uniform("scan_sums_params", &params)?,
                    executor.create("scan_offsets", blocks as usize + 1)?,
                ));
            }
            scan.levels = Some(levels);
        }
        Ok(scan)
    }

    /// The number of counts.
    #[expect(clippy::len_without_is_empty, reason = "a scan is not a container")]
    pub fn len(&self) -> u32 {
        self.len
    }

    /// The buffer that says what the scan adds up, for passes that turn it off and on.
    pub fn params(&self) -> Buffer<ScanParams> {
        self.params
    }

    /// Appends the scan: `starts[i]` becomes the sum of `counts[..i]` for every `i` up to and including the number of
    /// counts, so the last element is the total. Sums wrap at 2^32.
    ///
    /// # Panics
    /// If `counts` has fewer elements than this scan was prepared for, or `starts` not one more than that.
    pub fn record(&self, recording: &mut Recording, counts: Buffer<u32>, starts: Buffer<u32>) {
        assert!(counts.len() >= self.len, "a scan of {} counts was given {counts:?}", self.len);
        assert!(starts.len() > self.len, "a scan of {} counts cannot write {starts:?}", self.len);
        let Passes { reduce, single, spread, spread_scanned, .. } = *self.passes;
        let buffers =
            BufferSet::new().with("params", self.params).with("counts", counts).with("starts", starts);
        let Some(levels) = &self.levels else {
            recording.dispatch(single, DispatchSize::Groups(1), &buffers);
            return;
        };
        let groups = DispatchSize::Groups(levels.blocks);
        let buffers = buffers.with("sums", levels.sums);
        recording.dispatch(reduce, groups, &buffers);
        let Some((params, offsets)) = levels.middle else {
            recording.dispatch(spread, groups, &buffers);
            return;
        };
        let middle =
            BufferSet::new().with("params", params).with("counts", levels.sums).with("starts", offsets);
        recording.dispatch(&SINGLE, DispatchSize::Groups(1), &middle);
        recording.dispatch(spread_scanned, groups, &buffers.with("sums", offsets));
    }

    /// Frees the buffers; recordings of this scan become invalid.
    ///
    /// # Errors
    /// [`GpuError::NoSuchBuffer`] if a copy was freed before.
    pub fn free(self, executor: &mut Executor) -> Result<(), GpuError> {
        let mut ids = vec![self.params.id()];
        if let Some(Levels { sums, middle, .. }) = self.levels {
            ids.push(sums.id());
            ids.extend(middle.into_iter().flat_map(|(params, offsets)| [params.id(), offsets.id()]));
        }
        executor.free(ids)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Command, testing};

    static NARROW_REDUCE: PassDesc = PassDesc {
        label: "narrow.reduce",
        constants: &[("RUN", 1.0)],
        cpu: |_, slots| cpu::reduce::<1, ANY>(slots.into()),
        ..REDUCE
    };

    static NARROW_SPREAD: PassDesc = PassDesc {
        label: "narrow.spread",
        constants: &[("RUN", 1.0), ("SCANNED", 1.0)],
        cpu: |_, slots| cpu::spread::<1, ANY, true>(slots.into()),
        ..SPREAD
    };

    /// One count per invocation, so that two dimensions of workgroups are reached with 67 MB.
    static NARROW: Passes = Passes {
        block: 256,
        reduce: &NARROW_REDUCE,
        single: &SINGLE,
        spread: &NARROW_SPREAD,
        spread_scanned: &NARROW_SPREAD,
    };

    #[test]
    fn dispatches_beyond_65_535_workgroups_are_correct() {
        let len = 65_537 * 256 + 3;
        let counts: Vec<u32> = (0..len).map(|i| i % 5).collect();
        for (name, mut executor) in testing::executors("dispatches_beyond_65_535_workgroups_are_correct") {
            let input = executor.create_from("counts", &counts).unwrap();
            let starts = executor.create::<u32>("starts", counts.len() + 1).unwrap();
            let scan = Scan::with(&mut executor, len, &NARROW, 0, MOST_SUMS).unwrap();
            assert!(scan.levels.unwrap().blocks > 65_535);
            let mut recording = Recording::new("scan");
            scan.record(&mut recording, input, starts);
            executor.run(&recording).unwrap();
            let starts = executor.read(starts).unwrap();
            // Five consecutive counts sum to 10.
            let expected = |i: u32| i / 5 * 10 + [0, 0, 1, 3, 6][i as usize % 5];
            let wrong = (0..=len).find(|&i| starts[i as usize] != expected(i));
            assert_eq!(wrong, None, "{name}");
        }
    }

    #[test]
    fn a_scan_of_no_counts_has_no_effect() {
        for (name, mut executor) in testing::executors("a_scan_of_no_counts_has_no_effect") {
            // One dispatch, two and three.
            for (len, most_sums) in [(100, MOST_SUMS), (50_000, MOST_SUMS), (50_000, 0)] {
                let counts: Vec<u32> = (0..len).map(|i| testing::noise(i) >> 20).collect();
                let input = executor.create_from("counts", &counts).unwrap();
                let starts = executor.create::<u32>("starts", counts.len() + 1).unwrap();
                let scan = Scan::with(&mut executor, len, &COUNTS, SINGLE_MAX, most_sums).unwrap();
                let mut recording = Recording::new("scan");
                scan.record(&mut recording, input, starts);
                executor.run(&recording).unwrap();
                let expected = executor.read(starts).unwrap();
                let on = executor.read(scan.params()).unwrap();
                executor.write(scan.params(), &[ScanParams { len: 0, blocks: 0 }]).unwrap();
                executor.write(input, &vec![0; counts.len()]).unwrap();
                executor.run(&recording).unwrap();
                assert!(executor.read(starts).unwrap() == expected, "{name}, {len}");
                // Control: turned on again, it adds up the changed counts.
                executor.write(scan.params(), &on).unwrap();
                executor.run(&recording).unwrap();
                assert!(executor.read(starts).unwrap().iter().all(|&start| start == 0), "{name}, {len}");
            }
        }
    }

    #[test]
    fn two_and_three_dispatches_agree() {
        let of_labels = |recording: &Recording| -> Vec<&'static str> {
            let label = |command: &Command| match command {
                Command::Dispatch { pass, .. } => pass.label,
                _ => "no dispatch",
            };
            recording.commands.iter().map(label).collect()
        };
        for (name, mut executor) in testing::executors("two_and_three_dispatches_agree") {
            for len in [1, BLOCK, BLOCK + 1, 9 * BLOCK, 50_000, 300_000 * 4] {
                let counts: Vec<u32> = (0..len).map(|i| testing::noise(i) >> 8).collect();
                let input = executor.create_from("counts", &counts).unwrap();
                let mut starts = Vec::new();
                let mut labels = Vec::new();
                for most_sums in [u32::MAX, 0] {
                    let output = executor.create::<u32>("starts", counts.len() + 1).unwrap();
                    let scan = Scan::with(&mut executor, len, &FLAGS, 0, most_sums).unwrap();
                    let mut recording = Recording::new("scan");
                    scan.record(&mut recording, input, output);
                    executor.run(&recording).unwrap();
                    labels.push(of_labels(&recording));
                    starts.push(executor.read(output).unwrap());
                }
                assert_eq!(labels[0], ["scan.flags.reduce", "scan.flags.spread"]);
                assert_eq!(labels[1], ["scan.flags.reduce", "scan.single", "scan.flags.spread_scanned"]);
                let flags = counts.iter().filter(|&&count| count > 0).count() as u32;
                assert_eq!(starts[0].last(), Some(&flags), "{name}, {len}");
                assert!(starts[0] == starts[1], "{name}, {len}");
            }
        }
    }
}
