//! The desktop window.

use std::sync::Arc;

use egui_wgpu::{SurfaceErrorAction, WgpuConfiguration, WgpuError, WgpuSetup, WgpuSetupCreateNew};
use splashdown::Checkpoint;
use splashdown::scene::Scene;
use splashdown_gpu::{DeviceRequest, Gpu, MISSING_DRIVER_HINT};
use splashdown_run::RunFrames;

use crate::app::title;
use crate::engine::Simulate;
use crate::{Viewer, ViewerError, opening};

/// What the window shows first.
pub enum Start {
    /// The simulation of a scene from its beginning.
    Scene(Scene),
    /// A simulation that continues from a checkpoint.
    Checkpoint(Checkpoint),
    /// The frames of a finished or interrupted run.
    Run(RunFrames),
}

/// The options of the window.
pub struct ViewOptions {
    /// What it shows first.
    pub start: Start,
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
/// [`ViewerError`]: the checkpoint cannot be used, or there is no display, no device or no driver.
pub fn view(options: ViewOptions) -> Result<(), ViewerError> {
    let scene = match &options.start {
        Start::Scene(scene) => scene.clone(),
        Start::Checkpoint(checkpoint) => {
            checkpoint.check()?;
            checkpoint.scene()?
        }
        Start::Run(run) => run.scene().clone(),
    };
    let unset = |name: &str| std::env::var_os(name).is_none_or(|value| value.is_empty());
    if cfg!(target_os = "linux") && ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().all(unset) {
        return Err(ViewerError::NoDisplay);
    }
    let ViewOptions { start, device, simulate, size } = options;
    let title = title(&scene.name);
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_inner_size(size)
            .with_title(title)
            .with_drag_and_drop(true),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: wgpu_options(device),
        ..eframe::NativeOptions::default()
    };
    let create = move |context: &eframe::CreationContext<'_>| -> Result<Viewer, ViewerError> {
        let render_state =
            context.wgpu_render_state.as_ref().ok_or_else(|| no_window("the window has no device"))?;
        match start {
            Start::Scene(_) => {
                let source = scene.source.clone();
                let mut viewer = Viewer::new(&context.egui_ctx, render_state, scene, simulate)?;
                if let Some(source) = source {
                    viewer.remember(&source, None, 0.0);
                }
                Ok(viewer)
            }
            Start::Checkpoint(checkpoint) => {
                let mut viewer = Viewer::idle(&context.egui_ctx, render_state, scene, simulate)?;
                viewer.resume(checkpoint)?;
                Ok(viewer)
            }
            Start::Run(run) => {
                let mut viewer = Viewer::idle(&context.egui_ctx, render_state, scene, simulate)?;
                let (folder, given) = (run.folder().to_owned(), opening::given_scene(&run));
                viewer.play(run, &context.egui_ctx).map_err(no_window)?;
                viewer.remember(&folder, given.as_deref(), 0.0);
                Ok(viewer)
            }
        }
    };
    let create: eframe::AppCreator<'_> = Box::new(move |context| Ok(Box::new(create(context)?)));
    eframe::run_native("splashdown", native, create).map_err(viewer_error)
}

/// The cause of a failure of eframe.
fn viewer_error(error: eframe::Error) -> ViewerError {
    match error {
        eframe::Error::AppCreation(error) => match error.downcast::<ViewerError>() {
            Ok(error) => *error,
            Err(error) => no_window(error),
        },
        eframe::Error::Winit(error) => ViewerError::Display { reason: sentence(error) },
        eframe::Error::WinitEventLoop(error) => ViewerError::Display { reason: sentence(error) },
        eframe::Error::Wgpu(WgpuError::CustomNativeAdapterSelectionError(reason)) => {
            ViewerError::NoDevice { reason }
        }
        error => no_window(error),
    }
}

fn no_window(reason: impl ToString) -> ViewerError {
    ViewerError::NoWindow { reason: sentence(reason), hint: MISSING_DRIVER_HINT }
}

/// A message without its final full stop, for use inside another one.
fn sentence(message: impl ToString) -> String {
    message.to_string().trim_end_matches('.').to_owned()
}

/// What happens when the window has no picture to draw into, for example while its size changes: it is tried again.
fn after_surface_error(status: &wgpu::CurrentSurfaceTexture) -> SurfaceErrorAction {
    match status {
        wgpu::CurrentSurfaceTexture::Lost => SurfaceErrorAction::RecreateSurface,
        // A hidden window is drawn when it is shown again.
        wgpu::CurrentSurfaceTexture::Occluded => SurfaceErrorAction::SkipFrame,
        _ => SurfaceErrorAction::Reconfigure,
    }
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
    WgpuConfiguration {
        wgpu_setup: WgpuSetup::CreateNew(setup),
        on_surface_status: Arc::new(after_surface_error),
        ..WgpuConfiguration::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown::error::CheckpointError;

    #[test]
    fn transient_errors_of_the_surface_are_tried_again() {
        use wgpu::CurrentSurfaceTexture as Status;
        for status in [Status::Outdated, Status::Timeout, Status::Validation] {
            assert!(matches!(after_surface_error(&status), SurfaceErrorAction::Reconfigure), "{status:?}");
        }
        assert!(matches!(after_surface_error(&Status::Lost), SurfaceErrorAction::RecreateSurface));
        assert!(matches!(after_surface_error(&Status::Occluded), SurfaceErrorAction::SkipFrame));
    }

    #[test]
    fn each_failure_has_its_own_error() {
        let creation = |error: ViewerError| viewer_error(eframe::Error::AppCreation(error.into()));
        let unusable = creation(CheckpointError::FlowChanged.into());
        assert!(matches!(unusable, ViewerError::Checkpoint(_)), "{unusable}");
        assert!(!unusable.to_string().contains("driver"), "{unusable}");
        let other = "no named adapter; choose another".to_owned();
        let device = viewer_error(eframe::Error::Wgpu(WgpuError::CustomNativeAdapterSelectionError(other)));
        assert!(
            matches!(&device, ViewerError::NoDevice { reason } if reason.contains("another")),
            "{device}"
        );
        let driver = viewer_error(eframe::Error::Wgpu(WgpuError::NoSurfaceFormatsAvailable));
        assert!(
            matches!(&driver, ViewerError::NoWindow { reason, .. } if !reason.ends_with('.')),
            "{driver}"
        );
    }
}
