//! A device for pictures alone, where no simulation has opened one.

use crate::RenderError;
use wgpu::{
    AdapterInfo, Device, DeviceDescriptor, Features, Instance, InstanceDescriptor, Queue,
    RequestAdapterOptions,
};

/// Opens the best adapter there is for drawing without a window, a software one if need be.
///
/// # Errors
/// [`RenderError::NoAdapter`] if the system has no driver, with what to install;
/// [`RenderError::NoDevice`] if the driver refuses.
pub fn open_device() -> Result<(Device, Queue, AdapterInfo), RenderError> {
    let instance = Instance::new(InstanceDescriptor::new_without_display_handle_from_env());
    let options = RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        ..RequestAdapterOptions::default()
    };
    let adapter = pollster::block_on(instance.request_adapter(&options))
        .map_err(|error| RenderError::NoAdapter { reason: error.to_string() })?;
    let info = adapter.get_info();
    let descriptor = DeviceDescriptor {
        label: Some("pictures"),
        // To measure passes with, where there is a clock.
        required_features: adapter.features() & Features::TIMESTAMP_QUERY,
        // Everything the adapter has: pictures and meshes may be large.
        required_limits: adapter.limits(),
        ..DeviceDescriptor::default()
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
        .map_err(|error| RenderError::NoDevice { adapter: info.name.clone(), reason: error.to_string() })?;
    Ok((device, queue, info))
}
