//! Still water over a step that fills half of the tank's length and half of the depth: pressures on the floor and on the
//! step, its load, the force on its face, and false motion.
//!
//! The step is a body that is flush with the floor and three walls. Its lower inner edge and its upper outer edge are those of
//! the cases "hydrostatics in corners" and "along inner edges".

use glam::Vec3;
use splashdown::Simulation;

use super::cases::{Case, Variant};
use super::{executor, rms_speed, scene};

const GRAVITY: f64 = 9.81;
/// Depth of the water, and length of the tank in m.
const DEPTH: f64 = 0.4;
const LENGTH: f64 = 0.8;

static CASE: Case = Case {
    name: "step in still water",
    across: "depth",
    sizes: &[16, 24, 32],
    variants: &[
        Variant::new("continuity", "density = \"continuity\""),
        Variant::new("dfsph", "method = \"dfsph\""),
        Variant::extra("engineering", "accuracy = \"engineering\""),
        Variant::extra("summation", "density = \"summation\""),
    ],
};
pub const CASES: &[&Case] = &[&CASE];

#[test]
fn water_over_a_step_stays_still() {
    CASE.run(|variant, across, figures| {
        let spacing = DEPTH / f64::from(across);
        let thick = 8.0 * spacing;
        let half = 0.5 * spacing;
        let gauges = [
            ("floor", 0.25 * LENGTH, half),
            ("inner-edge", 0.5 * LENGTH - half, half),
            ("face", 0.5 * LENGTH - half, 0.25 * DEPTH),
            ("outer-edge", 0.5 * LENGTH + half, 0.5 * DEPTH + half),
            ("top", 0.75 * LENGTH, 0.5 * DEPTH + half),
        ];
        let probes: String = gauges
            .iter()
            .map(|(name, x, y)| {
                let z = 0.5 * thick;
                format!("[[probe]]\nname = \"{name}\"\nquantity = \"pressure\"\nposition = [{x}, {y}, {z}]\ninterval = 0.005\n")
            })
            .collect();
        let scene = scene(&format!(
            "[scene]\nname = \"step\"\nduration = 2\n[domain]\nmin = [0, 0, 0]\nmax = [{LENGTH}, {}, {thick}]\n\
             open = [\"y_max\"]\n[fluid]\nparticle_spacing = {spacing}\n[[fluid.block]]\nposition = [0, 0, 0]\n\
             size = [{LENGTH}, {DEPTH}, {thick}]\n[solver]\n{}\n{probes}[[body]]\nname = \"step\"\nmesh = \"cube\"\n\
             scale = [{}, {}, {thick}]\nposition = [{}, {}, {}]\n",
            1.3 * DEPTH,
            variant.keys,
            0.5 * LENGTH,
            0.5 * DEPTH,
            0.75 * LENGTH,
            0.25 * DEPTH,
            0.5 * thick,
        ));
        let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
        let frames = 40;
        let mut force = Vec3::ZERO;
        let mut sums = [(0.0, 0.0); 5];
        for frame in 0..frames {
            let stats = simulation.advance(2.0 / frames as f32).unwrap();
            assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
            let rows = simulation.take_probe_rows();
            if frame >= frames / 2 {
                force += simulation.body_states().unwrap()[0].force / (frames / 2) as f32;
                for (sum, rows) in sums.iter_mut().zip(&rows) {
                    sum.0 += rows.iter().map(|row| row[1]).sum::<f64>();
                    sum.1 += rows.len() as f64;
                }
            }
        }
        let weight = f64::from(scene.fluid.material.rest_density) * GRAVITY;
        for ((name, _, y), sum) in gauges.iter().zip(sums) {
            let error = (sum.0 / sum.1 - weight * (DEPTH - y)) / (weight * DEPTH);
            figures.error(format!("error of the pressure over rho g depth, {name}"), error);
        }
        let load = weight * 0.5 * DEPTH * 0.5 * LENGTH * thick;
        let thrust = weight * 0.75 * DEPTH * 0.5 * DEPTH * thick;
        figures.error("load on the step over theory, minus one", -f64::from(force.y) / load - 1.0);
        figures.error("force on its face over theory, minus one", f64::from(force.x) / thrust - 1.0);
        figures.measure("the same for 1.1 times the density, difference", {
            (f64::from(force.x) / (1.1 * thrust) - 1.0).abs()
        });
        let speed = rms_speed(&simulation.particles().unwrap());
        figures.error("rms speed over sqrt(g depth)", speed / (GRAVITY * DEPTH).sqrt());
    });
}
