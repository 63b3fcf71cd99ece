//! Runs are bit-identical; invalid particles are counted, reported and removed before they affect others.

use splashdown::scene::{Scene, Sort};
use splashdown::{Device, Simulation, SimulationError, Stats, sample};
use splashdown_gpu::{CpuExecutor, Executor, testing};
use splashdown_io::Particles;

fn cpu() -> Executor {
    CpuExecutor::new().into()
}

/// A block that falls into the corner of a tank.
fn scene(spacing: f32, open: &str, solver: &str) -> Scene {
    let text = format!(
        r#"
        [scene]
        name = "block"
        duration = 1.0
        [domain]
        min = [0, 0, 0]
        max = [1.5, 1.0, 0.75]
        open = [{open}]
        [fluid]
        particle_spacing = {spacing}
        [[fluid.block]]
        position = [0, 0, 0]
        size = [0.5, 0.5, 0.5]
        velocity = [0.5, 0.0, 0.25]
        [solver]
        {solver}
        "#
    );
    Scene::parse(&text, "block.toml").unwrap_or_else(|errors| panic!("{errors}"))
}

const SOLVERS: [&str; 5] = [
    "method = \"wcsph\"",
    "method = \"wcsph\"\ndensity = \"continuity\"\nwall_friction = 1.0",
    "method = \"wcsph\"\nsurface_tension = \"akinci2013\"\nkernel = \"cubic_spline\"",
    "method = \"mueller2003\"\nsurface_tension = \"mueller2003\"",
    "method = \"dfsph\"\nwall_friction = 1.0",
];

/// Whether a run has done enough for a comparison to mean something. An implicit pressure takes few large steps.
fn is_long_enough(solver: &str, stats: &Stats) -> bool {
    if solver.contains("dfsph") { stats.iterations >= 8 } else { stats.steps > 20 }
}

/// The results of a run, as bits.
fn run(scene: &Scene, executor: Executor, frames: u32, frame: f32) -> (Vec<u32>, Stats) {
    let mut simulation = Simulation::with_executor(scene, executor).unwrap();
    for _ in 0..frames {
        simulation.advance(frame).unwrap();
    }
    let Particles { ids, positions, velocities, densities, pressures, .. } = simulation.particles().unwrap();
    let floats = [positions.as_flattened(), velocities.as_flattened(), &densities, &pressures].concat();
    (ids.into_iter().chain(floats.into_iter().map(f32::to_bits)).collect(), simulation.stats())
}

#[test]
fn results_are_bit_identical_for_any_number_of_threads() {
    for solver in SOLVERS {
        // 8,000 particles are more than one chunk of every parallel loop.
        let scene = scene(0.025, "", solver);
        let on_threads = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| run(&scene, cpu(), 4, 0.003))
        };
        let first = on_threads(1);
        assert!(is_long_enough(solver, &first.1) && first.1.particles == 8000, "{:?}", first.1);
        for threads in [1, 2, 8] {
            assert!(on_threads(threads) == first, "{solver}: {threads} threads differ from one thread");
        }
    }
}

#[test]
fn a_device_is_bit_identical_when_repeated_and_with_both_sorts() {
    for solver in SOLVERS {
        let scene = scene(0.0625, "\"y_max\"", solver);
        let mut other_sort = scene.clone();
        other_sort.solver.sort = Sort::Bitonic;
        for (name, executor) in testing::executors("a_device_is_bit_identical_when_repeated") {
            let fresh = || match executor.gpu() {
                Some(gpu) => splashdown_gpu::GpuExecutor::new(gpu.clone()).into(),
                None => cpu(),
            };
            let first = run(&scene, fresh(), 3, 0.01);
            assert!(is_long_enough(solver, &first.1), "{:?}", first.1);
            assert!(run(&scene, fresh(), 3, 0.01) == first, "{name}, {solver}: the second run differs");
            assert!(run(&other_sort, fresh(), 3, 0.01) == first, "{name}, {solver}: the sorts differ");
            // Control: a change of the last bit of gravity changes the result.
            let mut heavier = scene.clone();
            heavier.gravity.y = heavier.gravity.y.next_up();
            assert!(run(&heavier, fresh(), 3, 0.01).0 != first.0, "{name}, {solver}: gravity has no effect");
        }
    }
}

/// Makes particles 40 and 7 of a block invalid and advances the block.
fn spoiled(
    executor: Executor,
    solver: &str,
    spoil: impl Fn(&mut [f32; 3], &mut [f32; 3]),
) -> (Stats, Particles, Particles) {
    let scene = scene(0.0625, "\"y_max\"", solver);
    let mut particles = sample::particles(&scene).unwrap();
    for i in [40, 7] {
        spoil(&mut particles.positions[i], &mut particles.velocities[i]);
    }
    let mut simulation = Simulation::with_particles(&scene, executor, &particles).unwrap();
    simulation.advance(0.01).unwrap();
    let stats = simulation.advance(0.01).unwrap();
    (stats, simulation.particles().unwrap(), particles)
}

#[test]
fn a_non_finite_particle_is_counted_reported_and_removed() {
    type Spoil = fn(&mut [f32; 3], &mut [f32; 3]);
    let ways: [(&str, Spoil, bool); 6] = [
        ("a NaN position", |x, _| x[1] = f32::NAN, false),
        ("an infinite position", |x, _| x[2] = f32::NEG_INFINITY, false),
        ("a NaN velocity", |_, v| v[0] = f32::NAN, true),
        ("an infinite velocity", |_, v| v[2] = f32::INFINITY, true),
        ("a velocity of 1e30", |_, v| v[1] = 1e30, true),
        ("a velocity of -1e20", |_, v| v[1] = -1e20, true),
    ];
    for solver in SOLVERS {
        for (what, spoil, has_place) in ways {
            for (name, executor) in testing::executors("a_non_finite_particle") {
                let (stats, after, before) = spoiled(executor, solver, spoil);
                let case = format!("{what}, {solver}, {name}: {stats:?}");
                let n = before.positions.len() as u32;
                assert_eq!((stats.non_finite, stats.particles, stats.escaped), (2, n - 2, 0), "{case}");
                assert_eq!(stats.non_finite_id, 7, "{case}");
                if has_place {
                    assert_eq!(stats.non_finite_place, before.positions[7], "{case}");
                }
                assert!(stats.non_finite_place.iter().all(|x| x.is_finite()), "{case}");
                // The other particles are unaffected.
                assert_eq!(after.positions.len() as u32, n - 2, "{case}");
                assert!(!after.ids.contains(&7) && !after.ids.contains(&40), "{case}");
                let all = [after.positions.as_flattened(), after.velocities.as_flattened()].concat();
                assert!(all.iter().all(|x| x.is_finite()), "{case}");
                assert!(stats.max_speed < 5.0 && stats.speed_limits == 0, "{case}");
            }
        }
    }
}

#[test]
fn an_excessive_speed_is_limited_and_counted() {
    for (name, executor) in testing::executors("an_excessive_speed") {
        let scene = scene(0.0625, "\"y_max\"", SOLVERS[0]);
        // Thousands of spacings per step; alone in the tank, so that it does not accelerate other particles.
        let (positions, velocities) = (vec![[0.8, 0.3, 0.3]], vec![[0.0, 1e6, 0.0]]);
        let particles = Particles::from_positions(positions).with_velocities(velocities);
        let mut simulation = Simulation::with_particles(&scene, executor, &particles).unwrap();
        // The first step is already the shortest allowed, so no step follows this speed even when limited.
        let result = simulation.advance(0.001);
        assert!(matches!(result, Err(SimulationError::StepTooSmall { .. })), "{name}: {result:?}");
        let stats = simulation.stats();
        // A GPU finishes its batch of steps before the error is read, and the particle may leave the domain in it.
        let counted = stats.particles + stats.escaped;
        assert!(stats.speed_limits > 0 && counted == 1 && stats.non_finite == 0, "{name}: {stats:?}");
    }
}

#[test]
fn particles_outside_the_domain_are_counted_and_removed() {
    for (name, executor) in testing::executors("particles_outside_the_domain") {
        let spoil = |x: &mut [f32; 3], _: &mut [f32; 3]| x[0] = -3.0;
        let (stats, after, before) = spoiled(executor, SOLVERS[0], spoil);
        assert_eq!((stats.escaped, stats.non_finite), (2, 0), "{name}: {stats:?}");
        assert_eq!(after.positions.len(), before.positions.len() - 2);
    }
}

#[test]
fn particles_leave_through_open_sides_and_are_counted() {
    for (name, executor) in testing::executors("particles_leave_through_open_sides") {
        let scene = scene(0.0625, "\"y_min\", \"y_max\"", SOLVERS[0]);
        let n = sample::particles(&scene).unwrap().positions.len() as u32;
        let mut simulation = Simulation::with_executor(&scene, executor).unwrap();
        assert_eq!(simulation.stats().escaped, 0);
        // Half a metre of fluid falls through the open floor: 0.28 m in 0.24 s.
        let mut last = simulation.stats();
        for _ in 0..4 {
            let stats = simulation.advance(0.06).unwrap();
            assert!(
                stats.escaped >= last.escaped && stats.particles + stats.escaped == n,
                "{name}: {stats:?}"
            );
            last = stats;
        }
        assert!((n / 4..n).contains(&last.escaped), "{name}: {last:?}");
        let left = simulation.particles().unwrap();
        assert_eq!(left.positions.len() as u32, last.particles);
        assert!(left.positions.iter().all(|x| x[1] >= 0.0));
        // Once no particle is left, the error states why they were removed.
        let error = (0..50).find_map(|_| simulation.advance(0.06).err()).unwrap();
        let SimulationError::NothingLeft { reason, .. } = &error else { panic!("{name}: {error}") };
        assert!(reason.contains(&format!("{n} left through open sides")), "{name}: {error}");
    }
}

#[test]
fn a_time_step_below_min_dt_is_an_error() {
    for (name, executor) in testing::executors("a_time_step_below_min_dt") {
        let mut scene = scene(0.0625, "", SOLVERS[0]);
        // Stability requires about 2e-4 s.
        (scene.solver.min_dt, scene.solver.max_dt) = (0.002, 0.005);
        let mut simulation = Simulation::with_executor(&scene, executor).unwrap();
        let error = (0..20).find_map(|_| simulation.advance(0.01).err());
        let Some(SimulationError::StepTooSmall { min_dt, .. }) = error else { panic!("{name}: {error:?}") };
        assert_eq!(min_dt, 0.002);
        // The next frame is checked independently.
        let error = simulation.advance(0.01).err();
        assert!(matches!(error, Some(SimulationError::StepTooSmall { .. })), "{name}: {error:?}");
        // Control: the same scene with a reasonable smallest step runs.
        scene.solver.min_dt = 1e-7;
        Simulation::new(&scene, &Device::Cpu).unwrap().advance(0.01).unwrap();
    }
}

#[test]
fn an_invalid_frame_duration_is_an_error() {
    for (name, executor) in testing::executors("an_invalid_frame_duration_is_an_error") {
        let mut simulation = Simulation::with_executor(&scene(0.0625, "", SOLVERS[0]), executor).unwrap();
        for seconds in [-0.01, f32::NAN, f32::INFINITY] {
            let error = simulation.advance(seconds).unwrap_err();
            assert!(matches!(error, SimulationError::BadDuration { .. }), "{name}: {error}");
        }
        let before = simulation.particles().unwrap();
        let stats = simulation.advance(0.0).unwrap();
        assert_eq!((stats.steps, stats.steps_in_frame, stats.time), (0, 0, 0.0), "{name}");
        assert_eq!(simulation.particles().unwrap().positions, before.positions, "{name}");
        // Control: the simulation still runs after the rejected and the empty frame.
        let stats = simulation.advance(0.01).unwrap();
        assert!(stats.steps > 0 && (stats.time - 0.01).abs() < 1e-6, "{name}: {stats:?}");
    }
}

#[test]
fn zero_and_one_particle_can_be_simulated() {
    for (name, executor) in testing::executors("zero_and_one_particle") {
        let scene = scene(0.0625, "", SOLVERS[0]);
        let mut nothing = Simulation::with_particles(&scene, executor, &Particles::default()).unwrap();
        let stats = nothing.advance(0.01).unwrap();
        assert_eq!((stats.particles, nothing.particles().unwrap().positions.len()), (0, 0), "{name}");
        assert!((stats.time - 0.01).abs() < 1e-6, "{name}: {stats:?}");
    }
    for (name, executor) in testing::executors("zero_and_one_particle") {
        let scene = scene(0.0625, "", SOLVERS[0]);
        let one = Particles::from_positions(vec![[0.7, 0.5, 0.3]]);
        let mut simulation = Simulation::with_particles(&scene, executor, &one).unwrap();
        let stats = simulation.advance(0.1).unwrap();
        let fallen = 0.5 - simulation.particles().unwrap().positions[0][1];
        // Free fall plus the error of symplectic steps of length dt: g t dt / 2.
        assert!((fallen - 0.5 * 9.81 * 0.01).abs() < 9.81 * 0.1 * stats.dt, "{name}: {fallen}");
    }
}

#[test]
fn many_dead_particles_do_not_affect_the_living() {
    for (name, executor) in testing::executors("many_dead_particles") {
        let scene = scene(0.0625, "", SOLVERS[0]);
        let mut particles = sample::particles(&scene).unwrap();
        let living = particles.positions.len();
        // More than the GPU sorts within a cell: comparing all pairs would take 10^10 comparisons per step.
        particles.positions.extend(vec![[0.0, 9.0, 0.0]; 100_000]);
        particles.ids = (0..particles.positions.len() as u32).collect();
        particles.velocities.resize(particles.positions.len(), [0.0; 3]);
        let mut crowded = Simulation::with_particles(&scene, executor, &particles).unwrap();
        let stats = crowded.advance(0.002).unwrap();
        assert_eq!((stats.particles as usize, stats.escaped), (living, 100_000), "{name}");
        assert_eq!(crowded.particles().unwrap().ids, (0..living as u32).collect::<Vec<_>>(), "{name}");
    }
}

#[test]
fn a_non_positive_density_is_removed_before_it_spreads() {
    for (name, executor) in testing::executors("a_non_positive_density") {
        let scene = scene(0.0625, "", SOLVERS[1]);
        let mut particles = sample::particles(&scene).unwrap();
        particles.densities = vec![1000.0; particles.positions.len()];
        particles.densities[100] = 0.0;
        particles.densities[200] = -1000.0;
        let n = particles.positions.len() as u32;
        let mut simulation = Simulation::with_particles(&scene, executor, &particles).unwrap();
        let stats = simulation.advance(0.002).unwrap();
        assert_eq!((stats.particles, stats.non_finite), (n - 2, 2), "{name}: {stats:?}");
        assert!(
            simulation.particles().unwrap().velocities.as_flattened().iter().all(|v| v.is_finite()),
            "{name}"
        );
    }
}
