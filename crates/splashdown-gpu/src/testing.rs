//! What the tests of this and other crates share: the executors there are, skipping that is loud, and the gate.
//!
//! Not for use outside of tests: it panics.
//!
//! ```
//! use splashdown_gpu::testing;
//! for (name, mut executor) in testing::executors("doubling") {
//!     let buffer = executor.create_from("numbers", &[1_u32, 2])?;
//!     assert_eq!(executor.read(buffer)?, [1, 2], "{name}");
//! }
//! # Ok::<(), splashdown_gpu::GpuError>(())
//! ```

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use crate::{CpuExecutor, DeviceRequest, Executor, Gpu, GpuExecutor, PassDesc, check};

/// The device that all tests of a process share, opened once: software Vulkan where there is one, so that all
/// machines test alike, else any GPU.
///
/// Where there is none it prints `SKIPPED` with the test's name and the reason.
///
/// # Panics
/// Where there is none and the environment has `CI=true`: there nothing may be skipped for want of a driver.
pub fn gpu_or_skip(test_name: &str) -> Option<Arc<Gpu>> {
    static GPU: OnceLock<Result<Arc<Gpu>, String>> = OnceLock::new();
    let gpu = GPU.get_or_init(|| {
        Gpu::open(&DeviceRequest::Software)
            .or_else(|_| Gpu::open(&DeviceRequest::Auto))
            .map(Arc::new)
            .map_err(|error| error.to_string())
    });
    match gpu {
        Ok(gpu) => Some(Arc::clone(gpu)),
        Err(reason) => {
            assert!(
                std::env::var("CI").as_deref() != Ok("true"),
                "{test_name}: CI=true forbids skipping, and {reason}"
            );
            // Not by `eprintln!`: the test harness keeps that to itself when a test passes.
            let _ = writeln!(std::io::stderr(), "SKIPPED: {test_name}: {reason}");
            None
        }
    }
}

/// The CPU executor and, where there is a device, a GPU executor: fresh, with names for messages. New buffers are
/// poisoned.
///
/// # Panics
/// As [`gpu_or_skip`].
pub fn executors(test_name: &str) -> Vec<(&'static str, Executor)> {
    let mut executors = vec![("CPU", Executor::from(CpuExecutor::new()))];
    if let Some(gpu) = gpu_or_skip(test_name) {
        executors.push(("GPU", Executor::from(GpuExecutor::new(gpu))));
    }
    for (_, executor) in &mut executors {
        executor.poison();
    }
    executors
}

/// A number that looks random and is the same for the same `i`, on every machine.
pub fn noise(i: u32) -> u32 {
    // The PCG hash of M. Jarzynski and M. Olano, "Hash functions for GPU rendering", JCGT 9 (2020).
    let state = i.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// What is wrong with a crate's passes: everything the [gate](check::check) reports, labels given twice, and
/// every `.wgsl` file below `source_folder` (`concat!(env!("CARGO_MANIFEST_DIR"), "/src")`) that is neither the
/// text of a pass nor one of its imports.
///
/// # Panics
/// If a folder or file cannot be read.
pub fn gate(source_folder: &Path, passes: &[&'static PassDesc]) -> Vec<String> {
    let mut wrong = Vec::new();
    for (i, pass) in passes.iter().enumerate() {
        if let Err(difference) = check::check(pass) {
            wrong.push(format!("{}: {difference}", pass.label));
        }
        if passes[..i].iter().any(|other| other.label == pass.label) {
            wrong.push(format!("two passes have the label {}", pass.label));
        }
    }
    let mut files = Vec::new();
    find_wgsl(source_folder, &mut files);
    for file in files {
        let text =
            std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let used = passes
            .iter()
            .any(|pass| pass.wgsl == text || pass.imports.iter().any(|module| module.source == text));
        if !used {
            wrong.push(format!("{}: no pass uses it", file.display()));
        }
    }
    wrong
}

fn find_wgsl(folder: &Path, files: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for entry in entries {
        let path = entry.unwrap_or_else(|error| panic!("{}: {error}", folder.display())).path();
        if path.is_dir() {
            find_wgsl(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "wgsl") {
            files.push(path);
        }
    }
}
