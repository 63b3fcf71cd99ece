//! Compares simulated seconds per second of wall time: `dfsph` and `wcsph` against SPlisHSPlasH's DFSPH.

use std::fs;

use anyhow::Result;

use super::numbers::{median, number};
use super::table::{Table, at_least};
use super::{Sides, answer};
use crate::process::{command, root, say};
use crate::report::Page;

/// Required speed of `dfsph` relative to the peer, at a mean compression of 0.1 % and of 0.25 %.
const BARS: [f64; 2] = [7.0, 10.0];

/// Our solvers: name in the table, keys of `[solver]`, required speed.
const OURS: [(&str, &str, Option<f64>); 3] = [
    ("`dfsph`, tolerance 0.1 %", "method = \"dfsph\"", Some(BARS[0])),
    (
        "`dfsph`, tolerance 0.2 %, CFL factor 1",
        "method = \"dfsph\"\ntolerance = 0.002\ncfl_factor = 1.0",
        Some(BARS[1]),
    ),
    ("`wcsph`", "method = \"wcsph\"", None),
];

/// A block of 2 m that collapses in a box of 6.4 m x 4 m x 2 m.
fn scene(spacing: f64, seconds: f64, solver: &str) -> String {
    format!(
        "[scene]\nname = \"collapse\"\nduration = {seconds:?}\nframe_rate = 10\n\
         [domain]\nmin = [0, 0, 0]\nmax = [6.4, 4.0, 2.0]\n\
         [fluid]\nparticle_spacing = {spacing}\n\
         [[fluid.block]]\nposition = [0, 0, 0]\nsize = [2, 2, 2]\n\
         [surface]\nenabled = false\n[solver]\n{solver}\n"
    )
}

/// The measurements of one program.
#[derive(Default)]
struct Side {
    speeds: Vec<f64>,
    steps: f64,
    compression: Option<f64>,
}

impl Side {
    fn note(&mut self, json: &str) -> Result<()> {
        self.speeds.push(number(json, "simulated_per_wall")?);
        self.steps = number(json, "steps")?;
        self.compression = number(json, "compression").ok();
        Ok(())
    }

    fn row(&self, name: &str, ratio: String) -> Vec<String> {
        vec![
            name.to_owned(),
            format!("{}", self.steps),
            format!("{:.4}", median(&self.speeds)),
            self.compression.map_or_else(String::new, |part| format!("{:.3}", 100.0 * part)),
            ratio,
        ]
    }
}

/// Adds the section of the page.
pub fn compare(sides: &Sides, page: &mut Page) -> Result<()> {
    let (spacing, seconds) = if sides.quick { (0.1, 0.3) } else { (0.05, 1.5) };
    let mut ours = OURS.map(|_| Side::default());
    let mut theirs = Side::default();
    for round in 1..=sides.rounds {
        say(format!("Simulated seconds, round {round} of {} ...", sides.rounds));
        for (k, (side, (_, solver, _))) in ours.iter_mut().zip(OURS).enumerate() {
            let path = sides.folder.join(format!("collapse_{k}.toml"));
            fs::write(&path, scene(spacing, seconds, solver))?;
            let mut run = command(&sides.ours);
            run.arg("run").arg(&path).args(["--json", "--device", "cpu", "--formats", "none"]);
            run.args(["--no-pictures", "--out"]).arg(sides.folder.join(format!("collapse_{k}")));
            side.note(&answer(run.env("RAYON_NUM_THREADS", sides.threads.to_string()))?)?;
        }
        let mut script = command(&sides.python);
        script.arg(root().join("xtask/peers/collapse.py")).env("OMP_NUM_THREADS", sides.threads.to_string());
        let words = [spacing.to_string(), seconds.to_string()];
        theirs.note(&answer(script.args(words).arg(&sides.folder))?)?;
    }
    let base = median(&theirs.speeds);
    let mut table = Table::new(&[
        "solver",
        "steps",
        "simulated s per wall s",
        "mean compression, %",
        "speed over SPlisHSPlasH",
    ]);
    for (side, (name, _, bar)) in ours.iter().zip(OURS) {
        let ratio = median(&side.speeds) / base;
        let verdict = bar.map_or_else(|| format!("{ratio:.2}"), |bar| at_least(ratio, bar));
        table.row(&side.row(name, verdict));
    }
    table.row(&theirs.row("SPlisHSPlasH, DFSPH", "1".to_owned()));
    page.add("## Simulated time");
    page.add_anchored("simulated", table.text());
    page.add(&format!(
        "Scene: a block of 2 m x 2 m x 2 m collapses in a box of 6.4 m x 4 m x 2 m, at a spacing of {spacing} m, for {seconds} s. \
         SPlisHSPlasH has the solver, viscosity and tolerances of its `DamBreakModel.json`. The compression is the mean of \
         max(0, rho/rho0 - 1) over particles and steps, from the positions of the particles."
    ));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Side, scene};

    #[test]
    fn the_scene_has_the_solver_and_results_are_read() {
        assert!(scene(0.1, 0.3, "method = \"dfsph\"").ends_with("[solver]\nmethod = \"dfsph\"\n"));
        let mut side = Side::default();
        side.note("{\"steps\": 7, \"simulated_per_wall\": 0.5, \"compression\": 0.001}").unwrap();
        assert_eq!(side.row("ours", "2".into()), ["ours", "7", "0.5000", "0.100", "2"]);
        side.note("{\"steps\": 7, \"simulated_per_wall\": 0.5}").unwrap();
        assert_eq!(side.compression, None);
    }
}
