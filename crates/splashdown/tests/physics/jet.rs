//! A steady round jet on a plate, without gravity. The theorem of momentum gives the force, rho A U^2, if the plate turns
//! the jet by a right angle; Bernoulli gives the pressure rho U^2 / 2 at the stagnation point. While no particle leaves the
//! domain, the impulse on the plate equals the momentum of the emitted particles that the fluid has lost.

use std::f64::consts::PI;

use glam::Vec3;
use splashdown::Simulation;
use splashdown::scene::Motion;

use super::cases::{Case, Variant};
use super::figures::Series;
use super::meshes::cuboid;
use super::shapes::{body, file};
use super::{cpu, scene, velocity_sum};

/// Diameter of the jet in m, and its speed in m/s.
const DIAMETER: f64 = 0.1;
const SPEED: f64 = 1.0;

static CASE: Case = Case {
    name: "jet on a plate",
    across: "diameter",
    sizes: &[8, 12, 16],
    variants: &[
        Variant::new("continuity", "density = \"continuity\"\nsound_speed = 10"),
        Variant::extra("engineering", "accuracy = \"engineering\"\nsound_speed = 10"),
        Variant::new("summation", "density = \"summation\"\nsound_speed = 10"),
        Variant::extra("dfsph", "method = \"dfsph\""),
    ],
};
pub const CASES: &[&Case] = &[&CASE];

#[test]
fn a_jet_pushes_a_plate_by_its_momentum() {
    CASE.run(|variant, across, figures| {
        let spacing = DIAMETER / f64::from(across);
        let folder = tempfile::tempdir().unwrap();
        let mut scene = scene(&format!(
            "[scene]\nname = \"jet\"\nduration = 1\ngravity = [0, 0, 0]\n[domain]\nmin = [-0.9, -0.1, -0.9]\n\
             max = [0.9, 0.3, 0.9]\nopen = [\"x_min\", \"x_max\", \"y_min\", \"y_max\", \"z_min\", \"z_max\"]\n\
             [fluid]\nparticle_spacing = {spacing}\n[[emitter]]\nname = \"nozzle\"\nradius = {}\n\
             position = [0, 0.16, 0]\ndirection = [0, -1, 0]\nspeed = {SPEED}\n[solver]\n{}\n\
             [[probe]]\nname = \"plate\"\nquantity = \"force\"\nbody = \"plate\"\n\
             [[probe]]\nname = \"centre\"\nquantity = \"pressure\"\nposition = [0, {}, 0]\n",
            0.5 * DIAMETER,
            variant.keys,
            0.5 * spacing,
        ));
        let mesh = cuboid(Vec3::new(-0.8, -0.05, -0.8), Vec3::new(0.8, 0.0, 0.8));
        let shape = file(folder.path(), "plate.obj", &mesh);
        scene.bodies.push(body("plate", shape, 1.0, Vec3::ZERO, Motion::Static));
        let mut simulation = Simulation::with_executor(&scene, cpu()).unwrap();
        let mass = f64::from(simulation.params().particle_mass);
        let (mut forces, mut pressures) = (Series::new(), Series::new());
        let (mut impulse, mut last) = (0.0, 0.0);
        for _ in 0..35 {
            let stats = simulation.advance(0.02).unwrap();
            assert_eq!((stats.non_finite, stats.escaped), (0, 0), "{stats:?}");
            let rows = simulation.take_probe_rows();
            for row in &rows[0] {
                // Rows are means since the previous row. The force on the plate points downwards.
                impulse -= row[2] * (row[0] - last);
                last = row[0];
                forces.push((row[0], -row[2]));
            }
            pressures.extend(rows[1].iter().map(|row| (row[0], row[1])));
        }
        // The jet is steady three diameters over U after its impact.
        let late = |series: &Series| {
            let late: Vec<f64> = series.iter().filter(|p| p.0 > 0.45).map(|p| p.1).collect();
            late.iter().sum::<f64>() / late.len() as f64
        };
        let exact = 1000.0 * PI / 4.0 * DIAMETER.powi(2) * SPEED.powi(2);
        let ratio = late(&forces) / exact;
        figures.error("force over rho A U^2, minus one", ratio - 1.0);
        figures.measure("the same for 1.2 times the area, difference", (ratio / 1.2 - 1.0).abs());
        let particles = simulation.particles().unwrap();
        let emitted = particles.positions.len() as f64;
        let lost = mass * (emitted * SPEED + velocity_sum(&particles).y);
        figures.error("impulse over the momentum lost, minus one", impulse / lost - 1.0);
        let stagnation = late(&pressures) / (500.0 * SPEED.powi(2));
        figures.measure("pressure at the centre over rho U^2 / 2", stagnation);
        let line = vec![(0.0, exact), (0.7, exact)];
        figures.plot("Force on the plate (dots: rho A U^2)", ["time, s", "force, N"], &line, &forces);
    });
}
