//! Conservation in an isolated blob of fluid: momentum, angular momentum, particles; and dissipation by viscosity.

use glam::DVec3;
use splashdown::scene::Scene;
use splashdown::{Simulation, sample};
use splashdown_gpu::{Executor, testing};
use splashdown_io::Particles;

use super::cases::{CONTROL, Case, Variant};
use super::figures::Figures;
use super::{angular_sum, executor, rms_speed, scene, square_sum, velocity_sum};

const STEPS: u64 = 1000;

/// Pair forces are equal and opposite except for rounding, which adds up over a thousand steps.
static MOMENTUM: Case = Case {
    name: "momentum",
    across: "diameter",
    sizes: &[10],
    variants: &[
        Variant::new("summation", SUMMATION),
        Variant::new("continuity", CONTINUITY),
        Variant::new("akinci2013", TENSION),
        // With a = f / rho_i and equal masses the pressure and viscosity of Mueller 2003 are antisymmetric too.
        Variant::new("mueller2003", MUELLER),
        Variant::new("dfsph", DFSPH),
        CONTROL,
    ],
};
/// Positions are rounded to 3e-8 m in every step, and each rounding changes the angular momentum. The continuity form
/// shifts particles, which moves them without changing their velocity.
static ANGULAR_MOMENTUM: Case = Case {
    name: "angular momentum",
    across: "diameter",
    sizes: &[10],
    variants: &[Variant::new("summation", SUMMATION), Variant::new("continuity", CONTINUITY), CONTROL],
};
static ENERGY: Case = Case {
    name: "energy",
    across: "diameter",
    sizes: &[10],
    variants: &[
        Variant::new("summation", SUMMATION),
        Variant::new("continuity", CONTINUITY),
        Variant::new("mueller2003", MUELLER),
    ],
};
pub const CASES: &[&Case] = &[&MOMENTUM, &ANGULAR_MOMENTUM, &ENERGY];

/// A ball of 500 particles in an open box without gravity.
fn blob(gravity: f32, fluid: &str, solver: &str) -> Scene {
    let sound = if solver == DFSPH { "" } else { "sound_speed = 10" };
    scene(&format!(
        r#"
        [scene]
        name = "blob"
        duration = 1.0
        gravity = [0, {gravity}, 0]
        [domain]
        min = [-0.5, -0.5, -0.5]
        max = [0.5, 0.5, 0.5]
        open = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"]
        [fluid]
        particle_spacing = 0.02
        {fluid}
        [[fluid.block]]
        shape = "sphere"
        center = [0, 0, 0]
        radius = 0.1
        [solver]
        {sound}
        {solver}
        "#
    ))
}

fn noise(i: usize) -> f32 {
    testing::noise(i as u32) as f32 / u32::MAX as f32 - 0.5
}

/// The ball with particles displaced by up to half a `displacement`, in spacings, each with a random velocity of up to 0.25 m/s per axis.
fn stirred(scene: &Scene, displacement: f32) -> Particles {
    let mut particles = sample::particles(scene).unwrap();
    for (i, x) in particles.positions.iter_mut().flatten().enumerate() {
        *x += displacement * 0.02 * noise(i);
    }
    for (i, v) in particles.velocities.iter_mut().flatten().enumerate() {
        *v = 0.5 * noise(10_000 + i);
    }
    particles
}

/// Runs a thousand steps; no particle may be lost, limited or corrected.
fn run(scene: &Scene, executor: Executor, start: &Particles) -> Particles {
    let mut simulation = Simulation::with_particles(scene, executor, start).unwrap();
    while simulation.stats().steps < STEPS {
        let stats = simulation.advance(0.02).unwrap();
        assert_eq!(stats.particles as usize, start.positions.len(), "{stats:?}");
        assert_eq!(
            (stats.escaped, stats.non_finite, stats.wall_corrections, stats.speed_limits),
            (0, 0, 0, 0)
        );
    }
    simulation.particles().unwrap()
}

/// The change of momentum over mass times the root mean square of the speeds.
fn momentum_drift(start: &Particles, end: &Particles) -> f64 {
    let change = velocity_sum(end) - velocity_sum(start);
    change.length() / start.positions.len() as f64 / rms_speed(start)
}

/// With longer steps, a thousand of them are so long a time that particles leave the domain.
const SUMMATION: &str = "method = \"wcsph\"\nartificial_viscosity = 0.1\ncfl_factor = 0.3";
const CONTINUITY: &str = "method = \"wcsph\"\ndensity = \"continuity\"\nartificial_viscosity = 0.1";
const TENSION: &str = "method = \"wcsph\"\nsurface_tension = \"akinci2013\"\ncfl_factor = 0.3";
const DFSPH: &str = "method = \"dfsph\"\nmax_dt = 0.001";
const MUELLER: &str = "method = \"mueller2003\"";
const MUELLER_TENSION: &str = "method = \"mueller2003\"\nsurface_tension = \"mueller2003\"";

#[test]
fn an_isolated_blob_conserves_momentum_and_particles() {
    let fluid = "viscosity = 0.001\nsurface_tension = 1.0";
    for &Variant { name: word, keys: solver, .. } in &MOMENTUM.variants[..5] {
        for (name, executor) in testing::executors("an_isolated_blob_conserves_momentum") {
            let mut figures = Figures::new(&MOMENTUM, word, 10).on(name);
            let scene = blob(0.0, fluid, solver);
            // The implicit pressure restores the density in one step, so that a displacement x causes a speed of x / dt:
            // 4 m/s for a fifth of a spacing.
            let start = stirred(&scene, if solver == DFSPH { 0.01 } else { 0.2 });
            let end = run(&scene, executor, &start);
            figures.measure("change over M v_rms in 1000 steps", momentum_drift(&start, &end));
            figures.close();
        }
    }
    // Controls: a millionth of the earth's gravity, and forces that are not pair forces.
    let mut figures = Figures::new(&MOMENTUM, "control", 10);
    let scene = blob(-1e-5, fluid, SUMMATION);
    let start = stirred(&scene, 0.2);
    let end = run(&scene, executor(), &start);
    figures.measure("gravity of 1e-5 m/s^2", momentum_drift(&start, &end));
    let scene = blob(0.0, fluid, MUELLER_TENSION);
    let end = run(&scene, executor(), &start);
    figures.measure("surface tension of the colour field", momentum_drift(&start, &end));
    figures.close();
}

#[test]
fn a_spinning_blob_conserves_angular_momentum() {
    let drift = |solver: &str, fluid: &str, executor: Executor| {
        let scene = blob(0.0, fluid, solver);
        let mut start = stirred(&scene, 0.2);
        let spin = DVec3::new(0.6, 2.0, -0.4);
        for (x, v) in start.positions.iter().zip(&mut start.velocities) {
            let turn = spin.cross(super::vec(*x)).as_vec3().to_array();
            *v = std::array::from_fn(|k| turn[k] + 0.2 * v[k]);
        }
        let end = run(&scene, executor, &start);
        (angular_sum(&end) - angular_sum(&start)).length() / angular_sum(&start).length()
    };
    for &Variant { name: word, keys: solver, .. } in &ANGULAR_MOMENTUM.variants[..2] {
        for (name, executor) in testing::executors("a_spinning_blob_conserves_angular_momentum") {
            let mut figures = Figures::new(&ANGULAR_MOMENTUM, word, 10).on(name);
            let measured = drift(solver, "viscosity = 0.001", executor);
            figures.measure("change over its size in 1000 steps", measured);
            figures.close();
        }
    }
    // Control and report: Mueller's viscosity acts along the difference of velocities, not along the line of the pair.
    let mut figures = Figures::new(&ANGULAR_MOMENTUM, "control", 10);
    figures.measure("mueller2003", drift(MUELLER, "viscosity = 0.01", executor()));
    figures.close();
}

#[test]
fn viscosity_only_dissipates_energy() {
    // Almost no pressure, so that only friction acts; in one step the energy may rise by one rounding.
    let rise = |solver: &str, viscosity: f32| {
        let mut scene = blob(0.0, "", solver);
        scene.solver.sound_speed = Some(1e-3);
        scene.solver.max_dt = 0.002;
        scene.fluid.material.viscosity = viscosity;
        let start = stirred(&scene, 0.2);
        let mut simulation = Simulation::with_particles(&scene, executor(), &start).unwrap();
        let (first, mut last, mut worst) = (square_sum(&start), square_sum(&start), f64::NEG_INFINITY);
        for _ in 0..100 {
            simulation.advance(0.001).unwrap();
            let energy = square_sum(&simulation.particles().unwrap());
            worst = worst.max((energy - last) / first);
            last = energy;
        }
        (worst, last / first)
    };
    for &Variant { name: word, keys: solver, .. } in ENERGY.variants {
        let mut figures = Figures::new(&ENERGY, word, 10);
        let (worst, left) = rise(solver, 0.01);
        figures.measure("largest rise in a step over the initial energy", worst);
        figures.measure("energy after 0.1 s over the initial energy", left);
        // Control: without viscosity the energy does not decay.
        let (_, inviscid) = rise(solver.replace("0.1", "0.0").as_str(), 0.0);
        figures.measure("the same without viscosity", inviscid);
        figures.close();
    }
}
