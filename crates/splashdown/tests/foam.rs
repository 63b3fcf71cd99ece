//! Foam, spray and bubbles: generation, motion and reproducibility.

use splashdown::foam::Diffuse;
use splashdown::foam::{DiffuseKind, DiffuseParticles, Foam, FoamState};
use splashdown::scene::Scene;
use splashdown::{Device, Event, Run, RunOptions, Simulation};
use splashdown_gpu::{CpuExecutor, Executor, GpuExecutor, block_on, testing};

const HEAD: &str = "
[scene]
name = \"foam\"
duration = 1.0
";
/// A collapsing column at the lowest resolution that generates spray, foam and bubbles.
const COLUMN: &str = "
[domain]
min = [0, 0, 0]
max = [0.8, 0.8, 0.2]
[fluid]
particle_spacing = 0.03
[[fluid.block]]
shape = \"box\"
position = [0, 0, 0]
size = [0.24, 0.4, 0.2]
";
/// Water at rest in a narrow tank.
const CALM: &str = "
[domain]
min = [0, 0, 0]
max = [0.2, 0.6, 0.125]
[fluid]
particle_spacing = 0.025
[[fluid.block]]
shape = \"box\"
position = [0, 0, 0]
size = [0.2, 0.3, 0.125]
";

fn scene(fluid: &str) -> Scene {
    Scene::parse(&format!("{HEAD}{fluid}"), "foam.toml").unwrap()
}

/// The column with three times the rates of generation.
fn foaming_column() -> Scene {
    let mut scene = scene(&format!("{COLUMN}[solver]\nmethod = \"wcsph\"\n"));
    (scene.foam.trapped_air, scene.foam.wave_crest) = (600.0, 3000.0);
    scene
}

fn start(scene: &Scene, executor: Executor) -> (Simulation, Foam) {
    let mut simulation = Simulation::with_executor(scene, executor).unwrap();
    let foam = simulation.foam(&scene.foam).unwrap();
    (simulation, foam)
}

fn cpu(scene: &Scene) -> (Simulation, Foam) {
    start(scene, CpuExecutor::new().into())
}

/// Advances frames of 1/50 s, with an update of the foam after every batch of steps.
fn advance(simulation: &mut Simulation, foam: &Foam, frames: u32) {
    for _ in 0..frames {
        simulation.begin(0.02).unwrap();
        while simulation.continue_frame().unwrap().is_none() {
            simulation.advance_foam(foam).unwrap();
        }
        simulation.advance_foam(foam).unwrap();
    }
}

fn state(simulation: &mut Simulation, foam: &Foam) -> FoamState {
    let buffer = foam.state();
    simulation.executor().read(buffer).unwrap()[0]
}

/// Replaces all diffuse particles by one.
fn put(simulation: &mut Simulation, foam: &Foam, x: [f32; 3], v: [f32; 3], kind: DiffuseKind) {
    let particle = Diffuse { position: x.into(), lifetime: 1.0, velocity: v.into(), tag: kind as u32 };
    let now = FoamState { count: 1, ..state(simulation, foam) };
    let (pool, buffer) = (foam.pool(), foam.state());
    simulation.executor().write(pool, &[particle]).unwrap();
    simulation.executor().write(buffer, &[now]).unwrap();
}

#[test]
fn a_collapsing_column_generates_foam_and_water_at_rest_does_not() {
    let calm = scene(CALM);
    let (mut simulation, mut foam) = cpu(&calm);
    advance(&mut simulation, &foam, 30);
    assert!(simulation.diffuse(&mut foam).unwrap().is_empty());

    let column = scene(COLUMN);
    let (mut simulation, mut foam) = cpu(&column);
    advance(&mut simulation, &foam, 40);
    let diffuse = simulation.diffuse(&mut foam).unwrap();

    let kinds = [DiffuseKind::Spray, DiffuseKind::Foam, DiffuseKind::Bubble].map(|kind| diffuse.count(kind));
    assert!(kinds.iter().all(|&n| n > 20), "{kinds:?}");
    // All of them are inside the tank, close to the water or above it.
    for x in &diffuse.positions {
        assert!((0.0..=0.8).contains(&x[0]) && (0.0..=0.8).contains(&x[1]) && (0.0..=0.2).contains(&x[2]));
    }
    assert!(diffuse.lifetimes.iter().all(|&left| left > 0.0 && left <= 5.0));
    let mut ids = diffuse.ids.clone();
    ids.dedup();
    assert_eq!(ids.len(), diffuse.len());
    assert!(ids.is_sorted(), "the oldest first");
}

#[test]
fn foam_is_reproducible() {
    // Coarse, because a software driver takes milliseconds for each step.
    let mut scene = scene(&format!("{COLUMN}[solver]\nmethod = \"wcsph\"\n"));
    scene.fluid.particle_spacing = 0.04;
    (scene.foam.trapped_air, scene.foam.wave_crest) = (2000.0, 10_000.0);
    let run = |executor: Executor, pause: bool| -> DiffuseParticles {
        let (mut simulation, mut foam) = start(&scene, executor);
        if pause {
            // Negative control: another initial state.
            advance(&mut simulation, &foam, 1);
        }
        advance(&mut simulation, &foam, 14);
        simulation.diffuse(&mut foam).unwrap()
    };
    let first = run(CpuExecutor::new().into(), false);
    assert!(first.len() > 20, "{}", first.len());
    assert_eq!(run(CpuExecutor::new().into(), false), first);
    assert_ne!(run(CpuExecutor::new().into(), true), first);
    if let Some(gpu) = testing::gpu_or_skip("foam_is_reproducible") {
        let first = run(GpuExecutor::new(gpu.clone()).into(), false);
        assert!(first.len() > 20, "{}", first.len());
        assert_eq!(run(GpuExecutor::new(gpu).into(), false), first);
    }
}

#[test]
fn foam_does_not_affect_the_fluid() {
    let scene = scene(COLUMN);
    let (mut simulation, foam) = cpu(&scene);
    advance(&mut simulation, &foam, 10);
    let mut alone = Simulation::with_executor(&scene, CpuExecutor::new().into()).unwrap();
    for _ in 0..10 {
        alone.advance(0.02).unwrap();
    }
    assert_eq!(simulation.particles().unwrap(), alone.particles().unwrap());
}

#[test]
fn foam_of_a_resumed_run_is_bit_identical() {
    foam_is_the_same_when_resumed(foaming_column(), &Device::Cpu);
}

/// Foam changes after each submission, whose length depends on the iterations of the steps before.
#[test]
fn foam_of_a_resumed_run_with_implicit_pressure_is_bit_identical_on_an_adapter() {
    let name = "foam_of_a_resumed_run_with_implicit_pressure_is_bit_identical_on_an_adapter";
    let Some(gpu) = testing::gpu_or_skip(name) else { return };
    let device: Device = gpu.name().split(' ').next().unwrap().parse().unwrap();
    // Long frames, which have several submissions.
    let mut scene = scene(&format!("frame_rate = 10\n{COLUMN}[solver]\nmethod = \"dfsph\"\n"));
    (scene.foam.trapped_air, scene.foam.wave_crest) = (600.0, 3000.0);
    foam_is_the_same_when_resumed(scene, &device);
}

fn foam_is_the_same_when_resumed(mut scene: Scene, device: &Device) {
    scene.surface.enabled = false;
    scene.foam.enabled = true;
    let (early, late) = if scene.frame_rate < 20.0 { (5, 7) } else { (15, 17) };
    let options = |frames| RunOptions::new(&scene).with_device(device.clone()).with_frames(frames);
    let last = |run: &mut Run| {
        let frames = run.filter_map(|event| match event.unwrap() {
            Event::Frame(frame) => Some(frame),
            _ => None,
        });
        frames.last().unwrap().foam.unwrap()
    };
    let mut first = Run::new(&scene, options(early)).unwrap();
    let before = last(&mut first);
    let checkpoint = first.checkpoint().unwrap();
    let whole = last(&mut Run::new(&scene, options(late)).unwrap());
    let resumed = last(&mut Run::resume(&checkpoint, &scene, options(late)).unwrap());
    assert!(whole.len() > 100, "{}", whole.len());
    assert_eq!(resumed, whole);
    assert_ne!(before, whole);
}

#[test]
fn spray_is_ballistic() {
    let scene = scene(CALM);
    let (mut simulation, mut foam) = cpu(&scene);
    put(&mut simulation, &foam, [0.02, 0.45, 0.06], [0.7, 1.0, 0.0], DiffuseKind::Spray);
    for frame in 1..=10 {
        simulation.advance(0.02).unwrap();
        simulation.advance_foam(&foam).unwrap();
        let t = 0.02 * frame as f32;
        let diffuse = simulation.diffuse(&mut foam).unwrap();
        assert_eq!(diffuse.kinds, [DiffuseKind::Spray]);
        let [x, y, z] = diffuse.positions[0];
        let expected = [0.02 + 0.7 * t, 0.45 + t - 0.5 * 9.81 * t * t, 0.06];
        // Rounding of the time, 1e-7 s at a few m/s.
        let off = (x - expected[0]).abs().max((y - expected[1]).abs()).max((z - expected[2]).abs());
        assert!(off < 1e-5, "{off} m at {t} s");
        // Negative control: the error of the explicit Euler method is g dt t / 2.
        assert!(off < 0.1 * 0.5 * 9.81 * 0.02 * t);
    }
}

#[test]
fn bodies_stop_spray() {
    // A slab above the water, whose upper side is at 0.42 m.
    let slab = "[[body]]\nname = \"slab\"\nmesh = \"cube\"\nscale = [0.16, 0.06, 0.1]\nposition = [0.1, 0.39, 0.0625]\n";
    let last = |scene: &Scene, executor: Executor| {
        let (mut simulation, mut foam) = start(scene, executor);
        put(&mut simulation, &foam, [0.1, 0.5, 0.06], [0.1, -1.0, 0.0], DiffuseKind::Spray);
        for _ in 0..25 {
            simulation.advance(0.005).unwrap();
            simulation.advance_foam(&foam).unwrap();
        }
        let diffuse = simulation.diffuse(&mut foam).unwrap();
        (diffuse.positions[0], diffuse.velocities[0], diffuse.lifetimes[0])
    };
    let (with, without) = (scene(&format!("{CALM}{slab}")), scene(CALM));
    let mut executors: Vec<Executor> = vec![CpuExecutor::new().into()];
    executors.extend(testing::gpu_or_skip("bodies_stop_spray").map(|gpu| GpuExecutor::new(gpu).into()));
    for executor in executors {
        let ([x, y, _], [u, v, _], left) = last(&with, executor);
        // It slides on the slab, and ages.
        assert!((y - 0.42).abs() < 0.003 && v.abs() < 0.1, "{y} m, {v} m/s");
        assert!((x - 0.1125).abs() < 0.002 && (u - 0.1).abs() < 1e-3, "{x} m, {u} m/s");
        assert!(left < 0.99, "{left} s left");
    }
    // Control: without the slab it falls on.
    assert!(last(&without, CpuExecutor::new().into()).0[1] < 0.4);
}

#[test]
fn bubbles_rise_and_become_foam() {
    let scene = scene(CALM);
    let (mut simulation, mut foam) = cpu(&scene);
    put(&mut simulation, &foam, [0.1, 0.06, 0.06], [0.0; 3], DiffuseKind::Bubble);
    let mut heights = vec![0.06];
    for _ in 0..60 {
        simulation.advance(0.02).unwrap();
        simulation.advance_foam(&foam).unwrap();
        let diffuse = simulation.diffuse(&mut foam).unwrap();
        heights.push(diffuse.positions[0][1]);
        if diffuse.kinds[0] != DiffuseKind::Bubble {
            break;
        }
    }
    // The terminal velocity in water at rest is buoyancy g / drag = 0.245 m/s.
    let speed = (heights[15] - heights[5]) / 0.2;
    assert!((speed - 0.245).abs() < 0.04, "{speed} m/s: {heights:?}");
    let diffuse = simulation.diffuse(&mut foam).unwrap();
    assert_eq!(diffuse.kinds, [DiffuseKind::Foam], "{heights:?}");
    let top = heights[heights.len() - 1];
    assert!((0.26..0.33).contains(&top), "the surface is at 0.3 m: {top}");
    // It remains at the surface and dissolves after its lifetime of one second.
    let mut lived = 0;
    while !simulation.diffuse(&mut foam).unwrap().is_empty() {
        simulation.advance(0.1).unwrap();
        simulation.advance_foam(&foam).unwrap();
        lived += 1;
        assert!(lived < 20, "foam does not dissolve");
    }
    assert!((8..=12).contains(&lived), "{lived} tenths of a second");
}

#[test]
fn a_full_pool_accepts_candidates_evenly_and_reports_it() {
    let mut scene = foaming_column();
    let (mut simulation, mut foam) = cpu(&scene);
    advance(&mut simulation, &foam, 30);
    let free = simulation.diffuse(&mut foam).unwrap();
    assert_eq!(simulation.take_warnings(), Vec::<String>::new());

    scene.foam.max_particles = Some(200);
    let (mut simulation, mut foam) = cpu(&scene);
    advance(&mut simulation, &foam, 30);
    let few = simulation.diffuse(&mut foam).unwrap();
    assert!(few.len() <= 200 && few.len() > 150, "{}", few.len());
    let state = state(&mut simulation, &foam);
    assert!(state.refused > 100 && free.len() > 600, "{state:?}, {}", free.len());
    let warnings = simulation.take_warnings();
    assert!(warnings.len() == 1 && warnings[0].contains("pool of 200"), "{warnings:?}");
    simulation.diffuse(&mut foam).unwrap();
    assert_eq!(simulation.take_warnings(), Vec::<String>::new(), "the warning is reported once");
    // Saved foam, for example in a checkpoint, includes that the warning was reported.
    let saved = block_on(simulation.keep_foam_async(&foam)).unwrap();
    let mut again = simulation.foam(&scene.foam).unwrap();
    simulation.restore_foam(&mut again, &saved).unwrap();
    simulation.diffuse(&mut again).unwrap();
    assert_eq!(simulation.take_warnings(), Vec::<String>::new());
}
