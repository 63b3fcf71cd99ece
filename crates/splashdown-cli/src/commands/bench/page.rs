//! The measurements as Markdown.

use super::measure::{Row, WARM_UP};
use crate::{human, summary};

/// The properties of all rows of one device and number of threads, and the column headings.
pub fn header(row: &Row, another: bool) -> String {
    format!(
        "{}`{}` on {}: median of {} rounds after {WARM_UP} steps.\n\n\
         Measured limits: copies {}/s, {:.0} GFLOP/s, {:.2} us per dependent dispatch.\n\n\
         | particles | neighbours | memory | ms per step | fastest | ns per particle | particle-steps/s | over the roofline |\n\
         |---:|---:|---:|---:|---:|---:|---:|---:|",
        if another { "\n" } else { "" },
        row.solver,
        row.device,
        row.rounds,
        human::bytes(row.copy_bytes_per_second as u64),
        1e-9 * row.flops,
        1e6 * row.dispatch_seconds
    )
}

/// One row of the table.
pub fn line(row: &Row) -> String {
    format!(
        "| {} | {:.1} | {} | {:.3} | {:.3} | {:.1} | {} | {:.1} |",
        human::count(row.particles),
        row.neighbours,
        human::bytes(row.memory),
        1e3 * row.seconds_per_step,
        1e3 * row.fastest,
        row.nanoseconds_per_particle,
        human::scaled(row.particle_steps_per_second).trim_end(),
        row.over_roofline
    )
}

/// Comparisons between rows, and the passes of each row.
pub fn closing(rows: &[Row], no_passes: bool) -> String {
    let mut text = growth(rows) + &scaling(rows) + &pressures(rows);
    if let Some(peak) = rows.last().and_then(|row| row.peak_memory) {
        text += &format!("\nPeak memory of this process: {}\n", human::bytes(peak));
    }
    for row in rows.iter().filter(|row| !no_passes && row.timed_steps > 0) {
        text += &format!(
            "\n{} particles on {}, by pass:\n\n{}\n",
            human::count(row.particles),
            row.device,
            summary::passes(&row.timings, row.timed_steps)
        );
    }
    text
}

/// The iterations of implicit pressures.
fn pressures(rows: &[Row]) -> String {
    let mut text = String::new();
    for (row, pressure) in rows.iter().filter_map(|row| Some((row, row.pressure?))) {
        text += &format!(
            "\n{} particles on {}: {:.1} iterations per step to a mean error of {:.1e} (tolerance {:.1e}), mean compression \
             {:.3} %, {} simulated seconds per second\n",
            human::count(row.particles),
            row.device,
            pressure.iterations_per_step,
            pressure.residual,
            pressure.tolerance,
            100.0 * pressure.compression,
            human::three_digits(row.simulated_per_wall)
        );
    }
    text
}

/// The growth of the cost per particle with the number of particles.
fn growth(rows: &[Row]) -> String {
    let mut text = String::new();
    for group in rows.chunk_by(|a, b| a.device == b.device).filter(|group| group.len() > 1) {
        let costs = || group.iter().map(|row| row.nanoseconds_per_particle);
        let ratio = costs().fold(0.0, f64::max) / costs().fold(f64::INFINITY, f64::min);
        text += &format!(
            "\nCost per particle on {}, the largest over the smallest: {ratio:.2}\n",
            group[0].device
        );
    }
    text
}

/// The speed-up over the first number of threads, for each size.
fn scaling(rows: &[Row]) -> String {
    let Some(first) = rows.first() else { return String::new() };
    let mut text = String::new();
    for row in rows.iter().filter(|row| row.threads != first.threads) {
        let same = |other: &&Row| other.particles == row.particles && other.threads == first.threads;
        let Some(base) = rows.iter().find(same) else { continue };
        text += &format!(
            "\n{} particles on {} over {}: speed-up {:.2}\n",
            human::count(row.particles),
            human::counted(row.threads as u64, "thread"),
            first.threads,
            base.seconds_per_step / row.seconds_per_step
        );
    }
    text
}
