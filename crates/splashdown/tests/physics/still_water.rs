//! Still water around a fixed cube: rms speed within 1 % of sqrt(g depth) after a second, pressures within 3 % of rho g
//! depth at the middle of the faces and near an edge.
//!
//! `continuity` runs without artificial viscosity. The other cases with bodies use `artificial_viscosity = 0.1`, which
//! hides false motion next to bodies. Only the lift has a gate: the speed is 1.0 % at eight spacings, and at twelve pressures at the
//! top and bottom are up to 27 % too high.
//! `dfsph` runs with its defaults for two seconds, with a gate for the speed.

use glam::Vec3;
use splashdown::scene::{MeshShape, Motion};

use super::cases::{Case, Variant};
use super::shapes::body;
use super::{executor, rms_speed, scene};

const GRAVITY: f64 = 9.81;
/// The water depth and the edge of the cube in m.
const DEPTH: f64 = 0.4;
const EDGE: f64 = 0.16;
/// The height of the centre of the cube in m.
const CENTRE: f64 = 0.18;

/// Without the force of `dfsph` that continues the pressure along the surface into the body, the first layer slid down
/// vertical faces at a sixth of gravity, and the water never came to rest.
static CASE: Case = Case {
    name: "still water around a cube",
    across: "edge",
    sizes: &[8, 12, 16],
    variants: &[
        Variant::new("continuity", "density = \"continuity\""),
        Variant::new("dfsph", "method = \"dfsph\""),
        Variant::extra("engineering", "accuracy = \"engineering\""),
    ],
};
pub const CASES: &[&Case] = &[&CASE];

/// The rms speed over sqrt(g depth), the lift over the weight of the displaced water, and the pressures of the gauges over
/// rho g depth, after `seconds`. The lift and the pressures are means over the second half.
fn simulate(solver: &str, across: u32, seconds: f32) -> (f64, f64, Vec<(&'static str, f64)>) {
    let spacing = EDGE / f64::from(across);
    let side = 0.5 * (EDGE + spacing);
    let gauges = [
        ("side", [side, 0.0, 0.0]),
        ("side-near-edge", [side, 0.07, 0.0]),
        ("top", [0.0, side, 0.0]),
        ("bottom", [0.0, -side, 0.0]),
    ];
    let probes: String = gauges
        .iter()
        .map(|(name, [x, y, z])| {
            let position = [0.2 + x, CENTRE + y, 0.2 + z];
            format!("[[probe]]\nname = \"{name}\"\nquantity = \"pressure\"\nposition = {position:?}\ninterval = 0.005\n")
        })
        .collect();
    let mut scene = scene(&format!(
        "[scene]\nname = \"still\"\nduration = {seconds}\n[domain]\nmin = [0, 0, 0]\nmax = [0.4, 0.6, 0.4]\nopen = [\"y_max\"]\n\
         [fluid]\nparticle_spacing = {spacing}\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.4, {DEPTH}, 0.4]\n\
         {probes}[solver]\n{solver}\n"
    ));
    let centre = Vec3::new(0.2, CENTRE as f32, 0.2);
    scene.bodies.push(body("cube", MeshShape::Model("cube".into()), EDGE as f32, centre, Motion::Static));
    let mut simulation = splashdown::Simulation::with_executor(&scene, executor()).unwrap();
    let (mut lift, frames) = (0.0, 20);
    let mut rows: Vec<Vec<f64>> = vec![Vec::new(); gauges.len()];
    for frame in 0..frames {
        let stats = simulation.advance(seconds / frames as f32).unwrap();
        assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
        let more = simulation.take_probe_rows();
        if frame >= frames / 2 {
            lift += 2.0 / f64::from(frames) * f64::from(simulation.body_states().unwrap()[0].force.y);
            rows.iter_mut().zip(more).for_each(|(rows, more)| rows.extend(more.iter().map(|row| row[1])));
        }
    }
    let speed = rms_speed(&simulation.particles().unwrap()) / (GRAVITY * DEPTH).sqrt();
    let weight = f64::from(scene.fluid.material.rest_density) * GRAVITY;
    let pressures = gauges.iter().zip(&rows).map(|((name, [_, y, _]), rows)| {
        let depth = DEPTH - CENTRE - y;
        (*name, rows.iter().sum::<f64>() / rows.len() as f64 / (weight * depth))
    });
    (speed, lift / (weight * EDGE.powi(3)), pressures.collect())
}

#[test]
fn water_around_a_cube_stays_still() {
    CASE.run(|variant, across, figures| {
        let seconds = if variant.name == "dfsph" { 2.0 } else { 1.0 };
        let (speed, lift, pressures) = simulate(variant.keys, across, seconds);
        figures.error("rms speed over sqrt(g depth)", speed);
        figures.measure("lift over the weight of the displaced water", lift);
        for (name, pressure) in pressures {
            figures.measure(format!("pressure over rho g depth, {name}"), pressure);
        }
    });
}
