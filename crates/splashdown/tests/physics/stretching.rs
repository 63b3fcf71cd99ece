//! A cylinder of liquid without gravity that is stretched along one axis and compressed along the other (Monaghan 1994).
//!
//! The velocity (-A x, A y) remains linear, so that the cross section remains an ellipse with the semi-axes a and b:
//! da/dt = -A a, db/dt = A b and dA/dt = A^2 (a^2 - b^2) / (a^2 + b^2). Every particle moves along a known path, and the
//! arrangement of the particles is sheared without limit: a lattice would resist. A slab between two walls represents two
//! dimensions.

use glam::DVec2;
use splashdown::{Simulation, sample};

use super::cases::{CONTROL, Case, Variant, is_validation};
use super::executor;
use super::figures::Figures;
use super::scene;

/// Initial radius in m, and rate in 1/s.
const RADIUS: f64 = 1.0;
const RATE: f64 = 1.0;

/// The times of the comparison, as multiples of one over the initial rate.
const TIMES: [f64; 3] = [0.5, 1.0, 2.0];

static CASE: Case = Case {
    name: "stretching drop",
    across: "diameter",
    sizes: &[32, 48, 64],
    // A sound speed of 15 times the largest initial speed.
    variants: &[
        Variant::new("continuity", "sound_speed = 15\ndensity = \"continuity\""),
        Variant::extra("engineering", "sound_speed = 15\naccuracy = \"engineering\""),
        Variant::extra("dfsph", "method = \"dfsph\""),
        Variant::extra("dfsph, support 3", "method = \"dfsph\"\nsupport_ratio = 3"),
        CONTROL,
    ],
};
pub const CASES: &[&Case] = &[&CASE];

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
fn deviations(solver: &str, across: u32, last: f64) -> Vec<(f64, DVec2)> {
    let spacing = 2.0 * RADIUS / f64::from(across);
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
    let mut simulation = Simulation::with_particles(&scene, executor(), &particles).unwrap();
    let mut found = Vec::new();
    for time in TIMES.into_iter().filter(|&time| time <= last) {
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
    let last = if is_validation() { 2.0 } else { 1.0 };
    CASE.run(|variant, across, figures| {
        for (time, deviation) in deviations(variant.keys, across, last) {
            figures.error(format!("error of the long semi-axis at A t = {time}"), deviation.y);
            figures.error(format!("error of the short semi-axis at A t = {time}"), deviation.x);
        }
        for time in TIMES.into_iter().filter(|&time| time > last) {
            figures.omit(format!("error of the long semi-axis at A t = {time}"));
            figures.omit(format!("error of the short semi-axis at A t = {time}"));
        }
    });
}

#[test]
fn the_elasticity_of_summed_densities_is_detected() {
    let mut figures = Figures::new(&CASE, "control", 32);
    let (_, deviation) = deviations("sound_speed = 15\ndensity = \"summation\"", 32, 0.5)[0];
    figures.measure("error of the short semi-axis, summation", deviation.x.abs());
    figures.close();
}
