//! Fluid that fills a closed domain with `dfsph`: nothing but the walls determines the level of its pressure.

use splashdown::{Scene, Simulation};
use splashdown_gpu::{CpuExecutor, Executor, testing};
use splashdown_io::Particles;

const EDGE: f32 = 0.4;
const SPACING: f32 = 0.04;
const DENSITY: f32 = 998.2;
/// The speed of the tips of the stirrer in m/s.
const TIP: f32 = 0.4;

/// A full box with a stirrer.
fn scene(gravity: f32) -> Scene {
    let text = format!(
        "[scene]\nname = \"vessel\"\nduration = 1\ngravity = [0, -{gravity}, 0]\n\
         [domain]\nmin = [0, 0, 0]\nmax = [{EDGE}, {EDGE}, {EDGE}]\n[fluid]\nparticle_spacing = {SPACING}\n\
         [[fluid.block]]\nposition = [0, 0, 0]\nsize = [{EDGE}, {EDGE}, {EDGE}]\n\
         [[body]]\nname = \"stirrer\"\nmesh = \"cube\"\nscale = [0.2, 0.08, 0.08]\nposition = [0.2, 0.2, 0.2]\n\
         motion = \"scripted\"\nturn = [\"0\", \"0\", \"{} * t\"]\n[solver]\nmethod = \"dfsph\"\n",
        (TIP / 0.1).to_degrees(),
    );
    Scene::parse(&text, "vessel.toml").unwrap_or_else(|errors| panic!("{errors}"))
}

/// The particles after half a second.
fn stirred(scene: &Scene, executor: Executor) -> Particles {
    let mut simulation = Simulation::with_executor(scene, executor).unwrap();
    for _ in 0..10 {
        let stats = simulation.advance(0.05).unwrap();
        assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
    }
    simulation.particles().unwrap()
}

/// The mean pressure of the particles between two heights.
fn pressure_between(particles: &Particles, low: f32, high: f32) -> f32 {
    let of_layer = particles.positions.iter().zip(&particles.pressures);
    let layer: Vec<f32> = of_layer.filter(|(x, _)| (low..high).contains(&x[1])).map(|(_, p)| *p).collect();
    assert!(layer.len() > 50, "{} particles in the layer", layer.len());
    layer.iter().sum::<f32>() / layer.len() as f32
}

fn root_mean_square_speed(particles: &Particles) -> f32 {
    let squares: f32 = particles.velocities.as_flattened().iter().map(|v| v * v).sum();
    (squares / particles.velocities.len() as f32).sqrt()
}

#[test]
fn a_stirred_vessel_keeps_the_level_of_its_pressure() {
    for (_, executor) in testing::executors("a_stirred_vessel") {
        let particles = stirred(&scene(9.81), executor);
        let floor = pressure_between(&particles, 0.0, SPACING);
        let ceiling = pressure_between(&particles, EDGE - SPACING, EDGE);
        let expected = DENSITY * 9.81 * (EDGE - SPACING);
        assert!((floor - ceiling - expected).abs() < 0.1 * expected, "{floor} - {ceiling}, {expected} Pa");
        assert!((-0.1..0.5).contains(&(ceiling / expected)), "{ceiling} Pa at the ceiling");
        let speed = root_mean_square_speed(&particles);
        assert!((0.1..0.6).contains(&(speed / TIP)), "{speed} m/s");
    }
}

#[test]
fn a_weightless_vessel_is_stirred_by_dynamic_pressures() {
    let particles = stirred(&scene(0.0), CpuExecutor::new().into());
    let highest = particles.pressures.iter().copied().fold(0.0, f32::max);
    let dynamic = 0.5 * DENSITY * TIP * TIP;
    assert!((1.0..50.0).contains(&(highest / dynamic)), "{highest} Pa, dynamic {dynamic} Pa");
    let speed = root_mean_square_speed(&particles);
    assert!((0.1..0.6).contains(&(speed / TIP)), "{speed} m/s");
}
