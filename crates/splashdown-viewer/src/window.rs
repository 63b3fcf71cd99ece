//! The desktop window.

use std::sync::Arc;

use egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use splashdown::Checkpoint;
use splashdown::scene::Scene;
use splashdown_gpu::{DeviceRequest, Gpu, MISSING_DRIVER_HINT};

use crate::engine::Simulate;
use crate::{Viewer, ViewerError};

/// The options of the window.
pub struct ViewOptions {
    /// The initial scene.
    pub scene: Scene,
    /// The checkpoint to resume from; `scene` is then its scene.
    pub checkpoint: Option<Checkpoint>,
    /// The device that draws.
    pub device: DeviceRequest,
    /// Which device simulates. `None`: the one that draws, unless it is a software driver.
    pub simulate: Option<Simulate>,
    /// Width and height of the window in points.
    pub size: [f32; 2],
}

/// Opens the window and returns when it is closed.
///
/// # Errors
/// [`ViewerError::NoDisplay`] and [`ViewerError::NoWindow`], without a display or a driver.
pub fn view(options: ViewOptions) -> Result<(), ViewerError> {
    let unset = |name: &str| std::env::var_os(name).is_none_or(|value| value.is_empty());
    if cfg!(target_os = "linux") && ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().all(unset) {
        return Err(ViewerError::NoDisplay);
    }
    let ViewOptions { scene, checkpoint, device, simulate, size } = options;
    let title = format!("Splashdown - {}", scene.name);
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_inner_size(size)
            .with_title(title)
            .with_drag_and_drop(true),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: wgpu_options(device),
        ..eframe::NativeOptions::default()
    };
    let create = move |context: &eframe::CreationContext<'_>| {
        let render_state = context.wgpu_render_state.as_ref().ok_or("the window has no device")?;
        let mut viewer = Viewer::new(&context.egui_ctx, render_state, scene, simulate)?;
        if let Some(checkpoint) = checkpoint {
            viewer.resume(checkpoint)?;
        }
        Ok(Box::new(viewer) as Box<dyn eframe::App>)
    };
    eframe::run_native("splashdown", native, Box::new(create)).map_err(|error| ViewerError::NoWindow {
        reason: error.to_string().trim_end_matches('.').to_owned(),
        hint: MISSING_DRIVER_HINT,
    })
}

/// A device with the capabilities of its adapter: buffers as large as the memory allows, and timestamps for passes.
fn wgpu_options(device: DeviceRequest) -> WgpuConfiguration {
    let choose = move |adapters: &[wgpu::Adapter], surface: Option<&wgpu::Surface<'_>>| {
        let shows =
            |adapter: &&wgpu::Adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface));
        Gpu::choose(adapters.iter().filter(shows), &device).cloned().map_err(|error| error.to_string())
    };
    let defaults = WgpuSetupCreateNew::without_display_handle();
    let setup = WgpuSetupCreateNew {
        instance_descriptor: wgpu::InstanceDescriptor {
            flags: splashdown_gpu::instance_flags(),
            ..defaults.instance_descriptor
        },
        native_adapter_selector: Some(Arc::new(choose)),
        device_descriptor: Arc::new(Gpu::descriptor),
        ..defaults
    };
    WgpuConfiguration { wgpu_setup: WgpuSetup::CreateNew(setup), ..WgpuConfiguration::default() }
}
