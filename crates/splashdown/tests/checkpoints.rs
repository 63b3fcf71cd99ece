//! A run that is resumed from a checkpoint is bit-identical to an uninterrupted run.

use splashdown::error::CheckpointError;
use splashdown::scene::Scene;
use splashdown::{Checkpoint, Device, Simulation, SimulationError};
use splashdown_gpu::testing::gpu_or_skip;
use splashdown_gpu::{Executor, GpuExecutor};
use splashdown_io::Particles;
use std::sync::Arc;

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Everything with a state: free bodies that collide with each other and the domain, a scripted body, an emitter,
/// a sink and probes.
const EVERYTHING: &str = r#"
[scene]
name = "everything"
duration = 0.4
frame_rate = 50.0

[domain]
min = [0.0, 0.0, 0.0]
max = [0.3, 0.3, 0.3]

[fluid]
particle_spacing = 0.02

[[fluid.block]]
position = [0.0, 0.0, 0.0]
size = [0.3, 0.06, 0.3]

[[body]]
name = "low"
mesh = "sphere"
scale = 0.06
position = [0.12, 0.1, 0.15]
motion = "dynamic"
density = 300.0

[[body]]
name = "high"
mesh = "cube"
scale = 0.05
position = [0.13, 0.17, 0.15]
motion = "dynamic"
density = 600.0

[[body]]
name = "mouse_force"
mesh = "cube"
scale = 0.05
position = [0.24, 0.06, 0.06]
motion = "scripted"
turn = ["0", "300*t", "0"]

[[emitter]]
name = "tap"
shape = "disc"
radius = 0.03
position = [0.06, 0.2, 0.24]
direction = [0.0, -1.0, 0.0]
speed = 0.8

[[sink]]
name = "drain"
min = [0.25, 0.0, 0.25]
max = [0.3, 0.03, 0.3]

[[probe]]
name = "wall"
position = [0.0, 0.02, 0.15]
quantity = "pressure"

[[probe]]
name = "low"
quantity = "body"
body = "low"
interval = 0.005
"#;

fn step(simulation: &mut Simulation) -> Result<(Particles, Vec<splashdown::BodyState>), SimulationError> {
    simulation.advance(0.02)?;
    Ok((simulation.particles()?, simulation.body_states()?))
}

fn cpu() -> Result<Executor, SimulationError> {
    Ok(Device::Cpu.executor()?)
}

/// Runs twelve frames, eight of them after a checkpoint, with and without resuming from it.
fn assert_bit_identical(scene: &Scene, executor: &dyn Fn() -> Result<Executor, SimulationError>) -> Outcome {
    let mut straight = Simulation::with_executor(scene, executor()?)?;
    let mut stopped = Simulation::with_executor(scene, executor()?)?;
    for _ in 0..4 {
        step(&mut straight)?;
        step(&mut stopped)?;
    }
    straight.take_probe_rows();
    let bytes = stopped.checkpoint(&scene.text)?.to_bytes()?;
    let at_checkpoint = stopped.particles()?;
    drop(stopped);
    let mut resumed = Simulation::resume(&Checkpoint::from_bytes(&bytes)?, executor()?)?;
    assert!(resumed.particles()? == at_checkpoint, "the particles of the checkpoint");
    assert_eq!(resumed.stats(), straight.stats());
    for frame in 0..8 {
        let (one, other) = (step(&mut straight)?, step(&mut resumed)?);
        assert_eq!(one.1, other.1, "bodies, {frame} frames after the checkpoint");
        assert!(one.0 == other.0, "particles, {frame} frames after the checkpoint");
    }
    assert_eq!(straight.stats(), resumed.stats());
    assert_eq!(straight.take_probe_rows(), resumed.take_probe_rows());
    Ok(())
}

#[test]
fn a_resumed_run_is_bit_identical_on_the_cpu() -> Outcome {
    let scene = Scene::parse(EVERYTHING, "everything")?;
    assert_bit_identical(&scene, &cpu)?;

    // Control: velocities that differ in their last bit change the result of a frame.
    let mut simulation = Simulation::new(&scene, &Device::Cpu)?;
    step(&mut simulation)?;
    let mut bytes = simulation.checkpoint(&scene.text)?.to_bytes()?;
    let (plain, _) =
        step(&mut Simulation::resume(&Checkpoint::from_bytes(&bytes)?, Device::Cpu.executor()?)?)?;
    let zip = splashdown_io::Archive::from_bytes(&bytes)?;
    let mut velocities = zip.array::<f32>("velocities")?;
    for x in velocities.iter_mut().step_by(4) {
        *x = f32::from_bits(x.to_bits() ^ 1);
    }
    let mut other = zip;
    other.set_array("velocities", &velocities, 4);
    bytes = other.to_bytes()?;
    let (nudged, _) =
        step(&mut Simulation::resume(&Checkpoint::from_bytes(&bytes)?, Device::Cpu.executor()?)?)?;
    assert!(plain != nudged, "a change of the last bit has no effect");
    Ok(())
}

#[test]
fn a_resumed_run_is_bit_identical_on_an_adapter() -> Outcome {
    let scene = Scene::parse(EVERYTHING, "everything")?;
    match gpu_or_skip("a_resumed_run_is_bit_identical_on_an_adapter") {
        Some(gpu) => assert_bit_identical(&scene, &|| Ok(GpuExecutor::new(Arc::clone(&gpu)).into())),
        None => Ok(()),
    }
}

#[test]
fn a_resumed_run_is_bit_identical_with_other_solvers() -> Outcome {
    for extra in [
        "[solver]\nmethod = \"mueller2003\"\n",
        "[solver]\ndensity = \"summation\"\n",
        "[solver]\nmethod = \"dfsph\"\n",
    ] {
        let scene = Scene::parse(&format!("{EVERYTHING}\n{extra}"), "everything")?;
        assert_bit_identical(&scene, &cpu)?;
    }
    Ok(())
}

#[test]
fn invalid_checkpoints_are_rejected_with_a_reason() -> Outcome {
    let scene = Scene::parse(EVERYTHING, "everything")?;
    let mut simulation = Simulation::new(&scene, &Device::Cpu)?;
    let checkpoint = simulation.checkpoint(&scene.text)?;
    let bytes = checkpoint.to_bytes()?;
    let refused = |bytes: &[u8]| match Checkpoint::from_bytes(bytes) {
        Ok(_) => String::new(),
        Err(error) => error.to_string(),
    };
    assert!(refused(&bytes[..bytes.len() / 2]).contains("cut short"));
    assert!(refused(b"[scene]\n").contains("not a usable checkpoint"));
    let mut foreign = splashdown_io::Archive::default();
    foreign.set_array("positions", &[0.0_f32; 12], 4);
    assert!(refused(&foreign.to_bytes()?).contains("about.json"));

    // Checkpoints of another version or another scene.
    let mut other = splashdown_io::Archive::from_bytes(&bytes)?;
    other.set_text("about.json", &other.text("about.json")?.replace("\"version\": 10", "\"version\": 11"));
    assert!(refused(&other.to_bytes()?).contains("format 11"));
    let mut other = splashdown_io::Archive::from_bytes(&bytes)?;
    other.set_text(
        "scene.toml",
        &EVERYTHING.replace("scale = 0.05\nposition = [0.13", "scale = 0.04\nposition = [0.13"),
    );
    let changed = Checkpoint::from_bytes(&other.to_bytes()?)?;
    let message = Simulation::resume(&changed, Device::Cpu.executor()?).err().map(|error| error.to_string());
    assert!(message.is_some_and(|message| message.contains("high")));
    let mut other = splashdown_io::Archive::from_bytes(&bytes)?;
    other.set_array("ids", &[1_u32, 2], 1);
    let short = Checkpoint::from_bytes(&other.to_bytes()?)?;
    let message = Simulation::resume(&short, Device::Cpu.executor()?).err().map(|error| error.to_string());
    assert!(message.is_some_and(|message| message.contains("ids")));

    // A folder is an I/O error.
    let folder = std::env::temp_dir();
    assert!(matches!(Checkpoint::read(&folder), Err(CheckpointError::Io(_))));
    Ok(())
}
