//! Measuring speed: a dam break with a given number of particles, and the wall time of its steps.

use std::fmt::Write;
use std::time::Instant;

use splashdown::scene::{Scene, SceneErrors};
use splashdown::{Simulation, SimulationError};

/// A power of two, so that the coordinates of the lattice and thus the counts are exact.
const SPACING: f64 = 1.0 / 64.0;

/// A column of about `particles` particles, twice as deep as wide and high, in a tank of three times its width. The
/// number of neighbours per particle does not depend on the size of the column, so the cost per particle is comparable.
pub fn bench_scene(particles: u32) -> Result<Scene, SceneErrors> {
    let side = (f64::from(particles) / 2.0).cbrt().round().max(1.0);
    let depth = (f64::from(particles) / (side * side)).round().max(1.0);
    let [width, height, depth] = [side, side, depth].map(|count| count * SPACING);
    // A domain has at least four spacings in every direction.
    let minimum = 4.0 * SPACING;
    let mut text = String::new();
    // Writing into a string cannot fail.
    let _ = write!(
        text,
        "[scene]\nname = \"bench\"\nduration = 1.0\n\
         [domain]\nmin = [0, 0, 0]\nmax = [{}, {}, {}]\nopen = [\"y_max\"]\n\
         [fluid]\nparticle_spacing = {SPACING}\n\
         [[fluid.block]]\nposition = [0, 0, 0]\nsize = [{width}, {height}, {depth}]\n\
         [solver]\nmethod = \"wcsph\"\n",
        (3.0 * width).max(minimum),
        (2.0 * height).max(minimum),
        depth.max(minimum),
    );
    Scene::parse(&text, "the benchmark's scene")
}

/// Simulates about `steps` steps and waits until they end. Returns the wall time per step in s and the number of steps.
///
/// # Errors
/// Those of the simulation.
pub fn seconds_per_step(simulation: &mut Simulation, steps: u32) -> Result<(f64, u32), SimulationError> {
    // The time step is adaptive, so the number of steps is known only afterwards.
    let duration = simulation.dt() * steps as f32;
    let start = Instant::now();
    let stats = simulation.advance(duration)?;
    let taken = stats.steps_in_frame.max(1);
    Ok((start.elapsed().as_secs_f64() / f64::from(taken), taken))
}

#[cfg(test)]
mod tests {
    use super::bench_scene;
    use splashdown::scene::Derived;

    #[test]
    fn the_scene_has_the_requested_number_of_particles() {
        let cases = [(1, 0.0), (8192, 0.0), (65_536, 0.0), (1_048_576, 0.005), (10_000, 0.02)];
        for (requested, tolerance) in cases {
            let scene = bench_scene(requested).expect("a valid scene");
            let count = Derived::new(&scene).particles as f64;
            let error = (count / f64::from(requested) - 1.0).abs();
            assert!(error <= tolerance, "{count} particles instead of {requested}");
        }
    }
}
