//! The search for inputs that a target does not handle.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use anyhow::Result;
use fastrand::Rng;

use crate::memory::peak_of;
use crate::mutate::mutate;
use crate::targets::Target;

/// Time that an input may take. Debug builds on a busy machine are slow.
const SLOW: Duration = Duration::from_secs(5);

/// An input with an unacceptable effect.
#[derive(Debug)]
pub struct Finding {
    /// The effect.
    pub reason: String,
    /// The input.
    pub input: Vec<u8>,
}

/// The result of a search.
#[derive(Debug, Default)]
pub struct Outcome {
    /// Number of inputs.
    pub inputs: u64,
    /// Number of inputs that the target accepted.
    pub accepted: u64,
    /// The most memory that an input used, in bytes.
    pub memory: usize,
    /// The first finding, which ends the search.
    pub finding: Option<Finding>,
}

/// Tries changed seeds for this time. The same number gives the same inputs.
///
/// # Errors
/// If the files of a target cannot be written.
pub fn search(target: &Target, time: Duration, number: u64) -> Result<Outcome> {
    let seeds = (target.seeds)()?;
    let folder = tempfile::tempdir()?;
    let mut rng = Rng::with_seed(number);
    let mut outcome = Outcome::default();
    let begun = Instant::now();
    for seed in &seeds {
        attempt(target, folder.path(), seed.clone(), &mut outcome);
    }
    while begun.elapsed() < time && outcome.finding.is_none() {
        attempt(target, folder.path(), mutate(&seeds, &mut rng), &mut outcome);
    }
    Ok(outcome)
}

/// Tries one input.
///
/// # Errors
/// If the files of the target cannot be written.
pub fn replay(target: &Target, input: Vec<u8>) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    attempt(target, tempfile::tempdir()?.path(), input, &mut outcome);
    Ok(outcome)
}

fn attempt(target: &Target, folder: &std::path::Path, input: Vec<u8>, outcome: &mut Outcome) {
    let run = || {
        let begun = Instant::now();
        let outcome = peak_of(|| catch_unwind(AssertUnwindSafe(|| (target.run)(&input, folder))));
        (outcome, begun.elapsed())
    };
    let ((result, memory), mut time) = run();
    // The machine may have paused: only an input that is slow every time counts.
    for _ in 0..2 {
        if time > SLOW {
            time = time.min(run().1);
        }
    }
    outcome.inputs += 1;
    outcome.memory = outcome.memory.max(memory);
    let reason = match result {
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
            format!("panic: {text}")
        }
        Ok(_) if time > SLOW => format!("{:.1} s for {} bytes", time.as_secs_f64(), input.len()),
        Ok(_) if memory > target.memory => format!("{} MiB for {} bytes", memory >> 20, input.len()),
        Ok(accepted) => {
            outcome.accepted += u64::from(accepted);
            return;
        }
    };
    outcome.finding = Some(Finding { reason, input });
}
