//! Steps that a GPU suspends have the same results as others.

use splashdown_gpu::{GpuExecutor, testing};
use splashdown_io::Particles;

use super::Simulation;
use crate::scene::Scene;
use crate::schemes::Scheme;
use crate::state::StepState;

/// Water or a viscous liquid that falls onto a floor; with a floating body, an emitter, a sink and a probe.
fn scene(viscosity: f32, tolerance: f32, couplings: bool) -> Scene {
    let coupled = r#"
        [[body]]
        name = "float"
        mesh = "cube"
        scale = 0.15
        position = [0.25, 0.42, 0.2]
        motion = "dynamic"
        density = 500
        [[emitter]]
        name = "jet"
        position = [0.75, 0.6, 0.2]
        direction = [0, -1, 0]
        shape = "disc"
        radius = 0.08
        speed = 1.0
        [[sink]]
        name = "drain"
        min = [0.9, 0.0, 0.0]
        max = [1.0, 0.1, 0.4]
        [[probe]]
        name = "gauge"
        quantity = "pressure"
        position = [0.1, 0.02, 0.2]
        "#;
    let text = format!(
        r#"
        [scene]
        name = "basin"
        duration = 1.0
        [domain]
        min = [0, 0, 0]
        max = [1.0, 0.8, 0.4]
        [fluid]
        particle_spacing = 0.05
        initial_pressure = "zero"
        viscosity = {viscosity}
        surface_tension = 0.07
        [[fluid.block]]
        position = [0, 0, 0]
        size = [0.5, 0.32, 0.4]
        [solver]
        method = "dfsph"
        surface_tension = "csf"
        tolerance = {tolerance}
        {}
        "#,
        if couplings { coupled } else { "" }
    );
    Scene::parse(&text, "basin.toml").unwrap_or_else(|errors| panic!("{errors}"))
}

/// The results of frames as bits, and the number of suspensions.
fn run(scene: &Scene, executor: GpuExecutor, rounds: Option<(u32, u32)>) -> (Vec<u32>, u32) {
    let mut simulation = Simulation::with_executor(scene, executor.into()).unwrap();
    // What the step records; the simulation changes a copy without effect.
    let recorded = std::mem::replace(&mut simulation.solver_rounds, Scheme::new(scene).solver_rounds());
    let (pressure, viscosity) = rounds.unwrap_or((recorded.pressure.most(), recorded.viscosity.most()));
    recorded.pressure.set(pressure);
    recorded.viscosity.set(viscosity);
    for _ in 0..4 {
        simulation.advance(0.01).unwrap();
    }
    let particles = simulation.particles().unwrap();
    let stats = simulation.stats();
    assert!(stats.iterations >= 8 && stats.particles > 400, "{stats:?}");
    let mut bits = vec![stats.steps as u32, stats.iterations as u32, stats.viscous_iterations as u32];
    bits.extend(&particles.ids);
    for values in
        [particles.positions.as_flattened(), particles.velocities.as_flattened(), &particles.pressures]
    {
        bits.extend(values.iter().map(|value| value.to_bits()));
    }
    for rows in simulation.take_probe_rows() {
        bits.extend(rows.iter().flatten().map(|value| (*value as f32).to_bits()));
    }
    let count = simulation.executor.read(simulation.fields.suspension).unwrap()[0].count;
    (bits, count)
}

#[test]
fn suspended_steps_have_the_results_of_whole_ones() {
    let Some(gpu) = testing::gpu_or_skip("suspended_steps_have_the_results_of_whole_ones") else { return };
    let executor = || GpuExecutor::new(gpu.clone());
    for (viscosity, couplings) in [(1e-6, false), (1.0, false), (1e-6, true), (1.0, true)] {
        let scene = scene(viscosity, 0.001, couplings);
        let (whole, none) = run(&scene, executor(), None);
        assert_eq!(none, 0);
        for rounds in [(1, 1), (2, 200), (40, 3)] {
            let (bits, suspensions) = run(&scene, executor(), Some(rounds));
            // Water has no iterations of the viscosity.
            assert!(suspensions > 0 || (viscosity < 1e-3 && rounds.0 == 40), "{viscosity}, {rounds:?}");
            assert!(bits == whole, "{viscosity}, couplings {couplings}: {rounds:?} rounds change the result");
        }
        // Control: one iteration more or less is detected.
        let (other, _) = run(&self::scene(viscosity, 0.0015, couplings), executor(), None);
        assert!(other != whole, "{viscosity}, couplings {couplings}");
    }
}

/// A simulation in the middle of a frame whose step is suspended in the solver that has fewer rounds.
fn suspended(scene: &Scene, executor: GpuExecutor, rounds: (u32, u32)) -> Simulation {
    let mut simulation = Simulation::with_executor(scene, executor.into()).unwrap();
    let recorded = std::mem::replace(&mut simulation.solver_rounds, Scheme::new(scene).solver_rounds());
    simulation.advance(0.02).unwrap();
    recorded.pressure.set(rounds.0);
    recorded.viscosity.set(rounds.1);
    simulation.set_steps_at_once(1);
    simulation.begin(0.01).unwrap();
    assert!(simulation.continue_frame().unwrap().is_none());
    let state = simulation.executor.read(simulation.fields.state).unwrap()[0];
    assert_eq!(state.done, StepState::SUSPENDED);
    simulation
}

/// Bits of positions, velocities and ids.
fn bits(particles: &Particles) -> Vec<u32> {
    let floats = [particles.positions.as_flattened(), particles.velocities.as_flattened()].concat();
    particles.ids.iter().copied().chain(floats.into_iter().map(f32::to_bits)).collect()
}

#[test]
fn particles_of_a_suspended_step_are_those_after_it() {
    let Some(gpu) = testing::gpu_or_skip("particles_of_a_suspended_step_are_those_after_it") else { return };
    let executor = || GpuExecutor::new(gpu.clone());
    // Suspended in the pressure of water and of a viscous liquid, and in the viscosity.
    for (viscosity, rounds) in [(1e-6, (1, 200)), (1.0, (1, 200)), (1.0, (40, 1))] {
        let scene = scene(viscosity, 1e-5, true);
        let mut whole = Simulation::with_executor(&scene, executor().into()).unwrap();
        let recorded = std::mem::replace(&mut whole.solver_rounds, Scheme::new(&scene).solver_rounds());
        recorded.pressure.set(recorded.pressure.most());
        recorded.viscosity.set(recorded.viscosity.most());
        whole.advance(0.02).unwrap();
        whole.set_steps_at_once(1);
        let before = bits(&whole.particles().unwrap());
        whole.begin(0.01).unwrap();
        let _ = whole.continue_frame().unwrap();
        let expected = bits(&whole.particles().unwrap());
        assert!(expected != before, "control: the step moves particles");

        // Read in the middle of the frame, and at its early end.
        let mut read = suspended(&scene, executor(), rounds);
        assert!(bits(&read.particles().unwrap()) == expected, "{viscosity}, {rounds:?}");
        // A second time nothing happens.
        assert!(bits(&read.particles().unwrap()) == expected, "{viscosity}, {rounds:?}");
        let mut ended = suspended(&scene, executor(), rounds);
        let stats = ended.end_frame_early().unwrap();
        assert!(stats.steps_in_frame == 1, "{stats:?}");
        assert!(bits(&ended.particles().unwrap()) == expected, "{viscosity}, {rounds:?}: early end");

        // A frame that is abandoned ends its step as well, and the next frame is the same.
        let mut abandoned = suspended(&scene, executor(), rounds);
        abandoned.sort().unwrap();
        assert!(bits(&abandoned.particles().unwrap()) == expected, "{viscosity}, {rounds:?}: abandoned");
        for simulation in [&mut whole, &mut abandoned] {
            simulation.set_steps_at_once(64);
            simulation.advance(0.01).unwrap();
        }
        let counts = [&whole, &abandoned].map(|simulation| simulation.stats().drained);
        assert_eq!(counts[0], counts[1]);
        assert!(
            bits(&abandoned.particles().unwrap()) == bits(&whole.particles().unwrap()),
            "{viscosity}, {rounds:?}: the frame after an abandoned one"
        );
    }
}
