//! Compares simulated seconds per second of wall time: `dfsph` and `wcsph` against SPlisHSPlasH's DFSPH.

use std::fs;

use anyhow::Result;

use super::cases::{CASES, Case};
use super::numbers::{median, number};
use super::table::{Table, at_least};
use super::{Sides, answer};
use crate::process::{command, root, say};
use crate::report::Page;

/// A solver of Splashdown.
struct Solver {
    name: &'static str,
    /// Keys of `[solver]`.
    keys: &'static str,
    /// Required speed relative to the peer in the first case, a goal that was set before it was measured.
    bar: Option<f64>,
    /// Whether it is explicit: a viscous liquid would take hours.
    is_explicit: bool,
}

/// The goals for `dfsph` are those at a mean compression of 0.1 % and of 0.25 %.
const SOLVERS: [Solver; 4] = [
    Solver { name: "`dfsph`, tolerance 0.1 %", keys: "method = \"dfsph\"", bar: None, is_explicit: false },
    Solver {
        name: "`dfsph`, tolerance 0.35 %",
        keys: "method = \"dfsph\"\ntolerance = 0.0035",
        bar: Some(7.0),
        is_explicit: false,
    },
    Solver {
        name: "`dfsph`, tolerance 1 %",
        keys: "method = \"dfsph\"\ntolerance = 0.01",
        bar: Some(10.0),
        is_explicit: false,
    },
    Solver { name: "`wcsph`", keys: "method = \"wcsph\"", bar: Some(4.0), is_explicit: true },
];

/// The measurements of one program in one case.
#[derive(Default)]
struct Side {
    speeds: Vec<f64>,
    particles: f64,
    steps: f64,
    compression: Option<f64>,
    energy: f64,
    front: f64,
}

impl Side {
    /// Reads the numbers of a run, and those of its first and last particles.
    fn note(&mut self, run: &str, state: &str) -> Result<()> {
        self.speeds.push(number(run, "simulated_per_wall")?);
        self.steps = number(run, "steps")?;
        self.compression = number(run, "compression").or_else(|_| number(state, "compression")).ok();
        self.particles = number(state, "particles")?;
        self.energy = number(state, "energy")?;
        self.front = number(state, "front")?;
        Ok(())
    }

    fn row(&self, name: &str, ratio: String) -> Vec<String> {
        vec![
            name.to_owned(),
            format!("{}", self.particles),
            format!("{}", self.steps),
            format!("{:.4}", median(&self.speeds)),
            self.compression.map_or_else(String::new, |part| format!("{:.3}", 100.0 * part)),
            format!("{:.3}", self.energy),
            format!("{:.3}", self.front),
            ratio,
        ]
    }
}

/// Adds the section of the page.
pub fn compare(sides: &Sides, page: &mut Page) -> Result<()> {
    page.add("## Simulated time");
    page.add(
        "Simulated seconds per second of wall time. SPlisHSPlasH has the solver, viscosity and tolerances of its \
         `DamBreakModel.json`, and the viscosity of Weiler et al. (2018) for honey. Its box is larger by one spacing on every side: \
         a block that touches the walls bursts there (15 times its energy after 0.3 s), and its own scenes keep such a gap. The compression is the mean of max(0, \
         rho/rho0 - 1) over particles and steps (`wcsph`: frames), from the positions of the particles. The energy is kinetic plus \
         potential at the end, over that at the start. The front is the 98th percentile of x at the end, in m.",
    );
    for (k, case) in CASES.into_iter().enumerate() {
        let case = if sides.quick { case.quick() } else { case };
        let table = compare_case(sides, &case, k == 0)?;
        page.add(&format!(
            "### {}\n\n{}, at a spacing of {} m, for {} s.",
            capital(case.name),
            capital(case.text),
            case.spacing,
            case.seconds
        ));
        page.add_anchored(&format!("simulated-{}", case.name.replace(' ', "-")), table.text());
    }
    Ok(())
}

fn compare_case(sides: &Sides, case: &Case, has_goals: bool) -> Result<Table> {
    let solvers = || SOLVERS.iter().filter(|solver| case.viscosity.is_none() || !solver.is_explicit);
    let mut ours: Vec<Side> = solvers().map(|_| Side::default()).collect();
    let mut theirs = Side::default();
    for round in 1..=sides.rounds {
        say(format!("Simulated time, {}, round {round} of {} ...", case.name, sides.rounds));
        for (side, solver) in ours.iter_mut().zip(solvers()) {
            simulate(sides, case, solver, side)?;
        }
        let mut script = command(&sides.python);
        script.arg(root().join("xtask/peers/simulate.py")).env("OMP_NUM_THREADS", sides.threads.to_string());
        let run = answer(script.arg(case.description().to_string()).arg(&sides.folder))?;
        theirs.note(&run, &run)?;
    }
    let base = median(&theirs.speeds);
    let mut table = Table::new(&[
        "solver",
        "particles",
        "steps",
        "simulated s per s",
        "mean compression, %",
        "energy at the end",
        "front, m",
        "speed over SPlisHSPlasH",
    ]);
    for (side, solver) in ours.iter().zip(solvers()) {
        let ratio = median(&side.speeds) / base;
        let verdict = match solver.bar {
            Some(bar) if has_goals => at_least(ratio, bar),
            _ => format!("{ratio:.2}"),
        };
        table.row(&side.row(solver.name, verdict));
    }
    table.row(&theirs.row("SPlisHSPlasH, DFSPH", "1".to_owned()));
    Ok(table)
}

/// Runs a case with Splashdown.
fn simulate(sides: &Sides, case: &Case, solver: &Solver, side: &mut Side) -> Result<()> {
    let (path, out) = (sides.folder.join("simulated.toml"), sides.folder.join("simulated"));
    fs::write(&path, case.scene(solver.keys))?;
    let mut run = command(&sides.ours);
    run.arg("run").arg(&path).args([
        "--json",
        "--device",
        "cpu",
        "--formats",
        "npz",
        "--no-pictures",
        "--out",
    ]);
    let run = answer(run.arg(&out).env("RAYON_NUM_THREADS", sides.threads.to_string()))?;
    let mut script = command(&sides.python);
    let state = answer(script.arg(root().join("xtask/peers/state.py")).arg(out.join("particles")))?;
    side.note(&run, &state)
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::Side;

    #[test]
    fn results_are_read() {
        let state = "{\"particles\": 9, \"energy\": 0.5, \"front\": 2.0, \"compression\": 0.002}";
        let mut side = Side::default();
        side.note("{\"steps\": 7, \"simulated_per_wall\": 0.5, \"compression\": 0.001}", state).unwrap();
        assert_eq!(
            side.row("ours", "2".into()),
            ["ours", "9", "7", "0.5000", "0.100", "0.500", "2.000", "2"]
        );
        side.note("{\"steps\": 7, \"simulated_per_wall\": 0.5}", state).unwrap();
        assert_eq!(side.compression, Some(0.002));
        assert!(side.note("{\"steps\": 7, \"simulated_per_wall\": 0.5}", "{}").is_err());
    }
}
