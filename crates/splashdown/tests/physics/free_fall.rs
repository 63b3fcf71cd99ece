//! Free fall: symplectic Euler gives exactly y0 + v0 t - g t (t + dt) / 2.

use splashdown::Simulation;
use splashdown_gpu::testing;
use splashdown_io::Particles;

use super::cases::{Case, Variant};
use super::figures::Figures;
use super::scene;

const DT: f32 = 0.002;
const STEPS: u32 = 100;

/// A hundred roundings of positions near one, half a unit in the last place each, accumulate to 3e-7 as a random walk.
static CASE: Case = Case {
    name: "free fall",
    across: "block",
    sizes: &[5],
    variants: &[Variant::new("mueller2003", ""), Variant::new("wcsph", "")],
};
pub const CASES: &[&Case] = &[&CASE];

fn text(method: &str) -> String {
    format!(
        r#"
        [scene]
        name = "free-fall"
        duration = 1.0
        [domain]
        min = [-4, -4, -4]
        max = [4, 4, 4]
        [fluid]
        particle_spacing = 0.1
        [[fluid.block]]
        position = [0, 0, 0]
        size = [0.5, 0.5, 0.5]
        [solver]
        method = "{method}"
        sound_speed = 10
        max_dt = {DT}
        "#
    )
}

#[test]
fn free_fall_of_particles_and_a_block_follows_symplectic_euler() {
    for &Variant { name: method, .. } in CASE.variants {
        for (name, executor) in testing::executors("free_fall") {
            let mut figures = Figures::new(&CASE, method, 5).on(name);
            let scene = scene(&text(method));
            // Isolated particles, more than a support radius apart, with individual velocities; then the block.
            let lone = |i: u32| [-3.0 + 0.5 * i as f32, 1.0 + 0.25 * (i % 3) as f32, -2.0];
            let mut particles = Particles::from_positions((0..12).map(lone).collect())
                .with_velocities((0..12).map(|i| [0.25, 0.5 * i as f32 - 2.0, -0.125]).collect());
            let lone = particles.positions.len();
            let block = splashdown::sample::particles(&scene).unwrap();
            particles.positions.extend(&block.positions);
            particles.velocities.extend(&block.velocities);
            let mut simulation = Simulation::with_particles(&scene, executor, &particles).unwrap();
            for _ in 0..STEPS {
                assert_eq!(simulation.advance(DT).unwrap().steps_in_frame, 1);
            }
            let after = simulation.particles().unwrap();
            let dt = f64::from(DT);
            let t = dt * f64::from(STEPS);
            let fall = |i: usize, last: f64| {
                let (y, v) = (f64::from(particles.positions[i][1]), f64::from(particles.velocities[i][1]));
                y + v * t - 0.5 * 9.81 * t * (t + last)
            };
            let worst = |last: f64| {
                let error = |i: usize| (f64::from(after.positions[i][1]) - fall(i, last)).abs();
                (0..lone).map(error).fold(0.0, f64::max)
            };
            let mean = |of: &Particles| {
                of.positions[lone..].iter().map(|x| f64::from(x[1])).sum::<f64>()
                    / block.positions.len() as f64
            };
            let centre = mean(&after) - mean(&particles) + 0.5 * 9.81 * t * (t + dt);
            figures.measure("worst isolated particle, m", worst(dt));
            figures.measure("centre of the block, m", centre.abs());
            // Control: the exact parabola differs by half a step.
            figures.measure("against the parabola, m", worst(0.0));
            figures.close();
        }
    }
}
