//! The effects of commands to the engine, without a window, on software Vulkan.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::Vec3;
use splashdown::scene::Scene;
use splashdown_gpu::{Gpu, testing};
use splashdown_render::Camera;
use splashdown_viewer::engine::{Command, Engine, Message, Purpose, Simulate, Snapshot};
use splashdown_viewer::look::{DisplayMode, Look};
use splashdown_viewer::picture::Picture;

const SCENE: &str = r#"
[scene]
name = "small"
duration = 2
[domain]
min = [0, 0, 0]
max = [1, 0.6, 0.3]
[fluid]
particle_spacing = 0.05
[[fluid.block]]
position = [0, 0, 0]
size = [0.4, 0.4, 0.3]
[solver]
sound_speed = 10
"#;

fn scene() -> Scene {
    Scene::parse(SCENE, "small.toml").unwrap()
}

/// The first snapshot that satisfies the condition, and the messages until then.
fn until(engine: &mut Engine, wanted: impl Fn(&Snapshot) -> bool) -> (Arc<Snapshot>, Vec<Message>) {
    let (begun, mut messages) = (Instant::now(), Vec::new());
    loop {
        messages.extend(engine.take_messages());
        if let Some(snapshot) = engine.snapshot().filter(|snapshot| wanted(snapshot)) {
            return (snapshot, messages);
        }
        engine.picture_drawn();
        assert!(begun.elapsed() < Duration::from_secs(60), "no such snapshot");
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn start(gpu: &Arc<Gpu>, simulate: Simulate) -> Engine {
    let engine = Engine::start(Arc::clone(gpu), simulate, || {});
    engine.send(Command::Open(Box::new(scene())));
    engine
}

#[test]
fn the_engine_plays_pauses_steps_and_restarts() {
    let Some(gpu) = testing::gpu_or_skip("the_engine_plays_pauses_steps_and_restarts") else { return };
    for simulate in [Simulate::OnCpu, Simulate::WhereDrawn] {
        let mut engine = start(&gpu, simulate);
        let (first, _) = until(&mut engine, |_| true);
        assert_eq!((first.stats.time, first.stats.particles), (0.0, 8 * 8 * 6));
        engine.send(Command::Play(true));
        until(&mut engine, |now| now.stats.time > 0.02);
        engine.send(Command::Play(false));
        let (paused, _) = until(&mut engine, |now| !now.playing);
        std::thread::sleep(Duration::from_millis(100));
        assert_eq!(engine.snapshot().unwrap().stats.time, paused.stats.time);
        engine.send(Command::Advance(0.01));
        let (stepped, _) = until(&mut engine, |now| now.stats.time > paused.stats.time);
        assert!((stepped.stats.time - paused.stats.time - 0.01).abs() < 1e-4);
        engine.send(Command::Open(Box::new(scene())));
        let (reset, _) = until(&mut engine, |now| now.stats.time == 0.0);
        assert_eq!(reset.stats.particles, first.stats.particles);
    }
}

#[test]
fn a_failure_is_reported_and_the_next_scene_runs() {
    let Some(gpu) = testing::gpu_or_skip("a_failure_is_reported_and_the_next_scene_runs") else { return };
    let mut engine = start(&gpu, Simulate::OnCpu);
    until(&mut engine, |_| true);
    let mut broken = scene();
    broken.domain.max = Vec3::splat(1e6);
    let mut larger = scene();
    larger.fluid.particle_spacing = 0.04;
    engine.send(Command::Open(Box::new(broken)));
    engine.send(Command::Play(true));
    engine.send(Command::Open(Box::new(larger)));
    engine.send(Command::Play(true));
    let (_, messages) = until(&mut engine, |now| now.stats.time > 0.01 && now.stats.particles > 8 * 8 * 6);
    assert!(
        messages.iter().any(|message| matches!(message, Message::Failed(text) if text.contains("cells")))
    );
}

/// The window shows the old scene as paused then, and continues only when the user asks for it.
#[test]
fn after_a_failure_the_scene_that_is_shown_can_be_played() {
    let Some(gpu) = testing::gpu_or_skip("after_a_failure_the_scene_that_is_shown_can_be_played") else {
        return;
    };
    let mut engine = start(&gpu, Simulate::OnCpu);
    engine.send(Command::Play(true));
    until(&mut engine, |now| now.stats.time > 0.01);
    let mut broken = scene();
    broken.domain.max = Vec3::splat(1e6);
    engine.send(Command::Open(Box::new(broken)));
    engine.send(Command::Play(true));
    let begun = Instant::now();
    while !engine.take_messages().iter().any(|message| matches!(message, Message::Failed(_))) {
        assert!(begun.elapsed() < Duration::from_secs(60), "no failure");
    }
    let time = engine.snapshot().unwrap().stats.time;
    std::thread::sleep(Duration::from_millis(300));
    assert_eq!(
        engine.snapshot().unwrap().stats.time,
        time,
        "the command of the broken scene plays the old one"
    );
    engine.send(Command::Play(true));
    until(&mut engine, |now| now.playing && now.stats.time > 0.0 && now.stats.time != time);
}

fn picture(gpu: &Arc<Gpu>, engine: &Engine, mode: DisplayMode) -> Vec<u8> {
    let mut picture = Picture::new(Arc::clone(gpu)).unwrap();
    let snapshot = engine.snapshot().unwrap();
    let camera = Camera::orbit([0.5, 0.2, 0.15], 1.6, 20.0, 20.0, 35.0);
    let look = Look { mode, ..Look::default() };
    picture.draw([160, 90], &snapshot, &look, camera).unwrap();
    picture.read().unwrap()
}

#[test]
fn a_refused_change_leaves_the_simulation_as_it_is() {
    let Some(gpu) = testing::gpu_or_skip("a_refused_change_leaves_the_simulation_as_it_is") else { return };
    let mut engine = start(&gpu, Simulate::OnCpu);
    engine.send(Command::Play(true));
    until(&mut engine, |now| now.playing && now.stats.time > 0.02);
    let mut broken = scene();
    broken.domain.max = Vec3::splat(1e6);
    engine.send(Command::Change(Box::new(broken)));
    let (begun, mut refused) = (Instant::now(), false);
    while !refused {
        refused = engine.take_messages().iter().any(|message| matches!(message, Message::Refused(_)));
        assert!(begun.elapsed() < Duration::from_secs(60), "nothing was refused");
    }
    let time = engine.snapshot().unwrap().stats.time;
    let (later, _) = until(&mut engine, |now| now.stats.time > time);
    assert!(later.playing);
    assert_eq!(later.opened.scene, scene());
    engine.send(Command::Open(Box::new(scene())));
    until(&mut engine, |now| now.stats.time < time);
}

/// A camera may be moved into the water.
#[test]
fn a_camera_inside_the_water_draws_every_view() {
    let Some(gpu) = testing::gpu_or_skip("a_camera_inside_the_water_draws_every_view") else { return };
    let mut engine = start(&gpu, Simulate::OnCpu);
    engine.send(Command::Surface(true));
    let (snapshot, _) = until(&mut engine, |now| now.drawn.mesh().is_some());
    let mut picture = Picture::new(Arc::clone(&gpu)).unwrap();
    let mut means = Vec::new();
    for mode in DisplayMode::ALL {
        let look = Look { mode, ..Look::default() };
        let mut mean = |camera: Camera| {
            picture.draw([160, 90], &snapshot, &look, camera).unwrap();
            let rgba = picture.read().unwrap();
            rgba.chunks_exact(4).map(|pixel| u64::from(pixel[1])).sum::<u64>() / (160 * 90)
        };
        // The eye is in the middle of the block of water.
        let inside = mean(Camera::orbit([0.25, 0.2, 0.15], 0.05, 90.0, 0.0, 35.0));
        let outside = mean(Camera::orbit([0.5, 0.2, 0.15], 1.6, 20.0, 20.0, 35.0));
        assert!(inside > 10, "{mode:?} is black inside the water: {inside}");
        means.push((inside, outside));
    }
    // Control: the pictures are those of two places.
    assert!(means.iter().any(|(inside, outside)| inside.abs_diff(*outside) > 5), "{means:?}");
}

/// Number of pixels with a clearly different colour.
fn differing(a: &[u8], b: &[u8]) -> usize {
    a.chunks_exact(4)
        .zip(b.chunks_exact(4))
        .filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 24))
        .count()
}

/// The bytes in use must not depend on the number of earlier surfaces.
#[test]
fn surfaces_that_are_not_needed_are_freed() {
    let Some(gpu) = testing::gpu_or_skip("surfaces_that_are_not_needed_are_freed") else { return };
    for simulate in [Simulate::OnCpu, Simulate::WhereDrawn] {
        let mut engine = start(&gpu, simulate);
        let (opened, _) = until(&mut engine, |_| true);
        let without = opened.opened.memory;
        engine.send(Command::Surface(true));
        let (shown, _) = until(&mut engine, |now| now.drawn.mesh().is_some());
        let with = shown.opened.memory;
        assert!(with > without + 10_000, "{with} bytes with a surface, {without} without");
        for round in 1..=12 {
            let mut changed = scene();
            changed.surface.smoothing_iterations = round % 4;
            changed.surface.iso_level = 0.5 + 0.01 * round as f32;
            for scene in [changed, scene()] {
                let settings = scene.surface.clone();
                engine.send(Command::Change(Box::new(scene)));
                let (now, _) = until(&mut engine, |now| now.opened.scene.surface == settings);
                assert!(now.drawn.mesh().is_some());
            }
            assert_eq!(engine.snapshot().unwrap().opened.memory, with, "after {round} changes");
        }
        engine.send(Command::Surface(false));
        let (hidden, _) = until(&mut engine, |now| now.drawn.mesh().is_none());
        assert_eq!(hidden.opened.memory, without);
        // An export needs the surface only for the mesh.
        engine.send(Command::Export);
        engine.send(Command::Advance(0.001));
        let time = hidden.stats.time;
        let (later, messages) = until(&mut engine, |now| now.stats.time > time);
        assert!(messages.iter().any(|message| matches!(message, Message::Exported(_))));
        assert_eq!(later.opened.memory, without);
        // Control: the surface is extracted again if it is wanted.
        engine.send(Command::Surface(true));
        let (again, _) = until(&mut engine, |now| now.drawn.mesh().is_some());
        assert_eq!(again.opened.memory, with);
    }
}

/// The surface of the CPU is copied. That of the GPU is drawn in place by an indirect call.
#[test]
fn both_devices_show_the_same_surface() {
    let Some(gpu) = testing::gpu_or_skip("both_devices_show_the_same_surface") else { return };
    let pictures = [Simulate::OnCpu, Simulate::WhereDrawn].map(|simulate| {
        let mut engine = start(&gpu, simulate);
        engine.send(Command::Surface(true));
        until(&mut engine, |now| now.drawn.mesh().is_some());
        picture(&gpu, &engine, DisplayMode::Surface)
    });
    assert!(differing(&pictures[0], &pictures[1]) < 20, "{}", differing(&pictures[0], &pictures[1]));
    // Control: without a surface the picture differs.
    let mut engine = start(&gpu, Simulate::OnCpu);
    until(&mut engine, |_| true);
    assert!(differing(&pictures[0], &picture(&gpu, &engine, DisplayMode::Surface)) > 200);
}

#[test]
fn isolated_particles_are_drawn_as_droplets() {
    let Some(gpu) = testing::gpu_or_skip("isolated_particles_are_drawn_as_droplets") else { return };
    for simulate in [Simulate::OnCpu, Simulate::WhereDrawn] {
        let mut engine = start(&gpu, simulate);
        engine.send(Command::Surface(true));
        let (shown, _) = until(&mut engine, |now| now.drawn.mesh().is_some());
        assert!(shown.drawn.droplets().is_none());
        let surface = picture(&gpu, &engine, DisplayMode::Surface);
        // With this limit all particles are isolated.
        let mut changed = scene();
        changed.surface.min_neighbours = 32;
        engine.send(Command::Change(Box::new(changed)));
        let (shown, _) = until(&mut engine, |now| now.drawn.droplets().is_some());
        assert_eq!(shown.drawn.droplets().map(|droplets| droplets.count), Some(shown.stats.particles));
        assert_eq!(shown.drawn.mesh().map(|mesh| mesh.stats.triangles), Some(0));
        let droplets = picture(&gpu, &engine, DisplayMode::Surface);
        assert!(differing(&surface, &droplets) > 200);
        // Control: neither surface nor droplets.
        engine.send(Command::Surface(false));
        until(&mut engine, |now| now.drawn.mesh().is_none() && now.drawn.droplets().is_none());
    }
}

#[test]
fn foam_is_computed_if_enabled_and_drawn_in_every_mode() {
    let Some(gpu) = testing::gpu_or_skip("foam_is_computed_if_enabled_and_drawn_in_every_mode") else {
        return;
    };
    let mut engine = start(&gpu, Simulate::OnCpu);
    until(&mut engine, |_| true);
    let advance = |engine: &Engine| (0..20).for_each(|_| engine.send(Command::Advance(0.02)));
    advance(&engine);
    let (without, _) = until(&mut engine, |now| now.stats.time > 0.39);
    assert!(without.drawn.foam().is_none());
    let mut foaming = scene();
    foaming.foam.enabled = true;
    engine.send(Command::Open(Box::new(foaming)));
    advance(&engine);
    let (with, _) = until(&mut engine, |now| now.stats.time > 0.39 && now.drawn.foam().is_some());
    assert!(with.drawn.foam().is_some_and(|foam| foam.count > 50), "{:?}", with.drawn.foam());
    for mode in DisplayMode::ALL.into_iter().filter(|mode| !mode.needs_surface()) {
        let drawn = picture(&gpu, &engine, mode);
        let mut picture = Picture::new(Arc::clone(&gpu)).unwrap();
        let camera = Camera::orbit([0.5, 0.2, 0.15], 1.6, 20.0, 20.0, 35.0);
        picture.draw([160, 90], &without, &Look { mode, ..Look::default() }, camera).unwrap();
        let other = picture.read().unwrap();
        let differing = drawn.chunks_exact(4).zip(other.chunks_exact(4)).filter(|(a, b)| a != b).count();
        assert!(differing > 20, "{mode:?} shows no foam: {differing} pixels");
    }
}

#[test]
fn every_display_mode_shows_the_water() {
    let Some(gpu) = testing::gpu_or_skip("every_display_mode_shows_the_water") else { return };
    let mut engine = start(&gpu, Simulate::OnCpu);
    engine.send(Command::Surface(true));
    until(&mut engine, |now| now.drawn.mesh().is_some());
    let pictures: Vec<_> = DisplayMode::ALL.into_iter().map(|mode| picture(&gpu, &engine, mode)).collect();
    for (i, a) in pictures.iter().enumerate() {
        for (j, b) in pictures.iter().enumerate().skip(i + 1) {
            assert!(
                differing(a, b) > 100,
                "{:?} and {:?} look alike",
                DisplayMode::ALL[i],
                DisplayMode::ALL[j]
            );
        }
        // Control: the same mode twice.
        assert_eq!(differing(a, &picture(&gpu, &engine, DisplayMode::ALL[i])), 0);
    }
}

#[test]
fn the_size_of_a_picture_is_limited_to_that_of_its_texture() {
    let Some(gpu) = testing::gpu_or_skip("the_size_of_a_picture_is_limited_to_that_of_its_texture") else {
        return;
    };
    let mut engine = start(&gpu, Simulate::OnCpu);
    let (snapshot, _) = until(&mut engine, |_| true);
    let limit = gpu.limits.max_texture_dimension_2d;
    let mut picture = Picture::new(Arc::clone(&gpu)).unwrap();
    for (size, drawn) in [([limit + 7, 2], [limit, 2]), ([0, 0], [1, 1]), ([64, 36], [64, 36])] {
        let camera = Camera::orbit([0.5, 0.2, 0.15], 1.6, 20.0, 20.0, 35.0);
        picture.draw(size, &snapshot, &Look::default(), camera).unwrap();
        assert_eq!(picture.texture_drawn().unwrap().1, drawn);
        let pixels = picture.read().expect("the device reads the whole texture");
        assert_eq!(pixels.len(), 4 * (drawn[0] * drawn[1]) as usize);
        gpu.health("the picture").unwrap();
    }
}

#[test]
fn a_checkpoint_restores_the_simulation() {
    let Some(gpu) = testing::gpu_or_skip("a_checkpoint_restores_the_simulation") else { return };
    let mut engine = start(&gpu, Simulate::OnCpu);
    engine.send(Command::Advance(0.05));
    let (then, _) = until(&mut engine, |now| now.stats.time > 0.04);
    engine.send(Command::Checkpoint(SCENE.to_owned(), Purpose::Export));
    engine.send(Command::Advance(0.05));
    let (later, messages) = until(&mut engine, |now| now.stats.time > 0.09);
    let checkpoint = messages.into_iter().find_map(|message| match message {
        Message::Checkpoint(checkpoint, Purpose::Export) => Some(checkpoint),
        _ => None,
    });
    engine.send(Command::Resume(checkpoint.unwrap()));
    let (back, _) = until(&mut engine, |now| now.stats.time < 0.06);
    assert_eq!(back.stats, then.stats);
    engine.send(Command::Advance(0.05));
    let (again, _) = until(&mut engine, |now| now.stats.time > 0.09);
    assert_eq!(again.stats, later.stats);
}
