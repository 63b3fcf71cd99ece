//! Bodies that rest on solids under water, and the load of the water on them.

use glam::Vec3;
use splashdown::Simulation;
use splashdown::scene::{Motion, Scene};
use splashdown_gpu::{CpuExecutor, Executor, GpuExecutor, testing};

use crate::{body, free, tank};

const SPACING: f32 = 0.03;
const DEPTH: f32 = 0.36;

/// A still pool with a box of this size, whose lowest point is `above` the floor.
fn pool(size: Vec3, above: f32, density: f32) -> Scene {
    let mut scene = tank(SPACING, [0.6, 0.5, 0.6], DEPTH);
    scene.gravity = Vec3::new(0.0, -9.81, 0.0);
    let place = Vec3::new(0.3, above + 0.5 * size.y, 0.3);
    let mut plate = body("plate", "cube", 1.0, place, free(density));
    plate.mesh.scale = size;
    scene.bodies.push(plate);
    scene
}

/// The mean vertical force of the water on the first body in the last fifth of a second, and the corrections.
fn load(scene: &Scene, executor: Executor, seconds: f32) -> (f32, u32) {
    let mut simulation = Simulation::with_executor(scene, executor).unwrap();
    simulation.advance(seconds).unwrap();
    let (mut sum, mut corrections) = (0.0, 0);
    for _ in 0..10 {
        corrections = simulation.advance(0.02).unwrap().wall_corrections;
        sum += 0.1 * simulation.body_states().unwrap()[0].force.y;
    }
    (sum, corrections)
}

/// The weight in N of the water above a box that rests on the floor.
fn weight_above(size: Vec3) -> f32 {
    998.2 * 9.81 * (DEPTH - size.y) * size.x * size.z
}

/// While the pressure solver let such bodies yield, the water above them fell into them and burst: a cube of 100 kg/m^3 after 0.3 s,
/// a plate heavier than water after 0.8 s.
#[test]
fn a_body_on_the_floor_carries_the_water_above_it() {
    let plate = Vec3::new(0.3, 0.06, 0.3);
    for (size, density) in [(plate, 1200.0), (Vec3::splat(0.18), 100.0)] {
        let (force, corrections) = load(&pool(size, 0.0, density), CpuExecutor::new().into(), 0.6);
        let weight = weight_above(size);
        eprintln!("{density} kg/m^3: {force} N, weight {weight} N, {corrections} corrections");
        // The surface on which the water acts is a little wider than the box: at six spacings the force on a fixed one is 15 %
        // too large.
        assert!((force / weight + 1.0).abs() < 0.1, "{density}: {force} of {weight} N");
        assert_eq!(corrections, 0, "{density}");
    }
}

/// A light body that the water presses against a fixed slab is held in the same way, and one that nothing holds is free.
#[test]
fn a_body_under_a_slab_carries_its_lift() {
    let size = Vec3::splat(0.18);
    let mut scene = pool(size, 0.09, 100.0);
    let mut slab = body("slab", "cube", 1.0, Vec3::new(0.3, 0.315, 0.3), Motion::Static);
    slab.mesh.scale = Vec3::new(0.3, 0.09, 0.3);
    scene.bodies.push(slab);
    let (force, corrections) = load(&scene, CpuExecutor::new().into(), 0.6);
    // The water below it has the pressure of its depth, and there is none above it.
    let lift = 998.2 * 9.81 * (DEPTH - 0.09) * size.x * size.z;
    eprintln!("{force} N, {lift} N, {corrections} corrections");
    assert!(
        (force / lift - 1.0).abs() < 0.1 && corrections == 0,
        "{force} of {lift} N, {corrections} corrections"
    );
    // Control: without the slab it rises.
    scene.bodies.pop();
    let mut simulation = Simulation::with_executor(&scene, CpuExecutor::new().into()).unwrap();
    simulation.advance(0.3).unwrap();
    let rise = simulation.body_states().unwrap()[0].position.y - 0.18;
    assert!(rise > 0.1, "{rise} m");
}

#[test]
fn supports_agree_on_both_executors() {
    let Some(gpu) = testing::gpu_or_skip("supports_agree_on_both_executors") else { return };
    let size = Vec3::new(0.3, 0.06, 0.3);
    let scene = pool(size, 0.0, 300.0);
    let mut poisoned: Executor = GpuExecutor::new(gpu).into();
    poisoned.poison();
    let [(one, _), (two, corrections)] =
        [CpuExecutor::new().into(), poisoned].map(|executor| load(&scene, executor, 0.1));
    eprintln!("{one} N, {two} N");
    assert!((one / two - 1.0).abs() < 0.02 && corrections == 0, "{one} {two} N, {corrections} corrections");
    assert!((two / weight_above(size) + 1.0).abs() < 0.1, "{two} N");
}
