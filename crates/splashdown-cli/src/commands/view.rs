//! `splashdown view`: the window.

use splashdown::{Checkpoint, Device};
use splashdown_gpu::DeviceRequest;
use splashdown_run::find_checkpoint;
use splashdown_viewer::ViewOptions;
use splashdown_viewer::engine::Simulate;

use crate::args::ViewArguments;
use crate::exit::Failure;
use crate::scene_file;

/// Opens the window; returns when it is closed.
///
/// # Errors
/// The scene's problems; no display or no driver.
pub fn view(arguments: &ViewArguments) -> Result<(), Failure> {
    let path = &arguments.scene;
    let is_checkpoint = path.is_dir() || path.extension().is_some_and(|ending| ending == Checkpoint::ENDING);
    let checkpoint = if is_checkpoint { Some(find_checkpoint(path)?.checkpoint) } else { None };
    let scene = match &checkpoint {
        Some(checkpoint) => checkpoint.scene()?,
        None => scene_file::load(path)?,
    };
    // Drawing needs a GPU or a software driver even if the CPU simulates.
    let (device, simulate) = match &arguments.device.device {
        Device::Auto => (DeviceRequest::Auto, None),
        Device::Cpu => (DeviceRequest::Auto, Some(Simulate::OnCpu)),
        Device::Gpu => (DeviceRequest::Hardware, Some(Simulate::WhereDrawn)),
        Device::Named(name) => (DeviceRequest::Named(name.clone()), Some(Simulate::WhereDrawn)),
    };
    Ok(splashdown_viewer::view(ViewOptions { scene, checkpoint, device, simulate, size: arguments.size })?)
}
