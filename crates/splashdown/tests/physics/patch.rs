//! A square patch of fluid without gravity that rotates as a rigid body at the start (Colagrossi 2005; Le Touze et al.
//! 2013). Its pressure is negative inside, its corners are drawn out into arms, and energy, angular momentum, volume and
//! centre of mass remain.
//!
//! A slab six spacings thick between walls represents two dimensions. Negative pressures are kept. `dfsph` has none, so that
//! its patch breaks up by design.

use glam::DVec3;
use splashdown::{Simulation, sample};

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
pub const CASES: &[&Case] = &[&CASE];

/// The losses of energy and angular momentum, the mean density over that at rest minus one, the drift of the centre over
/// the edge, and the smallest distance of two particles in spacings, at omega t = 1.
struct End {
    energy: f64,
    angular: f64,
    density: f64,
    drift: f64,
    nearest: f64,
}

fn rotate(across: u32, solver: &str) -> End {
    let spacing = EDGE / f64::from(across);
    let thick = 6.0 * spacing;
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
    let mut simulation = Simulation::with_particles(&scene, executor(), &start).unwrap();
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
