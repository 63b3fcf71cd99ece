//! Drag of a circular cylinder that is towed through water without gravity, at a Reynolds number of 50. The coefficient of
//! an unbounded steady flow is 1.40: S. Dennis and G.-Z. Chang, "Numerical solutions for steady flow past a circular cylinder
//! at Reynolds numbers up to 100", J. Fluid Mech. 42 (1970) 471-489, have 1.522 at 40 and 1.212 at 70, and the measurements
//! of Tritton, J. Fluid Mech. 6 (1959) 547-567, agree.
//!
//! The tank is closed and twelve diameters wide, without friction at its sides. A. Roshko, J. Fluid Mech. 10 (1961) 345-356,
//! gives the correction for a blockage D / W: 1 - C / 2 (D / W) - 2.5 (D / W)^2. A slab four spacings thick represents two
//! dimensions. The drag is the mean from 8 to 12 diameters of motion.

use splashdown::Simulation;
use splashdown_io::Mesh;

use super::cases::{Case, Variant, is_validation};
use super::figures::Series;
use super::shapes::file;
use super::{cpu, scene};

const REYNOLDS: f64 = 50.0;
/// The coefficients at this number, and at 20 as a control.
const DRAG: f64 = 1.40;
const DRAG_20: f64 = 2.045;
/// Length and width of the tank, first and last place of the cylinder, in diameters of 1 m; the speed is 1 m/s.
const TANK: [f64; 2] = [20.0, 12.0];
const FIRST: f64 = 4.0;
const MOTION: f64 = 12.0;
const MEAN: f64 = 4.0;

static CASE: Case = Case {
    name: "drag of a cylinder",
    across: "diameter",
    sizes: &[8, 12, 16],
    variants: &[Variant::extra("engineering", "accuracy = \"engineering\"\nsound_speed = 10")],
};
pub const CASES: &[&Case] = &[&CASE];

/// A cylinder along z with a diameter of 1 m about the origin.
fn cylinder(thick: f64) -> Mesh {
    let sides = 64;
    let mut points = vec![[0.0, 0.0, -0.5], [0.0, 0.0, thick as f32 + 0.5]];
    for k in 0..sides {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(sides);
        let [x, y] = [0.5 * angle.cos() as f32, 0.5 * angle.sin() as f32];
        points.extend([[x, y, -0.5], [x, y, thick as f32 + 0.5]]);
    }
    let triangles = (0..sides).flat_map(|k| {
        let (low, high) = (2 + 2 * k, 3 + 2 * k);
        let next = 2 + 2 * ((k + 1) % sides);
        [[0, next, low], [1, high, next + 1], [low, next, next + 1], [low, next + 1, high]]
    });
    Mesh::new(points, triangles.collect())
}

#[test]
fn a_towed_cylinder_has_the_drag_of_measurements() {
    if !is_validation() {
        eprintln!("SKIPPED: a cylinder needs a long tank; run `cargo xtask validate`");
        return;
    }
    CASE.run(|variant, across, figures| {
        let spacing = 1.0 / f64::from(across);
        let thick = 4.0 * spacing;
        let [length, width] = TANK;
        let folder = tempfile::tempdir().unwrap();
        let mut scene = scene(&format!(
            "[scene]\nname = \"drag\"\nduration = 20\ngravity = [0, 0, 0]\n[domain]\nmin = [0, -{0}, 0]\n\
             max = [{length}, {0}, {thick}]\n[fluid]\nparticle_spacing = {spacing}\nviscosity = {1}\n\
             [[fluid.block]]\nposition = [0, -{0}, 0]\nsize = [{length}, {width}, {thick}]\n\
             [[body]]\nname = \"cylinder\"\nmesh = \"cube\"\nposition = [{FIRST}, 0, 0]\nfriction = 1\n\
             move = [\"t\", \"0\", \"0\"]\n\
             [[probe]]\nname = \"force\"\nquantity = \"force\"\nbody = \"cylinder\"\ninterval = 0.05\n[solver]\n{2}\n",
            0.5 * width,
            1.0 / REYNOLDS,
            variant.keys,
        ));
        scene.bodies[0].mesh.shape = file(folder.path(), "cylinder.obj", &cylinder(thick));
        let mut simulation = Simulation::with_executor(&scene, cpu()).unwrap();
        let mut drag = Series::new();
        for _ in 0..(10.0 * MOTION) as u32 {
            let stats = simulation.advance(0.1).unwrap();
            assert_eq!((stats.non_finite, stats.escaped), (0, 0), "{stats:?}");
            let rows = simulation.take_probe_rows();
            drag.extend(rows[0].iter().map(|row| (row[0], -row[1] / (500.0 * thick))));
        }
        let late: Vec<f64> = drag.iter().filter(|p| p.0 > MOTION - MEAN).map(|p| p.1).collect();
        let raw = late.iter().sum::<f64>() / late.len() as f64;
        let found = raw * (1.0 - 0.5 * raw / width - 2.5 / (width * width));
        figures.report("coefficient without the correction for blockage", raw);
        figures.error("drag coefficient over 1.40, minus one", found / DRAG - 1.0);
        figures.measure("the same against a Reynolds number of 20, difference", (found / DRAG_20 - 1.0).abs());
        drag.retain(|p| p.0 > 0.5);
        let line = vec![(0.5, DRAG), (MOTION, DRAG)];
        let axes = ["time, diameters over speed", "coefficient"];
        figures.plot("Drag of a cylinder (dots: unbounded, steady)", axes, &line, &drag);
    });
}
