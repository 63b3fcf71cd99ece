//! Times of the primitives on every executor of this machine, in milliseconds; the best of ten rounds of ten runs.
//!
//! `cargo run --release -p splashdown-gpu --example primitives [LENGTH...]`

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use glam::{UVec2, uvec2};
use splashdown_gpu::compact::Compact;
use splashdown_gpu::reduce::{Operation, Reduce};
use splashdown_gpu::scan::Scan;
use splashdown_gpu::sort::Sort;
use splashdown_gpu::{
    CpuExecutor, DeviceRequest, Executor, Gpu, GpuError, GpuExecutor, Recording, list_adapters, testing,
};

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
        say(&format!(
            "{name}\n{:>10} {:>9} {:>9} {:>9} {:>9}",
            "length", "scan", "reduce", "compact", "sort"
        ));
        for &len in &lengths {
            let times = measure(executor, len)?.map(|time| format!("{time:9.3}"));
            say(&format!("{len:>10} {}", times.join(" ")));
        }
    }
    Ok(())
}

fn measure(executor: &mut Executor, len: u32) -> Result<[f64; 4], GpuError> {
    let numbers: Vec<u32> = (0..len).map(testing::noise).collect();
    let counts = executor.create_from("counts", &numbers.iter().map(|n| n % 5).collect::<Vec<u32>>())?;
    let starts = executor.create::<u32>("starts", len as usize + 1)?;
    let values = executor.create_from("values", &numbers.iter().map(|n| *n as f32).collect::<Vec<f32>>())?;
    let result = executor.create::<f32>("result", 1)?;
    let counted = executor.create::<u32>("counted", 4)?;
    let shuffled: Vec<UVec2> = (0..len).map(|i| uvec2(numbers[i as usize], i)).collect();
    let shuffled = executor.create_from("shuffled", &shuffled)?;
    let pairs = executor.create::<UVec2>("pairs", len as usize)?;

    let mut recordings = ["scan", "reduce", "compact", "sort"].map(Recording::new);
    Scan::new(executor, len)?.record(&mut recordings[0], counts, starts);
    Reduce::new(executor, len, Operation::Sum)?.record(&mut recordings[1], values, result);
    Compact::new(executor, len, 64)?.record(&mut recordings[2], counts, starts, counted);
    recordings[3].copy(shuffled, pairs);
    Sort::new(executor, len)?.record(&mut recordings[3], pairs);

    let mut times = [0.0; 4];
    for (time, recording) in times.iter_mut().zip(&recordings) {
        *time = best(executor, recording)?;
    }
    Ok(times)
}

/// Milliseconds of one run when `RUNS` follow one another.
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

#[expect(clippy::print_stdout, reason = "what an example measures goes to the terminal")]
fn say(line: &str) {
    println!("{line}");
}
