//! The summary at the end of a run.

use std::collections::BTreeMap;
use std::path::Path;

use splashdown::Stats;
use splashdown::run::Summary;
use splashdown_gpu::Timings;
use splashdown_io::WrittenFile;
use splashdown_run::PictureTimings;

use crate::{console, human};

/// The numbers of a finished run.
pub fn numbers(summary: &Summary) -> String {
    let stats = &summary.stats;
    let particles = human::count(stats.particles.into());
    let mut rows = vec![
        ("simulated", format!("{:.4} s in {}", stats.time, human::counted(summary.frames.into(), "frame"))),
        ("wall time", human::duration(summary.wall)),
        ("steps", format!("{}, at the end at most {:.3e} s long", human::count(stats.steps), stats.dt)),
        (
            "speed",
            format!("{} simulated seconds per second", human::three_digits(summary.simulated_per_wall)),
        ),
        (
            "",
            format!(
                "{} particle-steps per second",
                human::scaled(summary.particle_steps_per_second).trim_end()
            ),
        ),
        (
            "time spent",
            format!(
                "{} in steps, {} in surfaces and frames",
                human::duration(summary.step_wall),
                human::duration(summary.frame_wall)
            ),
        ),
        (
            "density error",
            format!(
                "at most {} % too dense, {} % too thin",
                human::three_digits(100.0 * f64::from(summary.density_excess)),
                human::three_digits(100.0 * f64::from(summary.density_deficit))
            ),
        ),
        ("volume", volume(summary)),
        ("particles", particles),
    ];
    if stats.iterations > 0 {
        rows.insert(6, ("pressure", pressure(stats)));
        if let Some(tolerance) = summary.tolerance {
            rows.insert(7, ("", residual(summary.residual, tolerance)));
        }
    }
    if stats.viscous_iterations > 0 {
        let after = rows.iter().position(|row| row.0 == "density error").unwrap_or(rows.len());
        rows.insert(after, ("viscosity", viscosity(stats)));
    }
    if stats.emitted > 0 || stats.drained > 0 {
        let text = format!(
            "{} emitted, {} drained",
            human::counted(stats.emitted.into(), "particle"),
            human::count(stats.drained.into())
        );
        rows.push(("", text));
    }
    if stats.escaped > 0 {
        rows.push((
            "left the domain",
            format!("{}, through open sides", human::counted(stats.escaped.into(), "particle")),
        ));
    }
    if stats.non_finite > 0 {
        let [x, y, z] = stats.non_finite_place;
        let count = human::counted(stats.non_finite.into(), "particle");
        let text = format!("{count}, the first near ({x}, {y}, {z}) m");
        rows.push(("became NaN", text));
    }
    if stats.wall_corrections > 0 {
        let text = format!(
            "{} times a particle was moved back through a wall",
            human::count(stats.wall_corrections.into())
        );
        rows.push(("leaks", text));
    }
    console::table(&rows)
}

fn pressure(stats: &Stats) -> String {
    format!(
        "{:.1} iterations per step; mean compression {} %{}",
        stats.iterations as f64 / stats.steps.max(1) as f64,
        human::three_digits(100.0 * stats.mean_compression),
        unconverged(stats.unconverged)
    )
}

fn residual(residual: f32, tolerance: f32) -> String {
    let percent = |part: f32| human::three_digits(100.0 * f64::from(part));
    format!("residual at most {} % of the density, tolerance {} %", percent(residual), percent(tolerance))
}

fn viscosity(stats: &Stats) -> String {
    let each = stats.viscous_iterations as f64 / stats.steps.max(1) as f64;
    format!("{each:.1} iterations per step{}", unconverged(stats.viscous_unconverged))
}

fn unconverged(steps: u32) -> String {
    match steps {
        0 => String::new(),
        count => format!("; {} did not converge", human::counted(count.into(), "step")),
    }
}

fn volume(summary: &Summary) -> String {
    let [first, last] = summary.particle_volume;
    let particles = if last == first {
        format!("{} (particles)", human::volume(first))
    } else {
        format!("{} at the start, {} at the end (particles)", human::volume(first), human::volume(last))
    };
    match summary.volume {
        None => particles,
        Some([inside_first, inside_last]) => format!(
            "{particles}; surface with droplets initially {} ({}), finally {} ({})",
            human::volume(inside_first),
            change(inside_first, first),
            human::volume(inside_last),
            change(inside_last, last)
        ),
    }
}

fn change(value: f64, reference: f64) -> String {
    if reference > 0.0 {
        format!("{:+.1} %", 100.0 * (value / reference - 1.0))
    } else {
        "no particles".to_owned()
    }
}

/// The files written, one line per kind.
pub fn files(root: &Path, files: &[WrittenFile], films: &[WrittenFile]) -> String {
    let mut kinds: BTreeMap<String, (usize, u64)> = BTreeMap::new();
    for file in files {
        let below = file.path.strip_prefix(root).unwrap_or(&file.path);
        let name = below.to_string_lossy();
        // particles/particles_0012.ply -> particles/particles_*.ply
        let kind = match (name.rfind('_'), name.rfind('.')) {
            (Some(from), Some(to)) if from < to => format!("{}_*{}", &name[..from], &name[to..]),
            _ => name.into_owned(),
        };
        let entry = kinds.entry(kind).or_default();
        entry.0 += 1;
        entry.1 += file.bytes;
    }
    let mut rows: Vec<[String; 3]> = kinds
        .into_iter()
        .map(|(kind, (count, bytes))| [kind, human::counted(count as u64, "file"), human::bytes(bytes)])
        .collect();
    for WrittenFile { path, bytes } in films {
        let name = path.strip_prefix(root).unwrap_or(path).display().to_string();
        rows.push([name, human::counted(1, "film"), human::bytes(*bytes)]);
    }
    let [first, second] =
        [0, 1].map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
    let lines: Vec<String> = rows
        .iter()
        .map(|[name, count, bytes]| format!("  {name:first$}  {count:>second$}  {bytes}"))
        .collect();
    if lines.is_empty() {
        return format!("No frames were written; the summary is in {}.", root.join("run.json").display());
    }
    format!("Written to {}:\n{}", root.display(), lines.join("\n"))
}

/// Time per pass of the simulation, the slowest first.
pub fn passes(timings: &Timings, steps: u64) -> String {
    table(timings, steps, ("pass", "dispatches", "step"))
}

/// Time per pass of the pictures, the slowest first.
pub fn picture_passes(timings: &PictureTimings) -> String {
    table(&timings.passes, timings.pictures, ("pass of pictures", "passes", "picture"))
}

/// Numbers per step or per picture.
fn table(timings: &Timings, times: u64, (pass, runs, whole): (&str, &str, &str)) -> String {
    let mut passes: Vec<_> = timings.passes.iter().collect();
    passes.sort_by_key(|(_, time)| std::cmp::Reverse(time.total));
    let total = timings.total().as_secs_f64();
    let per_whole = |seconds: f64| 1000.0 * seconds / times.max(1) as f64;
    let mut text =
        format!("| {pass} | {runs} per {whole} | ms per {whole} | share |\n|---|---:|---:|---:|\n");
    for (label, time) in passes {
        let seconds = time.total.as_secs_f64();
        text += &format!(
            "| {label} | {:.2} | {:.3} | {:.1} % |\n",
            time.count as f64 / times.max(1) as f64,
            per_whole(seconds),
            if total > 0.0 { 100.0 * seconds / total } else { 0.0 }
        );
    }
    text + &format!("| all | | {:.3} | |", per_whole(total))
}

#[cfg(test)]
mod tests {
    use super::files;
    use splashdown_io::WrittenFile;
    use std::path::Path;

    #[test]
    fn files_of_one_kind_share_a_line() {
        let file = |name: &str| WrittenFile { path: Path::new("out_1").join(name), bytes: 1000 };
        let written =
            [file("mesh/surface_0000.ply"), file("mesh/surface_0001.ply"), file("mesh/surface_0000.obj")];
        let text = files(Path::new("out_1"), &written, &[]);
        assert!(text.contains("mesh/surface_*.ply") && text.contains("2 files  2.00 kB"), "{text}");
        // The columns are also aligned after a long name.
        let long = [file("checkpoints/checkpoint_0010.splashdown"), file("mesh/surface_0000.ply")];
        let text = files(Path::new("out_1"), &long, &[]);
        let ends: Vec<_> = text.lines().skip(1).filter_map(|line| line.find("1 file")).collect();
        assert!(ends.len() == 2 && ends[0] == ends[1], "{text}");
        assert_eq!(text.lines().count(), 3);
        assert!(files(Path::new("out_1"), &[], &[]).contains("No frames"));
    }
}
