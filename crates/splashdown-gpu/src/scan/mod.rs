//! Prefix sums: where each cell, block or kept element begins, from how many there are of each.
//!
//! # How it works
//!
//! *Reduce, then scan.* One workgroup sums each block of 4,096 counts; one workgroup scans those sums; then each block is
//! scanned again on top of the sum before it. Short inputs take the middle pass alone. The middle pass loops over its
//! input, 4,096 words a round, so there is no length at which a further level would be needed: 16 million counts
//! take one round, and the longest buffer a device binds (2^30 counts) takes 64.
//!
//! Inside a workgroup each invocation sums sixteen counts in registers, and sixteen invocations join the 256 sums: two
//! barriers a round where the usual tree has sixteen.
//!
//! # Why not the other way
//!
//! *Decoupled look-back* (one pass, each block waiting for its predecessor) reads memory once instead of twice, but
//! needs forward progress between workgroups, which neither WebGPU nor a software driver promises.

mod cpu;

use crate::{Buffer, Executor, GpuError, Grid, PassDesc, Recording, gpu_struct, read, uniform, wgsl, write};

/// Counts per invocation.
const RUN: u32 = 16;
/// Up to this length one workgroup does it all.
const SINGLE_MAX: u32 = 16_384;

gpu_struct! {
    /// Mirrors `ScanParams` in the passes' WGSL.
    struct ScanParams {
        /// Number of counts.
        len: u32,
        /// Number of blocks.
        blocks: u32,
    }
}

/// The passes of a scan in blocks of `256 * RUN`; the tests have them with another length of a block.
macro_rules! passes {
    ($run:expr; $reduce:ident $reduce_label:literal, $spread:ident $spread_label:literal) => {
        static $reduce: PassDesc = PassDesc {
            label: $reduce_label,
            wgsl: include_str!("scan_reduce.wgsl"),
            imports: &[wgsl::INDEX, wgsl::WORKGROUP_PREFIX],
            entry: "scan_reduce",
            workgroup_size: [256, 1, 1],
            constants: &[("RUN", $run as f64)],
            bindings: &[uniform::<ScanParams>("params"), read::<u32>("counts"), write::<u32>("sums")],
            cpu: cpu::reduce::<{ $run as usize }>,
        };
        static $spread: PassDesc = PassDesc {
            label: $spread_label,
            wgsl: include_str!("scan_spread.wgsl"),
            imports: &[wgsl::INDEX, wgsl::WORKGROUP_PREFIX],
            entry: "scan_spread",
            workgroup_size: [256, 1, 1],
            constants: &[("RUN", $run as f64)],
            bindings: &[
                uniform::<ScanParams>("params"),
                read::<u32>("counts"),
                read::<u32>("offsets"),
                write::<u32>("starts"),
            ],
            cpu: cpu::spread::<{ $run as usize }>,
        };
    };
}

passes!(RUN; REDUCE "scan.reduce", SPREAD "scan.spread");

static SINGLE: PassDesc = PassDesc {
    label: "scan.single",
    wgsl: include_str!("scan_single.wgsl"),
    imports: &[wgsl::WORKGROUP_PREFIX],
    entry: "scan_single",
    workgroup_size: [256, 1, 1],
    constants: &[],
    bindings: &[uniform::<ScanParams>("params"), read::<u32>("counts"), write::<u32>("starts")],
    cpu: cpu::single,
};

pub(crate) static PASSES: [&PassDesc; 3] = [&REDUCE, &SINGLE, &SPREAD];

/// Exclusive prefix sums of a fixed number of counts, with the buffers that takes.
#[derive(Clone, Copy, Debug)]
pub struct Scan {
    len: u32,
    params: Buffer<ScanParams>,
    levels: Option<Levels>,
}

/// What a scan in blocks has besides.
#[derive(Clone, Copy, Debug)]
struct Levels {
    blocks: u32,
    block_params: Buffer<ScanParams>,
    sums: Buffer<u32>,
    offsets: Buffer<u32>,
    reduce: &'static PassDesc,
    spread: &'static PassDesc,
}

impl Scan {
    /// Prepares scans of `len` counts.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn new(executor: &mut Executor, len: u32) -> Result<Self, GpuError> {
        if len <= SINGLE_MAX {
            let params = executor.create_uniform("scan params", &ScanParams { len, blocks: 1 })?;
            return Ok(Self { len, params, levels: None });
        }
        Self::in_blocks(executor, len, RUN, &REDUCE, &SPREAD)
    }

    fn in_blocks(
        executor: &mut Executor,
        len: u32,
        run: u32,
        reduce: &'static PassDesc,
        spread: &'static PassDesc,
    ) -> Result<Self, GpuError> {
        let blocks = len.div_ceil(256 * run);
        let block_params = ScanParams { len: blocks, blocks: 1 };
        Ok(Self {
            len,
            params: executor.create_uniform("scan params", &ScanParams { len, blocks })?,
            levels: Some(Levels {
                blocks,
                block_params: executor.create_uniform("scan block params", &block_params)?,
                sums: executor.create("scan block sums", blocks as usize)?,
                offsets: executor.create("scan block offsets", blocks as usize + 1)?,
                reduce,
                spread,
            }),
        })
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
        let Some(levels) = &self.levels else {
            recording.dispatch(&SINGLE, Grid::Groups(1), &[self.params.id(), counts, starts]);
            return;
        };
        let (sums, offsets) = (levels.sums.id(), levels.offsets.id());
        recording.dispatch(levels.reduce, Grid::Groups(levels.blocks), &[self.params.id(), counts, sums]);
        recording.dispatch(&SINGLE, Grid::Groups(1), &[levels.block_params.id(), sums, offsets]);
        recording.dispatch(
            levels.spread,
            Grid::Groups(levels.blocks),
            &[self.params.id(), counts, offsets, starts],
        );
    }
}
