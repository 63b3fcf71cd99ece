//! Measures the primitives on every executor of this machine, in milliseconds: the best of ten rounds of ten runs. Also
//! measures an indirect dispatch of one workgroup that depends on the previous one, in microseconds.
//!
//! `cargo run --release -p splashdown-gpu --example primitives [LENGTH...]`
//!
//! With `WGPU_VALIDATION_INDIRECT_CALL=1` wgpu validates the arguments of indirect dispatches, which this project
//! disables.

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use glam::{UVec2, uvec2};
use splashdown_gpu::compact::Compact;
use splashdown_gpu::scan::Scan;
use splashdown_gpu::sort::Sort;
use splashdown_gpu::{
    BufferSet, CpuExecutor, DeviceRequest, DispatchSize, Executor, Gpu, GpuError, GpuExecutor, PassDesc,
    Recording, bindings, list_adapters, testing,
};

bindings! {
    struct CountBindings {
        counter: write [u32],
    }
}

static COUNT: PassDesc = PassDesc {
    label: "example.count",
    wgsl: "#bindings\n@compute @workgroup_size(1)\nfn count() { counter[0] += 1u; }",
    imports: &[],
    entry: "count",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: CountBindings::LIST,
    cpu: |_, slots| {
        let CountBindings { counter } = slots.into();
        counter[0] = counter[0].wrapping_add(1);
    },
};

/// Number of indirect dispatches in a recording.
const DISPATCHES: u32 = 256;

const RUNS: u32 = 10;

fn main() -> Result<(), Box<dyn Error>> {
    let lengths: Vec<u32> =
        std::env::args().skip(1).map(|length| length.parse()).collect::<Result<_, _>>()?;
    let lengths = if lengths.is_empty() { vec![4096, 16_384, 65_536, 1 << 20] } else { lengths };
    let mut executors = vec![("CPU".to_owned(), Executor::from(CpuExecutor::new()))];
    for adapter in list_adapters() {
        let gpu = Arc::new(Gpu::open(&DeviceRequest::Named(adapter.info.name))?);
        executors.push((gpu.name(), GpuExecutor::new(gpu).into()));
    }
    for (name, executor) in &mut executors {
        say(&format!("{name}\n{:>10} {:>9} {:>9} {:>9}", "length", "scan", "compact", "sort"));
        for &len in &lengths {
            let times = measure(executor, len)?.map(|time| format!("{time:9.3}"));
            say(&format!("{len:>10} {}", times.join(" ")));
        }
        say(&format!("an indirect dispatch takes {:.2} us", indirect(executor)?));
    }
    Ok(())
}

fn measure(executor: &mut Executor, len: u32) -> Result<[f64; 3], GpuError> {
    let numbers: Vec<u32> = (0..len).map(testing::noise).collect();
    let counts = executor.create_from("counts", &numbers.iter().map(|n| n % 5).collect::<Vec<u32>>())?;
    let starts = executor.create::<u32>("starts", len as usize + 1)?;
    let counted = executor.create::<u32>("counted", 4)?;
    let shuffled: Vec<UVec2> = (0..len).map(|i| uvec2(numbers[i as usize], i)).collect();
    let shuffled = executor.create_from("shuffled", &shuffled)?;
    let pairs = executor.create::<UVec2>("pairs", len as usize)?;

    let mut recordings = ["scan", "compact", "sort"].map(Recording::new);
    Scan::new(executor, len)?.record(&mut recordings[0], counts, starts);
    Compact::new(executor, len, 64)?.record(&mut recordings[1], counts, starts, counted);
    recordings[2].copy(shuffled, pairs);
    Sort::new(executor, len)?.record(&mut recordings[2], pairs);

    let mut times = [0.0; 3];
    for (time, recording) in times.iter_mut().zip(&recordings) {
        *time = best(executor, recording)?;
    }
    Ok(times)
}

/// Microseconds of an indirect dispatch that depends on the previous one.
fn indirect(executor: &mut Executor) -> Result<f64, GpuError> {
    let arguments = executor.create_from("arguments", &[1_u32; 3])?;
    let counter = executor.create::<u32>("counter", 1)?;
    let buffers = BufferSet::new().with("counter", counter);
    let mut recording = Recording::new("indirect");
    for _ in 0..DISPATCHES {
        recording.dispatch(&COUNT, DispatchSize::indirect(arguments), &buffers);
    }
    Ok(1000.0 * best(executor, &recording)? / f64::from(DISPATCHES))
}

/// Milliseconds of one run in a sequence of `RUNS`.
fn best(executor: &mut Executor, once: &Recording) -> Result<f64, GpuError> {
    let mut recording = Recording::new("measured");
    (0..RUNS).for_each(|_| recording.append(once));
    let mut best = f64::MAX;
    for _ in 0..10 {
        let started = Instant::now();
        executor.run(&recording)?;
        executor.wait()?;
        best = best.min(started.elapsed().as_secs_f64() * 1000.0 / f64::from(RUNS));
    }
    Ok(best)
}

#[expect(clippy::print_stdout, reason = "an example prints its results")]
fn say(line: &str) {
    println!("{line}");
}
