//! A scheme can request the pressure force of fluid, walls and bodies separately from the other forces. Also compares the
//! passes of bodies between the executors from equal input.

use glam::Vec3;
use splashdown_gpu::{Executor, testing};

use super::Simulation;
use crate::boundary::part::Part;
use crate::checkpoint::Checkpoint;
use crate::scene::{KernelKind, Scene};
use crate::schemes::{self, Couplings, Scheme};
use crate::state::StepState;

/// Water at rest round two bodies, one static and one dynamic.
const SCENE: &str = r#"
    [scene]
    name = "basin"
    duration = 1.0
    [domain]
    min = [0, 0, 0]
    max = [0.4, 0.4, 0.3]
    [fluid]
    initial_pressure = "zero"
    particle_spacing = 0.025
    [[fluid.block]]
    position = [0, 0, 0]
    size = [0.4, 0.2, 0.3]
    [[body]]
    name = "standing"
    mesh = "cube"
    scale = 0.1
    position = [0.1213, 0.0517, 0.1391]
    rotation = [0, 23, 0]
    friction = 0.7
    adhesion = 2.0
    [[body]]
    name = "floating"
    mesh = "sphere"
    scale = 0.1
    position = [0.2823, 0.1519, 0.1487]
    motion = "dynamic"
    density = 500
    [surface]
    enabled = false
    [solver]
    method = "wcsph"
"#;

/// Accelerations of the particles in m/s^2, and forces and torques on the bodies in the unit of their sums.
struct Forces {
    accelerations: Vec<Vec3>,
    reactions: Vec<f64>,
}

fn checkpoint(kernel: KernelKind) -> Checkpoint {
    let mut scene = Scene::parse(SCENE, "basin.toml").unwrap();
    scene.solver.kernel = kernel;
    // Without the packing around bodies, particles are so far from them that contacts do not limit their velocities.
    let mut particles = crate::sample::particles(&scene).unwrap();
    let bodies = Simulation::load_bodies(&scene, &|_, _| {}).unwrap();
    let near: Vec<_> = bodies.iter().collect();
    crate::sample::retain_outside(&scene, &mut particles, &near, crate::sample::clearance_of(&scene));
    particles.ids = (0..particles.len() as u32).collect();
    let executor = splashdown_gpu::CpuExecutor::new().into();
    let mut simulation = Simulation::with_particles(&scene, executor, &particles).unwrap();
    // At 0.02 s the reactions on the two executors differ by 1.1 %, with pressures that are still near zero.
    simulation.advance(0.03).unwrap();
    let text = SCENE.replace("[solver]", &format!("[solver]\nkernel = \"{kernel}\""));
    simulation.checkpoint(&text).unwrap()
}

/// The forces of one part, in the state of a checkpoint.
fn forces(checkpoint: &Checkpoint, executor: Executor, part: Part) -> Forces {
    let mut simulation = Simulation::resume(checkpoint, executor).unwrap();
    let couplings = Couplings { bodies: simulation.bodies.as_ref(), ..Couplings::default() };
    let (cells, fields) = (&simulation.cells, &simulation.fields);
    let count = simulation.params.particle_count;
    let scheme = Scheme::new(&simulation.scene);
    let mut recording = schemes::begin_frame(cells, fields);
    recording.append(&schemes::part_of_forces(scheme, cells, fields, &couplings, count, part));
    let sums = couplings.bodies.unwrap().sums;
    let executor = &mut simulation.executor;
    executor.write(fields.frame_input, &StepState::frame_input(0.01, 0.0, 0.0)).unwrap();
    executor.write(sums, &vec![0; sums.len() as usize]).unwrap();
    executor.run(&recording).unwrap();
    let words = executor.read(sums).unwrap();
    let number = |pair: &[u32; 2]| (u64::from(pair[0]) | u64::from(pair[1]) << 32) as i64 as f64;
    // The executors sort particles into different cells.
    let mut by_id: Vec<(u32, Vec3)> = executor
        .read(fields.ids)
        .unwrap()
        .into_iter()
        .zip(executor.read(fields.accelerations).unwrap().iter().map(|a| a.truncate()))
        .collect();
    by_id.sort_unstable_by_key(|(id, _)| *id);
    Forces {
        accelerations: by_id.into_iter().map(|(_, acceleration)| acceleration).collect(),
        reactions: words.as_chunks().0.iter().map(number).collect(),
    }
}

/// The fraction of particles whose accelerations differ by more than a thousandth of the largest one.
fn differing(a: &[Vec3], b: &[Vec3]) -> f64 {
    let largest = a.iter().map(|a| a.length()).fold(0.0, f32::max);
    let differ = a.iter().zip(b).filter(|(a, b)| a.distance(**b) > 1e-3 * largest || !a.is_finite());
    differ.count() as f64 / a.len() as f64
}

/// The largest difference of reactions, relative to the largest reaction.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let largest = a.iter().fold(0.0, |most, a| a.abs().max(most));
    a.iter().zip(b).fold(0.0, |most, (a, b)| (a - b).abs().max(most)) / largest
}

#[test]
fn pressure_and_other_forces_sum_to_all_forces() {
    for kernel in [KernelKind::WendlandC2, KernelKind::WendlandBlend, KernelKind::CubicSpline] {
        let checkpoint = checkpoint(kernel);
        let parts = [Part::All, Part::Pressure, Part::Other];
        let of = |executor: fn() -> Executor| parts.map(|part| forces(&checkpoint, executor(), part));
        let on_cpu = of(|| splashdown_gpu::CpuExecutor::new().into());
        let mut on_all = vec![("CPU", on_cpu)];
        if let Some(gpu) = testing::gpu_or_skip("pressure_and_other_forces_sum_to_all_forces") {
            let executor = || Executor::from(splashdown_gpu::GpuExecutor::new(gpu.clone()));
            on_all.push(("GPU", parts.map(|part| forces(&checkpoint, executor(), part))));
        }
        for (name, [all, pressure, other]) in &on_all {
            let name = format!("{kernel} on the {name}");
            let sum: Vec<Vec3> =
                pressure.accelerations.iter().zip(&other.accelerations).map(|(a, b)| a + b).collect();
            // The contact limits the velocity that follows from all forces, so that it is not a sum of parts.
            let apart = differing(&all.accelerations, &sum);
            assert!(apart < 0.01, "{name}: {apart}");
            let sum: Vec<f64> = pressure.reactions.iter().zip(&other.reactions).map(|(a, b)| a + b).collect();
            let apart = difference(&all.reactions, &sum);
            assert!(apart < 0.01, "{name}: {apart}");
            // Controls: neither part is negligible.
            for part in [pressure, other] {
                let apart = differing(&all.accelerations, &part.accelerations);
                assert!(apart > 0.1, "{name}: {apart}");
                let apart = difference(&all.reactions, &part.reactions);
                assert!(apart > 0.02, "{name}: {apart}");
            }
        }
        if let [(_, cpu), (_, gpu)] = &on_all[..] {
            for ((cpu, gpu), part) in cpu.iter().zip(gpu).zip(parts) {
                let apart = differing(&cpu.accelerations, &gpu.accelerations);
                assert!(apart < 2e-3, "{kernel} {part:?}: {apart}");
                // The forces around a body cancel except for a small part, and each executor computes the densities.
                // Where a clamped pressure becomes positive, its hydrostatic part in a body starts with a jump, and
                // rounding selects the side for a few particles.
                let apart = difference(&cpu.reactions, &gpu.reactions);
                assert!(apart < 0.01, "{kernel} {part:?}: {apart}");
            }
        }
    }
}
