//! Shared test tools: the executors of this machine, visible skipping, and the gate.
//!
//! Only for tests, because it panics.
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

/// The device that all tests of a process share, opened once: software Vulkan if it is installed, so that all
/// machines run the same tests, otherwise any GPU.
///
/// Without a device it prints `SKIPPED` with the test's name and the reason.
///
/// # Panics
/// Without a device if the environment has `CI=true`, where no test may be skipped because of a missing driver.
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
            // Not `eprintln!`, whose output the test harness hides if the test passes.
            let _ = writeln!(std::io::stderr(), "SKIPPED: {test_name}: {reason}");
            None
        }
    }
}

/// A new CPU executor and, if there is a device, a new GPU executor, with names for messages. New buffers are
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

/// A pseudo-random number that depends on `i` only.
pub fn noise(i: u32) -> u32 {
    // The PCG hash of M. Jarzynski and M. Olano, "Hash functions for GPU rendering", JCGT 9 (2020).
    let state = i.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// The problems of a crate's passes: everything the [gate](check::check) reports, labels given twice, and below
/// `source_folder` (`concat!(env!("CARGO_MANIFEST_DIR"), "/src")`):
///
/// * every `.wgsl` file that is neither the text of a pass nor one of its imports,
/// * every pass whose entry point differs from the name of its file,
/// * every `static` [`PassDesc`] of the Rust files that is not in `passes`.
///
/// # Panics
/// If a folder or file cannot be read.
pub fn gate(source_folder: &Path, passes: &[&'static PassDesc]) -> Vec<String> {
    let mut problems = Vec::new();
    for (i, pass) in passes.iter().enumerate() {
        if let Err(difference) = check::check(pass) {
            problems.push(format!("{}: {difference}", pass.label));
        }
        if passes[..i].iter().any(|other| other.label == pass.label) {
            problems.push(format!("two passes have the label {}", pass.label));
        }
    }
    let mut files = Vec::new();
    find_files(source_folder, &mut files);
    for file in files {
        let text =
            std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let found = if file.extension().is_some_and(|extension| extension == "rs") {
            unregistered(&text, passes)
        } else {
            misplaced(&file, &text, passes)
        };
        problems.extend(found.into_iter().map(|problem| format!("{}: {problem}", file.display())));
    }
    problems
}

/// The problems of a WGSL file.
fn misplaced(file: &Path, text: &str, passes: &[&'static PassDesc]) -> Vec<String> {
    let own: Vec<_> = passes.iter().filter(|pass| pass.wgsl == text).collect();
    let is_imported = || {
        let mut imports = passes.iter().flat_map(|pass| pass.imports);
        imports.any(|module| module.source == text)
    };
    if own.is_empty() && !is_imported() {
        return vec!["no pass uses it".into()];
    }
    let stem = file.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    own.iter()
        .filter(|pass| text.contains("#bindings") && pass.entry != stem)
        .map(|pass| format!("{} has the entry point `{}`, not `{stem}`", pass.label, pass.entry))
        .collect()
}

/// The passes that a Rust file declares as statics, before its tests, and that are not in the registry.
fn unregistered(text: &str, passes: &[&'static PassDesc]) -> Vec<String> {
    let code = |line: &&str| !line.trim_start().starts_with("//");
    let text: String = text.lines().take_while(|line| line.trim() != "#[cfg(test)]").filter(code).collect();
    let mut problems = Vec::new();
    for declaration in text.split("static ").skip(1) {
        let Some((name, body)) = declaration.split_once(": PassDesc =") else { continue };
        if !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
            continue;
        }
        let label =
            body.split_once("label: \"").and_then(|(_, rest)| rest.split_once('"')).map(|(label, _)| label);
        match label {
            Some(label) if passes.iter().any(|pass| pass.label == label) => {}
            Some(label) => problems.push(format!("`passes()` lacks {name} ({label:?})")),
            None => problems.push(format!("the label of {name} is not a literal")),
        }
    }
    problems
}

fn find_files(folder: &Path, files: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for entry in entries {
        let path = entry.unwrap_or_else(|error| panic!("{}: {error}", folder.display())).path();
        if path.is_dir() {
            find_files(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "wgsl" || extension == "rs") {
            files.push(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pass_missing_from_the_registry_is_found() {
        let text = |label: &str| format!("pub static PASS: PassDesc = PassDesc {{\n    label: {label},\n}};");
        let registry = crate::passes();
        let known = format!("{:?}", registry[0].label);
        assert_eq!(unregistered(&text(&known), &registry), [""; 0]);
        let found = unregistered(&text("\"left.out\""), &registry);
        assert_eq!(found, ["`passes()` lacks PASS (\"left.out\")"]);
        assert_eq!(unregistered(&text("LABEL"), &registry), ["the label of PASS is not a literal"]);
        let tests = format!("#[cfg(test)]\nmod tests {{ {} }}", text("\"a.test\""));
        assert_eq!(unregistered(&tests, &registry), [""; 0]);
    }
}
