//! A cylinder of liquid without gravity that is stretched along one axis and compressed along the other (Monaghan 1994).
//!
//! The velocity (-A x, A y) remains linear, so that the cross section remains an ellipse with the semi-axes a and b:
//! da/dt = -A a, db/dt = A b and dA/dt = A^2 (a^2 - b^2) / (a^2 + b^2). Every particle moves along a known path, and the
//! arrangement of the particles is sheared without limit: a lattice would resist. A slab between two walls represents two
//! dimensions.

use glam::DVec2;
use splashdown::{Simulation, sample};

use super::cpu;
use super::figures::{Figures, full};
use super::scene;

/// Initial radius in m, and rate in 1/s.
const RADIUS: f64 = 1.0;
const RATE: f64 = 1.0;
/// Spacings across the diameter.
const ACROSS: f64 = 32.0;
/// 15 times the largest initial speed.
const SOUND: &str = "sound_speed = 15";

/// The gate: relative error of the semi-axes after times that are multiples of one over the initial rate.
const SEMI_AXES: [(f64, f64); 3] = [(0.5, 0.02), (1.0, 0.03), (2.0, 0.03)];

/// The semi-axes a and b at a time in seconds.
fn exact(time: f64) -> DVec2 {
    let (mut axes, mut rate) = (DVec2::splat(RADIUS), RATE);
    let steps = 10_000;
    let dt = time / f64::from(steps);
    for _ in 0..steps {
        let slope = |axes: DVec2, rate: f64| {
            let (a2, b2) = (axes.x * axes.x, axes.y * axes.y);
            (DVec2::new(-rate * axes.x, rate * axes.y), rate * rate * (a2 - b2) / (a2 + b2))
        };
        let first = slope(axes, rate);
        let middle = slope(axes + 0.5 * dt * first.0, rate + 0.5 * dt * first.1);
        axes += dt * middle.0;
        rate += dt * middle.1;
    }
    axes
}

/// The semi-axes at each time of the gate up to `last`, relative to the exact ones, minus one. The second moments of the
/// particles give them.
fn deviations(solver: &str, last: f64) -> Vec<(f64, DVec2)> {
    let spacing = 2.0 * RADIUS / ACROSS;
    let thick = 6.0 * spacing;
    let scene = scene(&format!(
        r#"
        [scene]
        name = "stretching"
        duration = 10
        gravity = [0, 0, 0]
        [domain]
        min = [-2, -4, 0]
        max = [2, 4, {thick}]
        open = ["x_min", "x_max", "y_min", "y_max"]
        [fluid]
        particle_spacing = {spacing}
        [[fluid.block]]
        position = [-1, -1, 0]
        size = [2, 2, {thick}]
        [solver]
        {solver}
        "#
    ));
    let mut particles = sample::particles(&scene).unwrap();
    let inside = |x: &[f32; 3]| f64::from(x[0]).hypot(f64::from(x[1])) < RADIUS;
    particles.positions.retain(inside);
    particles.velocities =
        particles.positions.iter().map(|x| [-RATE as f32 * x[0], RATE as f32 * x[1], 0.0]).collect();
    let count = particles.positions.len();
    particles.ids = (0..count as u32).collect();
    let moments = |positions: &[[f32; 3]]| {
        let sum: DVec2 = positions.iter().map(|x| DVec2::new(x[0].into(), x[1].into()).powf(2.0)).sum();
        DVec2::new(sum.x.sqrt(), sum.y.sqrt())
    };
    let first = moments(&particles.positions);
    let mut simulation = Simulation::with_particles(&scene, cpu(), &particles).unwrap();
    let mut found = Vec::new();
    for (time, _) in SEMI_AXES.into_iter().filter(|&(time, _)| time <= last) {
        let time = time / RATE;
        while simulation.stats().time < time - 1e-6 {
            let left = time - simulation.stats().time;
            simulation.advance(left.min(0.1) as f32).unwrap();
        }
        let now = simulation.particles().unwrap();
        assert_eq!(now.positions.len(), count, "particles were lost");
        let exact = exact(simulation.stats().time) / RADIUS;
        found.push((time * RATE, moments(&now.positions) / first / exact - 1.0));
    }
    found
}

#[test]
fn a_stretched_drop_follows_the_exact_solution() {
    let last = if full() { 2.0 } else { 1.0 };
    let mut variants = vec![("continuity", "density = \"continuity\"")];
    if full() {
        variants.push(("engineering", "accuracy = \"engineering\""));
    }
    for (word, solver) in variants {
        let solver = &format!("{SOUND}\n{solver}");
        let mut figures = Figures::new(format!("stretching drop, {word}, CPU"));
        for ((time, deviation), (_, gate)) in deviations(solver, last).into_iter().zip(SEMI_AXES) {
            figures.within(format!("error of the long semi-axis at A t = {time}"), deviation.y, -gate, gate);
            figures.within(format!("error of the short semi-axis at A t = {time}"), deviation.x, -gate, gate);
        }
        figures.close();
    }
}

#[test]
fn the_elasticity_of_summed_densities_is_detected() {
    let (_, deviation) = deviations(&format!("{SOUND}\ndensity = \"summation\""), 0.5)[0];
    let mut figures = Figures::new("stretching drop, controls, CPU");
    if full() {
        for solver in ["method = \"dfsph\"", "method = \"dfsph\"\nsupport_ratio = 3"] {
            for ((time, deviation), _) in deviations(solver, 2.0).into_iter().zip(SEMI_AXES) {
                figures
                    .report(format!("error of the short semi-axis at A t = {time}, {solver}"), deviation.x);
            }
        }
    }
    figures.control("error of the short semi-axis, summation", deviation.x.abs(), SEMI_AXES[0].1);
    figures.close();
}
