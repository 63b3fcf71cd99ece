//! The vortex of Taylor and Green (1937) at a Reynolds number of 100. Walls are planes of symmetry, so that one cell of the
//! pattern fits into a closed box: u = U sin(k x) cos(k y), v = -U cos(k x) sin(k y) with k = pi / L. The kinetic energy
//! decays as exp(-4 nu k^2 t).
//!
//! A slab six spacings thick represents two dimensions. Negative pressures are kept.

use std::f64::consts::PI;

use glam::DVec3;
use splashdown::{Simulation, sample};

use super::cases::{Case, Variant};
use super::figures::Series;
use super::{disorder, executor, scene, square_sum, vec, velocity_sum};

/// The largest speed in m/s, the edge of the cell in m, and the viscosity in m^2/s: Re = U 2 L / nu.
const SPEED: f64 = 1.0;
const EDGE: f64 = 1.0;
const VISCOSITY: f64 = SPEED * 2.0 * EDGE / 100.0;

static CASE: Case = Case {
    name: "Taylor-Green vortex",
    across: "cell",
    sizes: &[20, 40, 80],
    variants: &[
        Variant::new(
            "continuity",
            "density = \"continuity\"\nsound_speed = 10\nnegative_pressure = \"keep\"",
        ),
        Variant::new(
            "engineering",
            "accuracy = \"engineering\"\nsound_speed = 10\nnegative_pressure = \"keep\"",
        ),
        Variant::extra(
            "summation",
            "density = \"summation\"\nsound_speed = 10\nnegative_pressure = \"keep\"",
        ),
        Variant::extra("dfsph", "method = \"dfsph\""),
    ],
};
const FIGURES: [&str; 5] = [
    "decay rate of the energy over 4 nu k^2, minus one",
    "the same for 1.2 nu, difference",
    "momentum over M U",
    "disorder: spread of the kernel's sum",
    "disorder: smallest distance, spacings",
];
pub const CASES: &[&Case] = &[&CASE];

fn vortex(across: u32, solver: &str) -> Simulation {
    let spacing = EDGE / f64::from(across);
    let thick = 6.0 * spacing;
    let scene = scene(&format!(
        "[scene]\nname = \"vortex\"\nduration = 10\ngravity = [0, 0, 0]\n[domain]\nmin = [0, 0, 0]\n\
         max = [{EDGE}, {EDGE}, {thick}]\n[fluid]\nparticle_spacing = {spacing}\nviscosity = {VISCOSITY}\n\
         [[fluid.block]]\nposition = [0, 0, 0]\nsize = [{EDGE}, {EDGE}, {thick}]\n[solver]\n{solver}\n"
    ));
    let mut particles = sample::particles(&scene).unwrap();
    let k = PI / EDGE;
    let velocity = |x: DVec3| {
        let (x, y) = (k * x.x, k * x.y);
        [(SPEED * x.sin() * y.cos()) as f32, (-SPEED * x.cos() * y.sin()) as f32, 0.0]
    };
    particles.velocities = particles.positions.iter().map(|&x| velocity(vec(x))).collect();
    Simulation::with_particles(&scene, executor(), &particles).unwrap()
}

#[test]
fn a_taylor_green_vortex_decays_by_viscosity() {
    CASE.run(|variant, across, figures| {
        let mut simulation = vortex(across, variant.keys);
        let start = simulation.particles().unwrap();
        let exact = 4.0 * VISCOSITY * (PI / EDGE).powi(2);
        let mut energies: Series = vec![(0.0, 1.0)];
        for _ in 0..40 {
            let Ok(stats) = simulation.advance(0.05) else {
                figures.measure("runs that end with an error", 1.0);
                for name in FIGURES {
                    figures.omit(name);
                }
                return;
            };
            assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
            energies.push((stats.time, square_sum(&simulation.particles().unwrap()) / square_sum(&start)));
        }
        let end = simulation.particles().unwrap();
        assert_eq!(end.positions.len(), start.positions.len(), "particles were lost");
        let (time, left) = energies[energies.len() - 1];
        let rate = -left.ln() / time;
        figures.measure("runs that end with an error", 0.0);
        figures.error(FIGURES[0], rate / exact - 1.0);
        figures.measure(FIGURES[1], (rate / (1.2 * exact) - 1.0).abs());
        let momentum = velocity_sum(&end).length() / end.positions.len() as f64 / SPEED;
        figures.measure(FIGURES[2], momentum);
        let spacing = EDGE / f64::from(across);
        let max = DVec3::new(EDGE, EDGE, 6.0 * spacing);
        let found = disorder::measure(&end.positions, spacing, DVec3::ZERO, max);
        figures.measure(FIGURES[3], found.spread);
        figures.measure(FIGURES[4], found.nearest);
        let theory = energies.iter().map(|&(t, _)| (t, (-exact * t).exp())).collect();
        figures.plot("Kinetic energy (dots: exact)", ["time, s", "energy over initial"], &theory, &energies);
    });
}
