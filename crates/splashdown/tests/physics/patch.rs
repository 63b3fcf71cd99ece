//! A square patch of fluid without gravity that rotates as a rigid body at the start (Colagrossi 2005; Le Touze et al.
//! 2013). Its pressure is negative inside, its corners are drawn out into arms, and energy, angular momentum, volume and
//! centre of mass remain.
//!
//! The initial pressure is a series. It is compared with the pressure of the particles, averaged over the first two periods of
//! their sound: a patch that starts without pressure oscillates about the series.
//!
//! A slab six spacings thick between walls represents two dimensions. Negative pressures are kept. `dfsph` has none, so that
//! its patch breaks up by design.

use std::f64::consts::PI;

use glam::DVec3;
use splashdown::{Simulation, sample};
use splashdown_io::Particles;

use super::cases::{CONTROL, Case, Variant};
use super::figures::Figures;
use super::{angular_sum, executor, scene, square_sum, vec};

/// The edge in m, and the initial angular velocity in 1/s.
const EDGE: f64 = 1.0;
const OMEGA: f64 = 1.0;

static CASE: Case = Case {
    name: "rotating square patch",
    across: "edge",
    sizes: &[20, 40, 80],
    variants: &[
        Variant::new("continuity", "density = \"continuity\"\nsound_speed = 7\nnegative_pressure = \"keep\""),
        Variant::extra(
            "engineering",
            "accuracy = \"engineering\"\nsound_speed = 7\nnegative_pressure = \"keep\"",
        ),
        Variant::extra("summation", "density = \"summation\"\nsound_speed = 7\nnegative_pressure = \"keep\""),
        Variant::extra("dfsph", "method = \"dfsph\""),
        CONTROL,
    ],
};
/// The speed of sound, 42 times the speed of the corners, leaves the patch where it is during the mean.
static PRESSURE: Case = Case {
    name: "square patch, initial pressure",
    across: "edge",
    sizes: &[20, 40, 80],
    variants: &[
        Variant::new(
            "continuity",
            "density = \"continuity\"\nsound_speed = 30\nnegative_pressure = \"keep\"",
        ),
        Variant::extra(
            "engineering",
            "accuracy = \"engineering\"\nsound_speed = 30\nnegative_pressure = \"keep\"",
        ),
        Variant::extra(
            "summation",
            "density = \"summation\"\nsound_speed = 30\nnegative_pressure = \"keep\"",
        ),
        CONTROL,
    ],
};
/// The speed of sound of that case in m/s.
const SOUND: f64 = 30.0;
pub const CASES: &[&Case] = &[&CASE, &PRESSURE];

/// The losses of energy and angular momentum, the mean density over that at rest minus one, the drift of the centre over
/// the edge, and the smallest distance of two particles in spacings, at omega t = 1.
struct End {
    energy: f64,
    angular: f64,
    density: f64,
    drift: f64,
    nearest: f64,
}

/// The spacing and the thickness of the slab in m.
fn slab(across: u32) -> (f64, f64) {
    let spacing = EDGE / f64::from(across);
    (spacing, 6.0 * spacing)
}

/// A patch at the start, and its particles.
fn patch(across: u32, solver: &str) -> (Simulation, Particles) {
    let (spacing, thick) = slab(across);
    let half = 0.5 * EDGE;
    let scene = scene(&format!(
        "[scene]\nname = \"patch\"\nduration = 10\ngravity = [0, 0, 0]\n[domain]\nmin = [-2, -2, 0]\n\
         max = [2, 2, {thick}]\nopen = [\"x_min\", \"x_max\", \"y_min\", \"y_max\"]\n[fluid]\n\
         particle_spacing = {spacing}\n[[fluid.block]]\nposition = [-{half}, -{half}, 0]\n\
         size = [{EDGE}, {EDGE}, {thick}]\n[solver]\n{solver}\n"
    ));
    let mut start = sample::particles(&scene).unwrap();
    start.velocities =
        start.positions.iter().map(|x| [OMEGA as f32 * x[1], -OMEGA as f32 * x[0], 0.0]).collect();
    (Simulation::with_particles(&scene, executor(), &start).unwrap(), start)
}

fn rotate(across: u32, solver: &str) -> End {
    let (mut simulation, start) = patch(across, solver);
    let (spacing, thick) = slab(across);
    let half = 0.5 * EDGE;
    let stats = simulation.advance((1.0 / OMEGA) as f32).unwrap();
    assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
    let end = simulation.particles().unwrap();
    let n = end.positions.len() as f64;
    assert_eq!(end.positions.len(), start.positions.len(), "particles were lost");
    let density = end.densities.iter().map(|&rho| f64::from(rho)).sum::<f64>() / n;
    let centre = end.positions.iter().map(|&x| vec(x)).sum::<DVec3>() / n;
    let box_min = DVec3::new(-half, -half, 0.0);
    let box_max = DVec3::new(half, half, thick);
    End {
        energy: 1.0 - square_sum(&end) / square_sum(&start),
        angular: 1.0 - angular_sum(&end).z / angular_sum(&start).z,
        density: density / 1000.0 - 1.0,
        drift: centre.truncate().length() / EDGE,
        nearest: super::disorder::measure(&end.positions, spacing, box_min, box_max).nearest,
    }
}

/// The pressure of a patch with this angular velocity at the start, in Pa; x and y are over the edge, from a corner.
fn series(omega: f64, x: f64, y: f64) -> f64 {
    let odd = || (1..60).step_by(2).map(f64::from);
    let term = |m: f64, n: f64| {
        32.0 / (m * n * PI.powi(4) * (m * m + n * n)) * (m * PI * x).sin() * (n * PI * y).sin()
    };
    let sum: f64 = odd().flat_map(|m| odd().map(move |n| (m, n))).map(|(m, n)| term(m, n)).sum();
    -1000.0 * (omega * EDGE).powi(2) * sum
}

/// The deviation of the mean pressures from the series for this angular velocity, as a share of the series; L2.
fn pressure_error(across: u32, solver: &str, omega: f64) -> f64 {
    let (mut simulation, start) = patch(across, solver);
    let samples = 80;
    // The lowest mode of a square that is free at its sides.
    let duration = 2.0 * 2.0_f64.sqrt() * EDGE / SOUND;
    let mut sums = vec![0.0; start.positions.len()];
    for _ in 0..samples {
        simulation.advance((duration / f64::from(samples)) as f32).unwrap();
        let now = simulation.particles().unwrap();
        assert_eq!(now.ids.len(), sums.len(), "particles were lost");
        for (&id, &pressure) in now.ids.iter().zip(&now.pressures) {
            sums[id as usize] += f64::from(pressure) / f64::from(samples);
        }
    }
    let (mut error, mut norm) = (0.0, 0.0);
    for (x, mean) in start.positions.iter().zip(sums) {
        let exact = series(omega, f64::from(x[0]) / EDGE + 0.5, f64::from(x[1]) / EDGE + 0.5);
        error += (mean - exact).powi(2);
        norm += exact.powi(2);
    }
    (error / norm).sqrt()
}

#[test]
fn the_initial_pressure_of_a_patch_is_that_of_the_series() {
    PRESSURE.run(|variant, across, figures| {
        figures.error("mean pressure, L2 relative", pressure_error(across, variant.keys, OMEGA));
    });
}

#[test]
fn the_pressure_of_a_faster_patch_is_detected() {
    let mut figures = Figures::new(&PRESSURE, "control", 20);
    let error = pressure_error(20, PRESSURE.variants[0].keys, 1.1 * OMEGA);
    figures.measure("mean pressure, L2 relative, for 1.1 times the angular velocity", error);
    figures.close();
}

#[test]
fn a_rotating_patch_conserves_energy_and_angular_momentum() {
    CASE.run(|variant, across, figures| {
        let end = rotate(across, variant.keys);
        figures.error("loss of kinetic energy", end.energy);
        figures.error("loss of angular momentum", end.angular);
        figures.error("mean density over rest density, minus one", end.density);
        figures.measure("drift of the centre over the edge", end.drift);
        figures.measure("disorder: smallest distance, spacings", end.nearest);
    });
}

#[test]
fn a_viscous_patch_is_detected() {
    let mut figures = Figures::new(&CASE, "control", 20);
    let solver =
        "density = \"continuity\"\nsound_speed = 7\nnegative_pressure = \"keep\"\nartificial_viscosity = 1.0";
    let end = rotate(20, solver);
    figures.measure("loss of kinetic energy, artificial viscosity 1", end.energy);
    figures.close();
}
