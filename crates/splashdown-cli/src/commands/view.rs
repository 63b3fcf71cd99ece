//! `splashdown view`: the window.

use std::path::Path;

use splashdown::{Checkpoint, Device};
use splashdown_gpu::DeviceRequest;
use splashdown_run::{RunFrames, find_checkpoint};
use splashdown_viewer::engine::Simulate;
use splashdown_viewer::{Start, ViewOptions};

use crate::args::ViewArguments;
use crate::exit::{Exit, Failure};
use crate::scene_file;

/// Opens the window; returns when it is closed.
///
/// # Errors
/// The scene's problems; no display or no driver.
pub fn view(arguments: &ViewArguments) -> Result<(), Failure> {
    let start = start(&arguments.path, arguments.scene.as_deref())?;
    // Drawing needs a GPU or a software driver even if the CPU simulates.
    let (device, simulate) = match &arguments.device.device {
        Device::Auto => (DeviceRequest::Auto, None),
        Device::Cpu => (DeviceRequest::Auto, Some(Simulate::OnCpu)),
        Device::Gpu => (DeviceRequest::Hardware, Some(Simulate::WhereDrawn)),
        Device::Named(name) => (DeviceRequest::Named(name.clone()), Some(Simulate::WhereDrawn)),
    };
    Ok(splashdown_viewer::view(ViewOptions { start, device, simulate, size: arguments.size })?)
}

/// A folder with frames is played. A checkpoint, or a folder with checkpoints only, is continued.
fn start(path: &Path, scene: Option<&Path>) -> Result<Start, Failure> {
    if path.is_dir() && RunFrames::exist_in(path) {
        let scene = scene.map(scene_file::load).transpose()?;
        return Ok(Start::Run(RunFrames::open(path, scene)?));
    }
    if scene.is_some() {
        let message = format!(
            "--scene names the scene of a run that is played, and `{}` is not a folder with frames",
            path.display()
        );
        return Err(Failure::new(Exit::Usage, message));
    }
    let is_checkpoint = path.is_dir() || path.extension().is_some_and(|ending| ending == Checkpoint::ENDING);
    Ok(match is_checkpoint {
        true => Start::Checkpoint(find_checkpoint(path)?.checkpoint),
        false => Start::Scene(scene_file::load(path)?),
    })
}
