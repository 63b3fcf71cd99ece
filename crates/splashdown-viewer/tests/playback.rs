//! Playing a small run: frames are read in the background, what cannot be read is left out, and frames are drawn.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use splashdown::Device;
use splashdown::scene::{Format, Scene};
use splashdown_gpu::testing;
use splashdown_render::UploadedParticles;
use splashdown_run::{PlayedFrame, RunFrames, RunRequest, RunSettings, Stop, run};
use splashdown_viewer::engine::Drawn;
use splashdown_viewer::playback::{MEMORY, Playback};
use splashdown_viewer::timeline::Timeline;

type Outcome = Result<(), Box<dyn std::error::Error>>;

const SCENE: &str = r#"
[scene]
name = "small"
duration = 0.02
frame_rate = 500
[domain]
min = [0, 0, 0]
max = [0.6, 0.6, 0.3]
[fluid]
particle_spacing = 0.05
[[fluid.block]]
position = [0, 0, 0]
size = [0.3, 0.3, 0.3]
"#;

/// A run of eleven frames in this folder.
fn finish(out: &Path) -> Outcome {
    let mut settings = RunSettings::default();
    settings.device = Some(Device::Cpu);
    settings.pictures = Some(Vec::new());
    settings.formats = Some(vec![Format::Ply]);
    settings.checkpoint_every = Some(5);
    let mut request = RunRequest::new(Scene::parse(SCENE, "small.toml")?, settings);
    request.out = Some(out.to_owned());
    let outcome = run(request, &mut (), &|| Stop::No)?;
    assert_eq!(outcome.complete_frames, 11);
    Ok(())
}

/// Waits for the current frame; returns it with the messages until then.
fn wait(playback: &mut Playback, timeline: &mut Timeline) -> (Arc<PlayedFrame>, Vec<String>) {
    let (begun, mut messages) = (Instant::now(), Vec::new());
    loop {
        messages.extend(playback.update(timeline));
        if let Some(frame) = playback.frame(timeline.current()) {
            return (frame, messages);
        }
        assert!(begun.elapsed() < Duration::from_secs(30), "frame {} was not read", timeline.current());
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_run_plays_in_order_and_loops() -> Outcome {
    let folder = tempfile::tempdir()?;
    finish(folder.path())?;
    let run = RunFrames::open(folder.path(), None)?;
    let (mut playback, mut timeline, problem) = Playback::start(run, MEMORY, || {})?;
    assert_eq!(problem, None);
    assert!(timeline.can_continue && timeline.has_particles && timeline.has_meshes);
    assert_eq!(timeline.range(), (0, 10));
    let mut shown = Vec::new();
    for tick in 0..24 {
        let (frame, messages) = wait(&mut playback, &mut timeline);
        assert_eq!(messages, [""; 0]);
        assert_eq!(frame.number, timeline.current());
        shown.push(frame.number);
        timeline.tick(0.002 * f64::from(tick) + 1e-5, true);
    }
    // The first tick starts the clock.
    let expected: Vec<u32> = (0..23).map(|number| number % 11).collect();
    assert_eq!(shown[1..], expected);
    Ok(())
}

#[test]
fn memory_is_bounded_and_every_frame_can_still_be_reached() -> Outcome {
    let folder = tempfile::tempdir()?;
    finish(folder.path())?;
    let bytes = RunFrames::open(folder.path(), None)?.read(0)?.bytes();
    let run = RunFrames::open(folder.path(), None)?;
    let (mut playback, mut timeline, _) = Playback::start(run, 4 * bytes, || {})?;
    for number in [10, 0, 5, 9, 1] {
        timeline.seek(number);
        assert_eq!(wait(&mut playback, &mut timeline).0.number, number);
    }
    std::thread::sleep(Duration::from_millis(300));
    playback.update(&mut timeline);
    let in_memory: Vec<u32> = (0..=10).filter(|&number| playback.frame(number).is_some()).collect();
    assert!((2..=4).contains(&in_memory.len()) && in_memory.contains(&1), "{in_memory:?}");
    Ok(())
}

#[test]
fn frames_that_cannot_be_read_are_left_out_and_reported_once() -> Outcome {
    let folder = tempfile::tempdir()?;
    finish(folder.path())?;
    for name in ["particles/particles", "mesh/surface"] {
        fs::remove_file(folder.path().join(format!("{name}_0002.ply")))?;
        for number in [4, 6] {
            let path = folder.path().join(format!("{name}_{number:04}.ply"));
            let bytes = fs::read(&path)?;
            fs::write(&path, &bytes[..bytes.len() / 3])?;
        }
    }
    let run = RunFrames::open(folder.path(), None)?;
    let (mut playback, mut timeline, problem) = Playback::start(run, MEMORY, || {})?;
    assert!(problem.as_ref().is_some_and(|problem| problem.ends_with("frame 2 missing")), "{problem:?}");
    let mut reported = Vec::new();
    let mut shown = Vec::new();
    timeline.playing = false;
    for _ in 0..9 {
        let (frame, messages) = wait(&mut playback, &mut timeline);
        reported.extend(messages);
        if shown.last() != Some(&frame.number) {
            shown.push(frame.number);
        }
        timeline.step(1);
    }
    assert_eq!(shown, [0, 1, 3, 5, 7, 8, 9, 10]);
    assert_eq!(timeline.left_out, [4, 6]);
    assert!(reported.len() == 1 && reported[0].contains("_0004.ply"), "{reported:?}");
    Ok(())
}

#[test]
fn a_run_without_a_readable_frame_ends_without_a_picture() -> Outcome {
    let folder = tempfile::tempdir()?;
    finish(folder.path())?;
    for entry in
        ["particles", "mesh"].into_iter().flat_map(|name| fs::read_dir(folder.path().join(name))).flatten()
    {
        fs::write(entry?.path(), "ply")?;
    }
    let run = RunFrames::open(folder.path(), None)?;
    let (mut playback, mut timeline, _) = Playback::start(run, MEMORY, || {})?;
    let (begun, mut reported) = (Instant::now(), Vec::new());
    while timeline.left_out.len() < 10 {
        reported.extend(playback.update(&mut timeline));
        assert!(begun.elapsed() < Duration::from_secs(30), "{timeline:?}");
    }
    std::thread::sleep(Duration::from_millis(100));
    reported.extend(playback.update(&mut timeline));
    assert_eq!((reported.len(), timeline.len(), timeline.playing), (1, 1, false), "{reported:?}");
    assert!(playback.frame(timeline.current()).is_none());
    Ok(())
}

#[test]
fn a_frame_is_uploaded_with_all_that_it_has() -> Outcome {
    let Some(gpu) = testing::gpu_or_skip("a_frame_is_uploaded_with_all_that_it_has") else { return Ok(()) };
    let folder = tempfile::tempdir()?;
    finish(folder.path())?;
    let mut frame = RunFrames::open(folder.path(), None)?.read(3)?;
    let particles = frame.particles.clone().ok_or("no particles")?;
    let triangles = frame.mesh.as_ref().ok_or("no mesh")?.len();
    let drawn = Drawn::of_frame(&gpu.device, &frame)?;
    assert_eq!(drawn.particles().count as usize, particles.len());
    assert_eq!(drawn.mesh().ok_or("no mesh")?.stats.triangles as usize, triangles);
    frame.particles = None;
    let without = Drawn::of_frame(&gpu.device, &frame)?;
    assert!(without.particles().count == 0 && without.mesh().is_some());
    // Arrays that do not fit together are refused.
    let positions = &particles.positions;
    assert!(UploadedParticles::new(&gpu.device, positions, &particles.velocities[1..], &[], &[]).is_err());
    Ok(())
}
