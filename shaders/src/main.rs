//! Compiles the compute passes for GPUs that need not be present: `cargo xtask shaders`.
//!
//! Mesa's AMD driver creates a device without hardware if `RADV_FORCE_FAMILY` names a chip. The driver reads it when it is
//! loaded, so each chip has a process of its own, which prints what the compiler reports as JSON.

mod chip;
mod driver;
mod page;
mod program;
mod spirv;

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};
use splashdown_gpu::PassDesc;

use chip::{CHIPS, Chip, Compiled};
use driver::{Driver, Report};

/// The argument of the process of a chip.
const ONE: &str = "--this-process";
/// The most vector registers of a pass: with more, a SIMD of Vega holds fewer than two waves.
const MOST_VGPRS: u64 = 128;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        [ONE] => print_compiled(),
        [ONE, label] => print_assembly(label),
        ["--assembly", label] => print(&output(&CHIPS[0], &[ONE, label])?),
        [] => print(&report()?),
        ["--out", path] => {
            let page = report()?;
            std::fs::write(path, &page).with_context(|| format!("cannot write {path}"))?;
            print(&page)
        }
        other => {
            bail!("this program takes `--out FILE`, `--assembly PASS` or nothing, got {}", other.join(" "))
        }
    }
}

#[expect(clippy::print_stdout, reason = "the output of the program")]
fn print(text: &str) -> Result<()> {
    println!("{text}");
    Ok(())
}

fn passes() -> Vec<&'static PassDesc> {
    [splashdown_gpu::passes(), splashdown::passes()].concat()
}

/// Prints the machine code of a pass for the chip of this process.
fn print_assembly(label: &str) -> Result<()> {
    let passes = passes();
    let pass = passes.iter().find(|pass| pass.label == label);
    let pass = pass.with_context(|| {
        let labels: Vec<&str> = passes.iter().map(|pass| pass.label).collect();
        format!("there is no pass {label:?}; there are {}", labels.join(", "))
    })?;
    print(&open()?.compile(pass, &spirv::spirv(pass, false)?)?.assembly.replace('\0', ""))
}

/// The device of this process's chip.
fn open() -> Result<Driver> {
    let driver = Driver::open()?;
    ensure!(
        driver.name.starts_with("Null hardware"),
        "{} is not a device without hardware: RADV_FORCE_FAMILY had no effect",
        driver.name
    );
    Ok(driver)
}

/// Compiles all passes for the chip of this process.
fn print_compiled() -> Result<()> {
    let driver = open()?;
    let compiled = passes().into_iter().map(|pass| {
        let report = driver.compile(pass, &spirv::spirv(pass, false)?)?;
        Ok(summary(pass, &report))
    });
    print(&serde_json::to_string(&compiled.collect::<Result<Vec<Compiled>>>()?)?)
}

fn summary(pass: &PassDesc, report: &Report) -> Compiled {
    let number = |name: &str| report.statistics.iter().find(|one| one.0 == name).map_or(0, |one| one.1);
    Compiled {
        label: pass.label.to_owned(),
        vgprs: number("VGPRs"),
        sgprs: number("SGPRs"),
        spills: number("Spilled VGPRs") + number("Spilled SGPRs"),
        scratch: number("Scratch size"),
        waves: number("Subgroups per SIMD"),
        instructions: number("Instructions"),
        program: program::program(&report.assembly),
    }
}

/// Compiles all passes for all chips.
fn report() -> Result<String> {
    let all = CHIPS.iter().map(|chip| Ok((chip, compile(chip)?))).collect::<Result<Vec<_>>>()?;
    let passes = passes();
    for (chip, compiled) in &all {
        ensure!(compiled.len() == passes.len(), "{}: {} passes were compiled", chip.family, compiled.len());
        check(chip, compiled)?;
    }
    Ok(page::page(&passes, &all))
}

/// Refuses passes that spill registers or use too many.
fn check(chip: &Chip, compiled: &[Compiled]) -> Result<()> {
    let reasons: Vec<String> = compiled
        .iter()
        .filter(|one| one.spills > 0 || one.scratch > 0 || one.vgprs > MOST_VGPRS)
        .map(|one| {
            format!(
                "{}: {} VGPRs, {} spilled, {} bytes of scratch",
                one.label, one.vgprs, one.spills, one.scratch
            )
        })
        .collect();
    ensure!(
        reasons.is_empty(),
        "{}: at most {MOST_VGPRS} VGPRs and no spills are allowed:\n{}",
        chip.family,
        reasons.join("\n")
    );
    Ok(())
}

/// Compiles all passes for a chip.
fn compile(chip: &Chip) -> Result<Vec<Compiled>> {
    serde_json::from_str(&output(chip, &[ONE])?).with_context(|| format!("the report for {}", chip.family))
}

/// The output of this program with these arguments, in a process for a chip.
fn output(chip: &Chip, arguments: &[&str]) -> Result<String> {
    let icd = icd().context(
        "Mesa's AMD driver was not found: install it (on Debian and Ubuntu `apt-get install mesa-vulkan-drivers`)",
    )?;
    let output = Command::new(std::env::current_exe()?)
        .args(arguments)
        .env("RADV_FORCE_FAMILY", chip.family)
        .env("VK_ICD_FILENAMES", &icd)
        .env("VK_DRIVER_FILES", &icd)
        .output()?;
    ensure!(output.status.success(), "{}: {}", chip.family, String::from_utf8_lossy(&output.stderr).trim());
    Ok(String::from_utf8(output.stdout)?)
}

/// The description of Mesa's AMD driver for the Vulkan loader.
fn icd() -> Option<PathBuf> {
    let folders = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d"];
    let files = folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten();
    let mut found: Vec<PathBuf> = files.map(|file| file.path()).collect();
    found.retain(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("radeon_icd") && name.contains(std::env::consts::ARCH)
    });
    found.sort();
    found.into_iter().next()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compiled(spills: u64, vgprs: u64) -> Compiled {
        Compiled {
            label: "pass".to_owned(),
            vgprs,
            sgprs: 128,
            spills,
            scratch: 0,
            waves: 8,
            instructions: 100,
            program: program::Program::default(),
        }
    }

    #[test]
    fn spills_and_too_many_registers_are_refused() {
        assert!(check(&CHIPS[0], &[compiled(0, 64)]).is_ok());
        assert!(check(&CHIPS[0], &[compiled(0, 64), compiled(1, 64)]).is_err());
        assert!(check(&CHIPS[0], &[compiled(0, MOST_VGPRS + 1)]).is_err());
    }
}
