//! The report.

use std::fmt::Write;

use splashdown_gpu::PassDesc;

use crate::chip::{CHIPS, Chip, Compiled, MEASURED, MEASURED_STEP};

/// The passes of a step of `wcsph` without bodies.
const STEP: [&str; 6] = [
    "scan.reduce",
    "scan.spread",
    "cells.scatter",
    "cells.reorder",
    "density.wendland_c2",
    "force_integrate.wendland_c2",
];
/// The numbers of particles of the predictions.
const SIZES: [(&str, f64); 3] = [("64K", 65_536.0), ("1M", 1_048_576.0), ("10M", 10_485_760.0)];

/// The predicted milliseconds of a step for each of the sizes.
fn step_times(chip: &Chip, passes: &[&'static PassDesc], compiled: &[Compiled]) -> [f64; 3] {
    SIZES.map(|(_, particles)| {
        let seconds: f64 = STEP
            .iter()
            .filter_map(|label| {
                let place = compiled.iter().position(|one| one.label == *label)?;
                Some(chip.seconds(passes[place], &compiled[place], particles))
            })
            .sum();
        1000.0 * seconds
    })
}

/// The report as Markdown. `all` holds the compiled passes of each chip, in the order of `passes`.
pub fn page(passes: &[&'static PassDesc], all: &[(&Chip, Vec<Compiled>)]) -> String {
    let mut page = String::from(
        "# Shaders\n\n\
         Written by `cargo xtask shaders`. Mesa's AMD driver compiles every compute pass for chips that need not be\n\
         present. Nothing is executed: registers, spills, waves and instructions are what the compiler reports, times are\n\
         predictions.\n\n\
         ## Predicted times of a step\n\n\
         A step of `wcsph` without bodies, support radius of two spacings. The prediction of a pass is 4 us for the dispatch,\n\
         plus the longer of two times: that of its instructions, at one instruction per lane and clock on all compute units,\n\
         and that of its memory traffic, at the bandwidth of the data sheet with each element transferred once. The longest\n\
         loop within the loop over rows of cells counts 170 candidates, of which passes test one, four or eight per round;\n\
         all else in the loop over rows counts 9 times, also the formula of a pair where it has a loop of its own. Stalls,\n\
         caches and the images at walls are not modelled. The prediction is therefore optimistic, and is meant to compare two versions of a pass and not two\n\
         products.\n\n",
    );
    let _ = writeln!(page, "| chip | {} |\n|---|---:|---:|---:|", SIZES.map(|(name, _)| name).join(" | "));
    for (chip, compiled) in all {
        let times = step_times(chip, passes, compiled).map(|time| format!("{time:.3} ms"));
        let _ = writeln!(page, "| {} ({}) | {} |", chip.family, chip.product, times.join(" | "));
    }
    if let Some((_, compiled)) = all.iter().find(|(chip, _)| chip.family == MEASURED.family) {
        let predicted = step_times(&MEASURED, passes, compiled);
        let row = |times: [f64; 3]| times.map(|time| format!("{time:.3} ms")).join(" | ");
        let ratios: Vec<String> = MEASURED_STEP
            .iter()
            .zip(predicted)
            .map(|(measured, time)| format!("{:.2}", measured / time))
            .collect();
        let _ = write!(
            page,
            "\nOne product has been measured ([performance](performance.md#an-nvidia-h200)). Its prediction uses the instructions\n\
             of {}, a chip of another vendor.\n\n\
             | {} | {} |\n|---|---:|---:|---:|\n| predicted | {} |\n| measured | {} |\n| measured over predicted | {} |\n",
            MEASURED.family,
            MEASURED.product,
            SIZES.map(|(name, _)| name).join(" | "),
            row(predicted),
            row(MEASURED_STEP),
            ratios.join(" | ")
        );
    }
    page.push_str(
        "\n## Passes\n\n\
         *VGPRs* are vector registers, *waves* the waves per SIMD that they and shared memory allow, *loop* the instructions\n\
         of the loop over neighbours. Spilled registers are counted on all chips.\n\n",
    );
    let names: Vec<String> = CHIPS.iter().map(|chip| format!("{0} VGPRs | {0} waves", chip.family)).collect();
    let _ = writeln!(page, "| pass | {} | instructions | loop | spills |", names.join(" | "));
    let _ = writeln!(page, "|---|{}---:|---:|---:|", "---:|".repeat(2 * CHIPS.len()));
    for (place, pass) in passes.iter().enumerate() {
        let of = |compiled: &Vec<Compiled>| format!("{} | {}", compiled[place].vgprs, compiled[place].waves);
        let columns: Vec<String> = all.iter().map(|(_, compiled)| of(compiled)).collect();
        let first = &all[0].1[place];
        let inner = first.program.inner;
        let inner = if inner > 0 { inner.to_string() } else { "-".to_owned() };
        let spills: u64 = all.iter().map(|(_, compiled)| compiled[place].spills).sum();
        let _ = writeln!(
            page,
            "| {} | {} | {} | {inner} | {spills} |",
            pass.label,
            columns.join(" | "),
            first.instructions
        );
    }
    page.push_str("\nInstructions and loops are those of ");
    page.push_str(CHIPS[0].family);
    page.push_str(", compiled without the bounds checks of browsers.\n");
    page
}
