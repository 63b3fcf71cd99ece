use glam::Vec3;
use splashdown::scene::{Motion, Scene};
use splashdown::{Device, Simulation};

use crate::body;

/// The rms speed in m/s of the water around a submerged cube four spacings wide, after half a second and after three.
fn speeds(solver: &str) -> [f32; 2] {
    let text = format!(
        "[scene]\nname = \"pool\"\nduration = 3\n[domain]\nmin = [0, 0, 0]\nmax = [0.6, 0.7, 0.5]\n[fluid]\nparticle_spacing = 0.05\n\
         [[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.6, 0.4, 0.5]\n[solver]\n{solver}\n"
    );
    let mut scene = Scene::parse(&text, "pool").unwrap_or_else(|errors| panic!("{errors}"));
    scene.bodies.push(body("cube", "cube", 0.2, Vec3::new(0.3, 0.2, 0.25), Motion::Static));
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    [0.5, 2.5].map(|seconds| {
        simulation.advance(seconds).unwrap();
        let velocities = simulation.particles().unwrap().velocities;
        let sum: f32 = velocities.iter().map(|v| Vec3::from(*v).length_squared()).sum();
        (sum / velocities.len() as f32).sqrt()
    })
}

/// The late speed is 1.1 times the early one with `continuity` and 0.6 times with `engineering`. With `continuity` it was 2.8 times
/// when the particles of water almost at rest were shifted.
#[test]
fn the_motion_of_still_water_around_a_cube_does_not_grow() {
    for solver in ["method = \"wcsph\"\ndensity = \"continuity\"", "accuracy = \"engineering\""] {
        let [early, late] = speeds(solver);
        eprintln!("{solver}: {early} and {late} m/s");
        assert!(early > 0.0 && late < 1.5 * early, "{solver}: {early} and {late} m/s");
    }
}
