//! Prefix sums: where each cell, block or kept element begins, from how many there are of each.
//!
//! # How it works
//!
//! *Reduce, then scan*, in two dispatches. One workgroup sums each block of 4,096 counts. Then each workgroup
//! adds up the sums of the blocks before its own by itself, all of its invocations together, and scans its
//! block on top of that. Up to 4,096 blocks (16.8 million counts) these are at most sixteen more reads per
//! invocation, of words that all workgroups share; a dispatch of its own, between the two, costs more. Past
//! that it is three dispatches: one workgroup scans the sums in the middle. It loops over them, 4,096 a round,
//! so there is no length at which a further level would be needed: the longest buffer a device binds (2^30
//! counts) takes 64 rounds. Short inputs take that middle pass alone.
//!
//! Inside a workgroup each invocation sums sixteen counts in registers, and sixteen invocations join the 256 sums: two
//! barriers a round where the usual tree has sixteen.
//!
//! # What it costs
//!
//! On 2 cores, by `cargo run --release -p splashdown-gpu --example primitives`: 65,536 counts take 0.04 ms by
//! the CPU side and 0.28 ms on software Vulkan (lavapipe of Mesa 22.3.6), a million counts 0.3 ms and 2.9 ms.
//! One workgroup alone is as fast as blocks there up to 16,384 counts (0.14 ms); a graphics card likes blocks
//! earlier, but has little to lose at such lengths.
//!
//! # Why not the other way
//!
//! *Decoupled look-back* (one pass, each block waiting for its predecessor) reads memory once instead of twice, but
//! needs forward progress between workgroups, which neither WebGPU nor a software driver promises.

mod cpu;

use crate::{Buffer, Executor, GpuError, Grid, PassDesc, Recording, gpu_struct, read, uniform, wgsl, write};

/// Up to this length one workgroup does it all.
const SINGLE_MAX: u32 = 16_384;
/// Up to this many blocks every workgroup adds up by itself what is before its block.
const MOST_SUMS: u32 = 4096;

gpu_struct! {
    /// Mirrors `ScanParams` in the passes' WGSL.
    struct ScanParams {
        /// Number of counts.
        len: u32,
        /// Number of blocks.
        blocks: u32,
    }
}

/// The passes of one kind of scan. Counts above `most` count as `most`: 1 makes flags of them.
#[derive(Debug)]
struct Passes {
    run: u32,
    reduce: PassDesc,
    single: PassDesc,
    spread: PassDesc,
    spread_scanned: PassDesc,
}

/// The constants: those of all, and for the last pass that its sums are scanned.
type Constants = [(&'static str, f64); 3];

const fn passes<const RUN: usize, const MOST: u32>(
    constants: &'static Constants,
    [reduce, single, spread, spread_scanned]: [&'static str; 4],
) -> Passes {
    let (run_and_most, _) = constants.split_at(2);
    let spread = PassDesc {
        label: spread,
        wgsl: include_str!("scan_spread.wgsl"),
        imports: &[wgsl::INDEX, wgsl::WORKGROUP_PREFIX],
        entry: "scan_spread",
        workgroup_size: [256, 1, 1],
        constants: run_and_most,
        bindings: const {
            &[
                uniform::<ScanParams>("params"),
                read::<u32>("counts"),
                read::<u32>("sums"),
                write::<u32>("starts"),
            ]
        },
        cpu: cpu::spread::<RUN, MOST, false>,
    };
    Passes {
        run: RUN as u32,
        reduce: PassDesc {
            label: reduce,
            wgsl: include_str!("scan_reduce.wgsl"),
            imports: &[wgsl::INDEX, wgsl::WORKGROUP_PREFIX],
            entry: "scan_reduce",
            workgroup_size: [256, 1, 1],
            constants: run_and_most,
            bindings: const { &[uniform::<ScanParams>("params"), read::<u32>("counts"), write::<u32>("sums")] },
            cpu: cpu::reduce::<RUN, MOST>,
        },
        single: PassDesc {
            label: single,
            wgsl: include_str!("scan_single.wgsl"),
            imports: &[wgsl::WORKGROUP_PREFIX],
            entry: "scan_single",
            workgroup_size: [256, 1, 1],
            constants: run_and_most.split_at(1).1,
            bindings: const { &[uniform::<ScanParams>("params"), read::<u32>("counts"), write::<u32>("starts")] },
            cpu: cpu::single::<MOST>,
        },
        spread_scanned: PassDesc {
            label: spread_scanned,
            constants,
            cpu: cpu::spread::<RUN, MOST, true>,
            ..spread
        },
        spread,
    }
}

const fn constants(run: f64, most: f64) -> Constants {
    [("RUN", run), ("MOST", most), ("SCANNED", 1.0)]
}

static COUNTS: Passes = passes::<16, { u32::MAX }>(
    const { &constants(16.0, u32::MAX as f64) },
    ["scan.reduce", "scan.single", "scan.spread", "scan.spread_scanned"],
);
static FLAGS: Passes = passes::<16, 1>(
    const { &constants(16.0, 1.0) },
    ["scan.flags.reduce", "scan.flags.single", "scan.flags.spread", "scan.flags.spread_scanned"],
);

pub(crate) static PASSES: [&PassDesc; 8] = [
    &COUNTS.reduce,
    &COUNTS.single,
    &COUNTS.spread,
    &COUNTS.spread_scanned,
    &FLAGS.reduce,
    &FLAGS.single,
    &FLAGS.spread,
    &FLAGS.spread_scanned,
];

/// Exclusive prefix sums of a fixed number of counts, with the buffers that takes.
#[derive(Clone, Copy, Debug)]
pub struct Scan {
    len: u32,
    passes: &'static Passes,
    params: Buffer<ScanParams>,
    levels: Option<Levels>,
}

/// What a scan in blocks has besides.
#[derive(Clone, Copy, Debug)]
struct Levels {
    blocks: u32,
    sums: Buffer<u32>,
    /// What the pass in the middle needs, where there is one.
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

    /// Prepares scans of `len` flags: each that is not 0 counts as one.
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
        let blocks = len.div_ceil(256 * passes.run);
        let params = executor.create_uniform("scan params", &ScanParams { len, blocks })?;
        let mut scan = Self { len, passes, params, levels: None };
        if len > single_max {
            let mut levels =
                Levels { blocks, sums: executor.create("scan block sums", blocks as usize)?, middle: None };
            if blocks > most_sums {
                let params = ScanParams { len: blocks, blocks: 1 };
                levels.middle = Some((
                    executor.create_uniform("scan block params", &params)?,
                    executor.create("scan block offsets", blocks as usize + 1)?,
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

    /// Appends: `starts[i]` becomes the sum of `counts[..i]` for every `i` up to and including the number of counts, so
    /// the last one is the total. Sums wrap at 2^32.
    ///
    /// # Panics
    /// If `counts` has fewer elements than this scan was made for, or `starts` not one more than that.
    pub fn record(&self, recording: &mut Recording, counts: Buffer<u32>, starts: Buffer<u32>) {
        assert!(counts.len() >= self.len, "a scan of {} counts was given {counts:?}", self.len);
        assert!(starts.len() > self.len, "a scan of {} counts cannot write {starts:?}", self.len);
        let (counts, starts) = (counts.id(), starts.id());
        let Passes { reduce, single, spread, spread_scanned, .. } = self.passes;
        let params = self.params.id();
        let Some(levels) = &self.levels else {
            recording.dispatch(single, Grid::Groups(1), &[params, counts, starts]);
            return;
        };
        let (groups, sums) = (Grid::Groups(levels.blocks), levels.sums.id());
        recording.dispatch(reduce, groups, &[params, counts, sums]);
        let Some((block_params, offsets)) = &levels.middle else {
            recording.dispatch(spread, groups, &[params, counts, sums, starts]);
            return;
        };
        recording.dispatch(&COUNTS.single, Grid::Groups(1), &[block_params.id(), sums, offsets.id()]);
        recording.dispatch(spread_scanned, groups, &[params, counts, offsets.id(), starts]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Command, testing};

    /// One count per invocation, so that two dimensions of workgroups are reached with 67 MB.
    static NARROW: Passes = passes::<1, { u32::MAX }>(
        const { &constants(1.0, u32::MAX as f64) },
        ["narrow", "narrow", "narrow", "narrow"],
    );

    #[test]
    fn a_dispatch_past_65_535_workgroups_is_right() {
        let len = 65_537 * 256 + 3;
        let counts: Vec<u32> = (0..len).map(|i| i % 5).collect();
        for (name, mut executor) in testing::executors("a_dispatch_past_65_535_workgroups_is_right") {
            let input = executor.create_from("counts", &counts).unwrap();
            let starts = executor.create::<u32>("starts", counts.len() + 1).unwrap();
            let scan = Scan::with(&mut executor, len, &NARROW, 0, MOST_SUMS).unwrap();
            assert!(scan.levels.unwrap().blocks > 65_535);
            let mut recording = Recording::new("scan");
            scan.record(&mut recording, input, starts);
            executor.run(&recording).unwrap();
            let starts = executor.read(starts).unwrap();
            // Five counts that follow one another sum to 10.
            let expected = |i: u32| i / 5 * 10 + [0, 0, 1, 3, 6][i as usize % 5];
            let wrong = (0..=len).find(|&i| starts[i as usize] != expected(i));
            assert_eq!(wrong, None, "{name}");
        }
    }

    #[test]
    fn two_dispatches_give_what_three_give() {
        let of_labels = |recording: &Recording| -> Vec<&'static str> {
            let label = |command: &Command| match command {
                Command::Dispatch { pass, .. } => pass.label,
                _ => "no dispatch",
            };
            recording.commands.iter().map(label).collect()
        };
        for (name, mut executor) in testing::executors("two_dispatches_give_what_three_give") {
            for len in [1, 4096, 4097, 50_000, 300_000 * 4] {
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
