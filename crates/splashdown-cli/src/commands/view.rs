//! `splashdown view`: the window.

use splashdown::Device;
use splashdown_gpu::DeviceRequest;
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
    let (scene, text) = scene_file::load_with_text(&arguments.scene)?;
    // The CPU cannot show anything: something has to draw.
    let (device, simulate) = match &arguments.device.device {
        Device::Auto => (DeviceRequest::Auto, None),
        Device::Cpu => (DeviceRequest::Auto, Some(Simulate::OnCpu)),
        Device::Gpu => (DeviceRequest::Hardware, Some(Simulate::WhereDrawn)),
        Device::Named(name) => (DeviceRequest::Named(name.clone()), Some(Simulate::WhereDrawn)),
    };
    Ok(splashdown_viewer::view(ViewOptions { scene, text, device, simulate, size: arguments.size })?)
}
