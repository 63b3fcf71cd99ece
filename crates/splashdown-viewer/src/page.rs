//! The web page: the program on a canvas.

use std::cell::RefCell;
use std::sync::Arc;

use egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use splashdown::scene::{Scene, presets};
use splashdown_gpu::{DeviceRequest, Gpu, PassDesc, refused_passes};
use wasm_bindgen::JsValue;

use crate::{Viewer, browser, fit};

thread_local! {
    /// The runner of the canvas.
    static RUNNER: RefCell<Option<eframe::WebRunner>> = const { RefCell::new(None) };
}

/// Starts or restarts the program on a canvas. After the device was lost it resumes from the last backup, which is some
/// seconds old. `scene` is the name of a built-in scene, or the text of a scene file. `largest_buffer` and `memory` are those
/// of the device in bytes; a memory of 0 is unknown.
///
/// # Errors
/// A message about the scene, which may need more memory than the device has, or about the missing device.
pub async fn start_on_page(
    canvas: web_sys::HtmlCanvasElement,
    scene: &str,
    [largest_buffer, memory]: [u64; 2],
) -> Result<(), JsValue> {
    let scene = open(scene).map_err(|error| JsValue::from_str(&error))?;
    fit::check(&scene, largest_buffer, memory).map_err(|error| JsValue::from_str(&error))?;
    let setup = WgpuSetupCreateNew {
        instance_descriptor: wgpu::InstanceDescriptor {
            backends: wgpu::Backends::BROWSER_WEBGPU,
            ..WgpuSetupCreateNew::without_display_handle().instance_descriptor
        },
        device_descriptor: Arc::new(Gpu::descriptor),
        ..WgpuSetupCreateNew::without_display_handle()
    };
    let options = eframe::WebOptions {
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: WgpuConfiguration {
            wgpu_setup: WgpuSetup::CreateNew(setup),
            ..WgpuConfiguration::default()
        },
        ..eframe::WebOptions::default()
    };
    let create = move |context: &eframe::CreationContext<'_>| {
        let render_state = context.wgpu_render_state.as_ref().ok_or("the page has no device")?;
        // The scene is shown if the backup cannot be resumed.
        let mut viewer = Viewer::new(&context.egui_ctx, render_state, scene, None)?;
        if let Some(checkpoint) = browser::take_rescue() {
            viewer.resume(checkpoint)?;
        }
        Ok(Box::new(viewer) as Box<dyn eframe::App>)
    };
    // A runner whose device was lost is unusable.
    if let Some(old) = RUNNER.take() {
        old.destroy();
    }
    browser::set_figures(String::new());
    let runner = eframe::WebRunner::new();
    RUNNER.set(Some(runner.clone()));
    runner.start(canvas, options, Box::new(create)).await
}

fn open(scene: &str) -> Result<Scene, String> {
    let preset = presets().iter().find(|(name, _)| *name == scene);
    let (name, text) = match preset {
        Some((name, text)) => (*name, *text),
        None if scene.contains('=') => ("this link", scene),
        None => {
            let names: Vec<_> = presets().iter().map(|(name, _)| *name).collect();
            return Err(format!("there is no scene {scene:?}; the scenes are {}", names.join(", ")));
        }
    };
    Scene::parse(text, name).map_err(|error| error.to_string())
}

/// Compiles every pass of the program on this browser's device. Returns their number and the errors of refused passes
/// as JSON. With `broken`, an invalid pass is added.
///
/// # Errors
/// A message about the missing device.
pub async fn try_passes(broken: bool) -> Result<String, JsValue> {
    let gpu =
        Gpu::open_async(&DeviceRequest::Auto).await.map_err(|error| JsValue::from_str(&error.to_string()))?;
    let mut passes = [splashdown_gpu::passes(), splashdown::passes()].concat();
    if broken {
        passes.push(&BROKEN);
    }
    let refused = refused_passes(&gpu, &passes).await;
    let refused: Vec<String> = refused.iter().map(|error| format!("{:?}", error.to_string())).collect();
    Ok(format!("{{\"passes\":{},\"refused\":[{}]}}", passes.len(), refused.join(",")))
}

/// Exceeds the limits of every device.
static BROKEN: PassDesc = PassDesc {
    label: "broken",
    wgsl: "@compute @workgroup_size(1000000) fn broken() {}",
    imports: &[],
    entry: "broken",
    workgroup_size: [1_000_000, 1, 1],
    constants: &[],
    bindings: &[],
    cpu: |_, _| {},
};
