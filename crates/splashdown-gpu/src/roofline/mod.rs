//! The roofline of a device: its copy bandwidth, its arithmetic throughput, and the cost of a dispatch that depends on
//! the previous one.
//!
//! The time of a step is reported relative to these limits, measured in the same process on the same device, so that the
//! ratio is comparable between machines.
//!
//! *How it works.* Three passes serve only the measurement. `copy` copies 32 MiB from one buffer to another, more than
//! fits into caches. `madd` runs eight independent chains of fused multiply-adds per lane, enough to hide their latency.
//! `nothing` is one workgroup that increments a counter, many times in one submission, each after the previous one. The
//! best of several rounds is reported, because a roofline is an upper limit.

mod cpu;

use web_time::Instant;

use glam::Vec4;

use crate::{BufferSet, DispatchSize, Executor, GpuError, PassDesc, Recording, bindings, wgsl};

/// Vectors per copy: 32 MiB.
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

bindings! {
    struct StreamBindings {
        values: read [Vec4],
        results: write [Vec4],
    }
}

bindings! {
    struct CountBindings {
        counter: write [u32],
    }
}

static COPY: PassDesc = PassDesc {
    label: "roofline.copy",
    wgsl: include_str!("copy.wgsl"),
    imports: &[wgsl::INDEX],
    entry: "copy",
    workgroup_size: [256, 1, 1],
    constants: &[],
    bindings: StreamBindings::LIST,
    cpu: |_, slots| cpu::copy(slots.into()),
};

static MADD: PassDesc = PassDesc {
    label: "roofline.madd",
    wgsl: include_str!("madd.wgsl"),
    imports: &[wgsl::INDEX],
    entry: "madd",
    workgroup_size: [256, 1, 1],
    constants: &[("LINKS", LINKS as f64)],
    bindings: StreamBindings::LIST,
    cpu: |work, slots| cpu::madd(work, slots.into()),
};

static NOTHING: PassDesc = PassDesc {
    label: "roofline.nothing",
    wgsl: include_str!("nothing.wgsl"),
    imports: &[],
    entry: "nothing",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: CountBindings::LIST,
    cpu: |_, slots| cpu::nothing(slots.into()),
};

pub(crate) static PASSES: [&PassDesc; 3] = [&COPY, &MADD, &NOTHING];

/// The limits of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roofline {
    /// Bytes read and written by a copy of large arrays, per second.
    pub bytes_per_second: f64,
    /// Single-precision operations per second; a fused multiplication and addition counts two.
    pub flops: f64,
    /// Seconds from one dispatch to the next that depends on it.
    pub dispatch: f64,
}

impl Roofline {
    /// Measures the limits; takes about a second.
    ///
    /// # Errors
    /// Those of the device.
    pub fn measure(executor: &mut Executor) -> Result<Self, GpuError> {
        // Initialized, because memory that was never written maps to one page of zeros, which is read from a cache.
        let values = executor.create_from("values", &vec![Vec4::ONE; COPIED])?;
        let results = executor.create::<Vec4>("results", COPIED)?;
        let counter = executor.create::<u32>("counter", 1)?;
        let mut buffers = BufferSet::new();
        buffers.add("values", values);
        buffers.add("results", results);
        buffers.add("counter", counter);
        let measured = Self::of_passes(executor, &buffers);
        executor.free(buffers.ids())?;
        measured
    }

    fn of_passes(executor: &mut Executor, buffers: &BufferSet) -> Result<Self, GpuError> {
        let mut time = |pass: &'static PassDesc, size, times| {
            let mut recording = Recording::new(pass.label);
            for _ in 0..times {
                recording.dispatch(pass, size, buffers);
            }
            best(executor, &recording)
        };
        let copy = time(&COPY, DispatchSize::Items(COPIED as u32), COPIES)?;
        let madd = time(&MADD, DispatchSize::Items(LANES), 1)?;
        let nothing = time(&NOTHING, DispatchSize::Groups(1), DISPATCHES)?;
        Ok(Self {
            bytes_per_second: 2.0 * 16.0 * COPIED as f64 * f64::from(COPIES) / copy,
            flops: 2.0 * 4.0 * f64::from(CHAINS) * f64::from(LINKS) * f64::from(LANES) / madd,
            dispatch: nothing / f64::from(DISPATCHES),
        })
    }

    /// The shortest time in s for this many bytes, operations and dependent dispatches, if transfers and arithmetic
    /// overlap.
    pub fn seconds(&self, bytes: f64, operations: f64, dispatches: f64) -> f64 {
        (bytes / self.bytes_per_second).max(operations / self.flops) + dispatches * self.dispatch
    }
}

/// Seconds of the fastest round, after one warm-up round.
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
    fn the_measured_passes_compute_correct_results() -> Result<(), GpuError> {
        for (device, mut executor) in executors("the_measured_passes_compute_correct_results") {
            let n = 1000;
            let input: Vec<Vec4> = (0..n).map(|i| Vec4::new(i as f32, 0.25, -1.0, 0.5) / n as f32).collect();
            let values = executor.create_from("values", &input)?;
            let results = executor.create::<Vec4>("results", n as usize)?;
            let counter = executor.create_from("counter", &[0_u32])?;
            let mut recording = Recording::new("roofline");
            let mut buffers = BufferSet::new();
            buffers.add("values", values);
            buffers.add("results", results);
            buffers.add("counter", counter);
            recording.dispatch(&COPY, DispatchSize::Items(n), &buffers);
            for _ in 0..7 {
                recording.dispatch(&NOTHING, DispatchSize::Groups(1), &buffers);
            }
            executor.run(&recording)?;
            assert_eq!(executor.read(results)?, input, "{device}");
            assert_eq!(executor.read(counter)?, [7], "{device}");

            let mut recording = Recording::new("roofline");
            recording.dispatch(&MADD, DispatchSize::Items(n), &buffers);
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
    fn limits_are_positive_and_add_up() -> Result<(), GpuError> {
        let roofline = Roofline::measure(&mut Executor::from(crate::CpuExecutor::new()))?;
        assert!(
            roofline.bytes_per_second > 1e8 && roofline.flops > 1e8 && roofline.dispatch > 0.0,
            "{roofline:?}"
        );
        let roofline = Roofline { bytes_per_second: 100.0, flops: 10.0, dispatch: 0.5 };
        assert_eq!(roofline.seconds(200.0, 10.0, 2.0), 3.0);
        assert_eq!(roofline.seconds(200.0, 100.0, 2.0), 11.0);
        Ok(())
    }
}
