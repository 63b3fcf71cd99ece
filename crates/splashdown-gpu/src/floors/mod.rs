//! What a device can do at best: how fast it copies, how fast it multiplies and adds, and what a dispatch costs
//! that waits for the one before it.
//!
//! A claim about speed is a ratio to these, measured in the same process on the same device, so that it holds
//! on any machine.
//!
//! *How it works.* Three passes without any purpose of their own. `copy` moves 32 MiB from one buffer to
//! another, more than caches hold. `madd` runs eight independent chains of fused multiplications and additions
//! per lane, enough to hide their latency. `nothing` is one workgroup that adds to a counter, many times in one
//! submission, each after the one before. The best of several rounds counts: a floor is what is possible.

mod cpu;

use web_time::Instant;

use glam::Vec4;

use crate::{Executor, GpuError, Grid, PassDesc, Recording, read, wgsl, write};

/// Vectors that are copied: 32 MiB.
const COPIED: usize = 2 << 20;
/// Copies in a round.
const COPIES: u32 = 8;
/// Invocations of `madd`.
const LANES: u32 = 1 << 16;
/// Rounds of the chains in `madd`.
const LINKS: u32 = 512;
/// Chains, of four lanes each.
const CHAINS: u32 = 8;
/// Dependent dispatches in a round.
const DISPATCHES: u32 = 512;
/// Rounds, of which the best counts.
const ROUNDS: u32 = 5;

static COPY: PassDesc = PassDesc {
    label: "floor.copy",
    wgsl: include_str!("copy.wgsl"),
    imports: &[wgsl::INDEX],
    entry: "copy",
    workgroup_size: [256, 1, 1],
    constants: &[],
    bindings: &[read::<Vec4>("values"), write::<Vec4>("results")],
    cpu: cpu::copy,
};

static MADD: PassDesc = PassDesc {
    label: "floor.madd",
    wgsl: include_str!("madd.wgsl"),
    imports: &[wgsl::INDEX],
    entry: "madd",
    workgroup_size: [256, 1, 1],
    constants: &[("LINKS", LINKS as f64)],
    bindings: &[read::<Vec4>("values"), write::<Vec4>("results")],
    cpu: cpu::madd,
};

static NOTHING: PassDesc = PassDesc {
    label: "floor.nothing",
    wgsl: include_str!("nothing.wgsl"),
    imports: &[],
    entry: "nothing",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: &[write::<u32>("counter")],
    cpu: cpu::nothing,
};

pub(crate) static PASSES: [&PassDesc; 3] = [&COPY, &MADD, &NOTHING];

/// What a device can do at best.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floors {
    /// Bytes read and written by a copy of large arrays, per second.
    pub bytes_per_second: f64,
    /// Single-precision operations per second; a fused multiplication and addition counts two.
    pub flops: f64,
    /// Seconds from one dispatch to the next that waits for it.
    pub dispatch: f64,
}

impl Floors {
    /// Measures them; takes about a second.
    ///
    /// # Errors
    /// Those of the device.
    pub fn measure(executor: &mut Executor) -> Result<Self, GpuError> {
        // Written, because memory that nobody has written is one page of zeros, which is read from a cache.
        let values = executor.create_from("floor values", &vec![Vec4::ONE; COPIED])?;
        let results = executor.create::<Vec4>("floor results", COPIED)?;
        let counter = executor.create::<u32>("floor counter", 1)?;
        let record = |pass, grid, buffers: &[_], times| {
            let mut recording = Recording::new(pass_label(pass));
            for _ in 0..times {
                recording.dispatch(pass, grid, buffers);
            }
            recording
        };
        let both = [values.id(), results.id()];
        let copy = best(executor, &record(&COPY, Grid::Items(COPIED as u32), &both, COPIES))?;
        let madd = best(executor, &record(&MADD, Grid::Items(LANES), &both, 1))?;
        let nothing = best(executor, &record(&NOTHING, Grid::Groups(1), &[counter.id()], DISPATCHES))?;
        Ok(Self {
            bytes_per_second: 2.0 * 16.0 * COPIED as f64 * f64::from(COPIES) / copy,
            flops: 2.0 * 4.0 * f64::from(CHAINS) * f64::from(LINKS) * f64::from(LANES) / madd,
            dispatch: nothing / f64::from(DISPATCHES),
        })
    }

    /// The shortest time in s for work of so many bytes, operations and dependent dispatches, where bytes and
    /// operations overlap.
    pub fn seconds(&self, bytes: f64, operations: f64, dispatches: f64) -> f64 {
        (bytes / self.bytes_per_second).max(operations / self.flops) + dispatches * self.dispatch
    }
}

fn pass_label(pass: &PassDesc) -> &'static str {
    pass.label
}

/// Seconds of the fastest round, after one that is not counted.
fn best(executor: &mut Executor, recording: &Recording) -> Result<f64, GpuError> {
    let mut best = f64::INFINITY;
    for round in 0..=ROUNDS {
        executor.wait()?;
        let begun = Instant::now();
        executor.run(recording)?;
        executor.wait()?;
        if round > 0 {
            best = best.min(begun.elapsed().as_secs_f64());
        }
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::executors;

    #[test]
    fn the_work_of_which_the_time_is_taken_is_done() -> Result<(), GpuError> {
        for (device, mut executor) in executors("the_work_of_which_the_time_is_taken_is_done") {
            let n = 1000;
            let input: Vec<Vec4> = (0..n).map(|i| Vec4::new(i as f32, 0.25, -1.0, 0.5) / n as f32).collect();
            let values = executor.create_from("values", &input)?;
            let results = executor.create::<Vec4>("results", n as usize)?;
            let counter = executor.create_from("counter", &[0_u32])?;
            let mut recording = Recording::new("floors");
            recording.dispatch(&COPY, Grid::Items(n), &[values.id(), results.id()]);
            for _ in 0..7 {
                recording.dispatch(&NOTHING, Grid::Groups(1), &[counter.id()]);
            }
            executor.run(&recording)?;
            assert_eq!(executor.read(results)?, input, "{device}");
            assert_eq!(executor.read(counter)?, [7], "{device}");

            let mut recording = Recording::new("floors");
            recording.dispatch(&MADD, Grid::Items(n), &[values.id(), results.id()]);
            executor.run(&recording)?;
            let made = executor.read(results)?;
            for (x, y) in input.iter().zip(made) {
                // x -> x a + x from x, LINKS times, for eight factors a; their sum.
                let chain = |x: f64| -> f64 {
                    (0..CHAINS).map(|k| x * (1.0 + f64::from(k) * 1e-4).powi(LINKS as i32)).sum()
                };
                for (x, y) in x.to_array().into_iter().zip(y.to_array()) {
                    let expected = chain(f64::from(x));
                    let error = (f64::from(y) - expected).abs();
                    assert!(error <= 1e-4 * expected.abs() + 1e-6, "{device}: {y}, not {expected}");
                }
            }
        }
        Ok(())
    }

    #[test]
    fn floors_are_positive_and_add_up() -> Result<(), GpuError> {
        let floors = Floors::measure(&mut Executor::from(crate::CpuExecutor::new()))?;
        assert!(floors.bytes_per_second > 1e8 && floors.flops > 1e8 && floors.dispatch > 0.0, "{floors:?}");
        let floors = Floors { bytes_per_second: 100.0, flops: 10.0, dispatch: 0.5 };
        assert_eq!(floors.seconds(200.0, 10.0, 2.0), 3.0);
        assert_eq!(floors.seconds(200.0, 100.0, 2.0), 11.0);
        Ok(())
    }
}
