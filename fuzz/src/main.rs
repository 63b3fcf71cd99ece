//! `cargo xtask fuzz [TARGET ...] [--minutes N] [--seed N]`: searches for longer than the tests do.

#![expect(clippy::print_stdout, reason = "a program that prints its results")]

use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use fuzz::memory::Counting;
use fuzz::{Target, search, targets};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

/// Returns whether there are no findings.
fn run() -> Result<bool> {
    let (mut minutes, mut seed, mut names) = (60.0, 1, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut number = || -> Result<f64> {
            let text = arguments.next().unwrap_or_default();
            text.parse().with_context(|| format!("{argument} needs a number, got `{text}`"))
        };
        match argument.as_str() {
            "--minutes" => minutes = number()?,
            "--seed" => seed = number()? as u64,
            name => names.push(name.to_owned()),
        }
    }
    let mut all = targets();
    if let Some(name) = names.iter().find(|name| all.iter().all(|target| target.name != **name)) {
        let known: Vec<&str> = all.iter().map(|target| target.name).collect();
        bail!("there is no target `{name}`; the targets are {}", known.join(", "));
    }
    all.retain(|target| names.is_empty() || names.iter().any(|name| name == target.name));
    splashdown_io::set_input_limit(Some(fuzz::INPUT_LIMIT));
    // A finding reports its panic.
    std::panic::set_hook(Box::new(|_| {}));
    let time = Duration::from_secs_f64(minutes * 60.0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut clean = true;
    for group in all.chunks(threads) {
        let results: Vec<Result<bool>> = std::thread::scope(|scope| {
            let started: Vec<_> =
                group.iter().map(|target| scope.spawn(move || report(target, time, seed))).collect();
            started.into_iter().map(|thread| thread.join().unwrap_or(Ok(false))).collect()
        });
        for result in results {
            clean &= result?;
        }
    }
    Ok(clean)
}

/// Searches one target and writes a finding to `target/fuzz`; returns whether there is none.
fn report(target: &Target, time: Duration, seed: u64) -> Result<bool> {
    let outcome = search(target, time, seed)?;
    println!(
        "{:12} {:>10} inputs, {:>8} valid, at most {:>3} MiB",
        target.name,
        outcome.inputs,
        outcome.accepted,
        outcome.memory >> 20
    );
    let Some(finding) = outcome.finding else { return Ok(true) };
    let folder = Path::new("target/fuzz").join(target.name);
    fs::create_dir_all(&folder)?;
    let path = folder.join(format!("seed-{seed}"));
    fs::write(&path, &finding.input)?;
    println!("{:12} FOUND {}: {}", target.name, path.display(), finding.reason);
    Ok(false)
}
