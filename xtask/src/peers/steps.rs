//! Compares the time of a step: `wcsph` against SPlisHSPlasH's WCSPH and DFSPH.

use std::fs;
use std::path::Path;

use anyhow::Result;

use super::numbers::{median, number};
use super::table::{Table, at_least};
use super::{Sides, answer};
use crate::process::{command, root, say};
use crate::report::Page;

/// Required speed of a step relative to the peer's WCSPH.
const BAR: f64 = 10.0;

/// Steps of the peer per round, after its warm-up.
const STEPS: u32 = 40;

/// The peer's dam break: a block of 2 m in a box of 8 m by 6 m by 3 m at a spacing of 0.05 m, with the lengths of block
/// and box divided by `divisor`.
fn scene(divisor: f64) -> String {
    let [width, height, depth, side] = [8.0, 6.0, 3.0, 2.0].map(|length| length / divisor);
    let z = (depth - side) / 2.0;
    format!(
        "[scene]\nname = \"peer\"\nduration = 1.0\n\
         [domain]\nmin = [0, 0, 0]\nmax = [{width}, {height}, {depth}]\n\
         [fluid]\nparticle_spacing = 0.05\n\
         [[fluid.block]]\nposition = [0, 0, {z}]\nsize = [{side}, {side}, {side}]\n\
         [solver]\nmethod = \"wcsph\"\n"
    )
}

/// The measurements of one program.
#[derive(Default)]
struct Side {
    seconds: Vec<f64>,
    particles: f64,
    neighbours: f64,
    support_ratio: f64,
    memory: f64,
}

impl Side {
    fn note(&mut self, json: &str) -> Result<()> {
        self.seconds.push(number(json, "seconds_per_step")?);
        self.particles = number(json, "particles")?;
        self.neighbours = number(json, "neighbours")?;
        self.support_ratio = number(json, "support_radius")? / number(json, "spacing")?;
        self.memory = number(json, "peak_memory")?;
        Ok(())
    }

    fn row(&self, name: &str, ratio: String) -> Vec<String> {
        let seconds = median(&self.seconds);
        vec![
            name.to_owned(),
            format!("{}", self.particles),
            format!("{:.2}", self.support_ratio),
            format!("{:.1}", self.neighbours),
            format!("{:.2}", 1e3 * seconds),
            format!("{:.2}", 1e-6 * self.particles / seconds),
            format!("{:.0}", 1e-6 * self.memory),
            ratio,
        ]
    }
}

/// Adds the section of the page.
pub fn compare(sides: &Sides, page: &mut Page) -> Result<()> {
    // Half the edge length gives an eighth of the particles.
    let divisor = if sides.quick { 2 } else { 1 };
    let path = sides.folder.join("dam-break.toml");
    fs::write(&path, scene(f64::from(divisor)))?;
    let [mut ours, mut wcsph, mut dfsph] = [(); 3].map(|()| Side::default());
    for round in 1..=sides.rounds {
        say(format!("Steps, round {round} of {} ...", sides.rounds));
        ours.note(&step(sides, &path)?)?;
        wcsph.note(&their_step(sides, "wcsph", divisor)?)?;
        ours.note(&step(sides, &path)?)?;
        dfsph.note(&their_step(sides, "dfsph", divisor)?)?;
    }
    // Per particle, in case the numbers of particles differ.
    let each = |side: &Side| median(&side.seconds) / side.particles;
    let mut table = Table::new(&[
        "step",
        "particles",
        "support, spacings",
        "neighbours",
        "ms per step",
        "M particle-steps/s",
        "peak memory, MB",
        "time per particle, over ours",
    ]);
    table.row(&ours.row("`wcsph`", "1".to_owned()));
    table.row(&wcsph.row("SPlisHSPlasH, WCSPH", at_least(each(&wcsph) / each(&ours), BAR)));
    table.row(&dfsph.row("SPlisHSPlasH, DFSPH", format!("{:.2}", each(&dfsph) / each(&ours))));
    page.add("## Time of a step");
    page.add_anchored("step", table.text());
    page.add(
        "Scene: SPlisHSPlasH's `DamBreakModel.json` with twice the edge lengths, and a block that is one spacing longer, so that it has 40 \
         particles along every edge. WCSPH uses a stiffness of 50,000, an exponent of 7 and time steps of 0.1 ms.\n\n\
         *Equal*: spacing, support radius, size of block and box, threads, single precision.\n\n\
         *Different*: the kernel (Wendland C2 in Splashdown, cubic spline in SPlisHSPlasH), the walls (images, volume maps; neither has \
         boundary particles, so both visit fluid neighbours only), the viscosity, and the length of the time steps. Splashdown's follow the \
         speed of sound. A DFSPH step is at least ten times longer and contains several iterations, so its row is for information.\n\n\
         Peak memory is that of the whole process, including Python. On a busy machine the threads of SPlisHSPlasH wait for each other \
         actively and lose more time than Splashdown's; measure on a quiet machine.",
    );
    Ok(())
}

fn step(sides: &Sides, scene: &Path) -> Result<String> {
    let mut bench = command(&sides.ours);
    bench.args(["bench", "--device", "cpu", "--no-passes", "--json", "--scene"]).arg(scene);
    answer(bench.args(["--threads", &sides.threads.to_string()]))
}

fn their_step(sides: &Sides, method: &str, divisor: u32) -> Result<String> {
    let mut script = command(&sides.python);
    script.arg(root().join("xtask/peers/splishsplash.py")).env("OMP_NUM_THREADS", sides.threads.to_string());
    let steps = if sides.quick { 10 } else { STEPS };
    answer(script.args([method, &divisor.to_string(), &steps.to_string()]).arg(&sides.folder))
}

#[cfg(test)]
mod tests {
    use super::{Side, scene};

    #[test]
    fn the_divisor_scales_block_and_box() {
        let text = scene(2.0);
        assert!(text.contains("max = [4, 3, 1.5]"), "{text}");
        assert!(text.contains("position = [0, 0, 0.25]\nsize = [1, 1, 1]"), "{text}");
    }

    #[test]
    fn results_of_both_programs_are_read() {
        let mut side = Side::default();
        for seconds in [3.0, 1.0, 2.0] {
            let json = format!(
                "{{\"particles\":64000,\"seconds_per_step\":{seconds},\"spacing\":0.05,\"support_radius\":0.1,\
                 \"neighbours\":[28.5],\"peak_memory\":48000000}}"
            );
            side.note(&json).unwrap();
        }
        let row = side.row("x", "1".into());
        assert_eq!(row, ["x", "64000", "2.00", "28.5", "2000.00", "0.03", "48", "1"]);
        assert!(side.note("{}").is_err());
    }
}
