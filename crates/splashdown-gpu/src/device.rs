//! Adapters: listing them, their capabilities, and opening one.
//!
//! On Linux, Mesa's device selection layer connects to a Wayland display whenever adapters are listed, and prints
//! "XDG_RUNTIME_DIR is invalid or not set" to the standard error if there is none. The message is harmless. A program
//! avoids it by setting that variable to any directory before its first thread starts; a library must not.

use std::sync::{Arc, Mutex};

use crate::{GpuError, block_on};

/// How to install a driver.
pub const MISSING_DRIVER_HINT: &str = "install your graphics card's Vulkan driver or, for drawing without a GPU, \
     a software one: on Debian and Ubuntu `apt-get install mesa-vulkan-drivers libvulkan1`, on Fedora \
     `dnf install mesa-vulkan-drivers vulkan-loader`; Windows and macOS bring theirs";

/// Which device to use.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum DeviceRequest {
    /// The best hardware GPU, otherwise a software driver.
    #[default]
    Auto,
    /// The best hardware GPU; software drivers are not considered.
    Hardware,
    /// A software driver, even if there is a GPU.
    Software,
    /// The adapter whose name or backend contains this text, ignoring case.
    Named(String),
}

/// An open device.
#[derive(Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Its name and kind.
    pub info: wgpu::AdapterInfo,
    /// Its limits.
    pub limits: wgpu::Limits,
    checks_shaders: bool,
    trouble: Arc<Mutex<Option<Trouble>>>,
}

/// An error that the device reported asynchronously.
#[derive(Clone, Debug)]
enum Trouble {
    Lost(String),
    Refused(String),
}

/// An adapter in [`list_adapters`].
#[derive(Clone, Debug)]
pub struct AdapterReport {
    /// Its name and kind.
    pub info: wgpu::AdapterInfo,
    /// Its limits.
    pub limits: wgpu::Limits,
    /// True if it runs on the CPU.
    pub software: bool,
    /// True if passes can be timed on it.
    pub timestamps: bool,
}

impl AdapterReport {
    /// The largest size of a buffer in bytes.
    pub fn largest_buffer(&self) -> u64 {
        largest_buffer(&self.limits)
    }
}

fn largest_buffer(limits: &wgpu::Limits) -> u64 {
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
}

/// The flags of an instance whose indirect arguments are written by passes of this project. They need no validation,
/// which costs another dispatch and two barriers for each indirect one. `WGPU_VALIDATION_INDIRECT_CALL=1` enables it.
pub fn instance_flags() -> wgpu::InstanceFlags {
    let flags = wgpu::InstanceFlags::from_build_config() - wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL;
    flags.with_env()
}

fn instance() -> wgpu::Instance {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    // The compute shaders of OpenGL lack features that the passes need; where it is the only API, the CPU is faster.
    descriptor.backends.remove(wgpu::Backends::GL);
    descriptor.flags = instance_flags();
    wgpu::Instance::new(descriptor)
}

fn is_software(info: &wgpu::AdapterInfo) -> bool {
    info.device_type == wgpu::DeviceType::Cpu
}

/// Hardware first.
fn rank(kind: wgpu::DeviceType) -> u8 {
    use wgpu::DeviceType as D;
    match kind {
        D::DiscreteGpu => 0,
        D::IntegratedGpu => 1,
        D::VirtualGpu => 2,
        D::Other => 3,
        D::Cpu => 4,
    }
}

/// All adapters, the best first.
async fn adapters() -> Vec<wgpu::Adapter> {
    let mut found = instance().enumerate_adapters(wgpu::Backends::all()).await;
    found.sort_by_key(|adapter| rank(adapter.get_info().device_type));
    found
}

/// Every adapter of this machine, the best first.
pub fn list_adapters() -> Vec<AdapterReport> {
    let report = |adapter: &wgpu::Adapter| {
        let info = adapter.get_info();
        AdapterReport {
            software: is_software(&info),
            limits: adapter.limits(),
            timestamps: adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY),
            info,
        }
    };
    block_on(adapters()).iter().map(report).collect()
}

impl Gpu {
    /// Opens a device.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`], [`GpuError::NoneOfKind`], [`GpuError::UnknownDevice`], [`GpuError::OpenFailed`].
    pub fn open(request: &DeviceRequest) -> Result<Self, GpuError> {
        block_on(Self::open_async(request))
    }

    /// Asynchronous [`open`](Self::open), for a web page, which cannot block.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub async fn open_async(request: &DeviceRequest) -> Result<Self, GpuError> {
        let found = adapters().await;
        Self::from_adapter(Self::choose(&found, request)?).await
    }

    /// The best of these adapters that meets the request; never one of OpenGL.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`], [`GpuError::NoneOfKind`], [`GpuError::UnknownDevice`].
    pub fn choose<'a>(
        found: impl IntoIterator<Item = &'a wgpu::Adapter>,
        request: &DeviceRequest,
    ) -> Result<&'a wgpu::Adapter, GpuError> {
        let mut found: Vec<_> = found.into_iter().map(|adapter| (adapter, adapter.get_info())).collect();
        found.retain(|(_, info)| info.backend != wgpu::Backend::Gl);
        found.sort_by_key(|(_, info)| rank(info.device_type));
        let fits = |(_, info): &&(_, wgpu::AdapterInfo)| match request {
            DeviceRequest::Auto => true,
            DeviceRequest::Hardware => !is_software(info),
            DeviceRequest::Software => is_software(info),
            DeviceRequest::Named(name) => {
                !name.is_empty() && describe(info).to_lowercase().contains(&name.to_lowercase())
            }
        };
        if let Some((adapter, _)) = found.iter().find(fits) {
            return Ok(adapter);
        }
        let available = || found.iter().map(|(_, info)| describe(info)).collect::<Vec<_>>().join("; ");
        Err(match request {
            DeviceRequest::Named(name) => GpuError::UnknownDevice {
                name: name.clone(),
                available: if found.is_empty() { "none (only the CPU)".into() } else { available() },
            },
            _ if found.is_empty() => GpuError::NoAdapter { hint: MISSING_DRIVER_HINT },
            DeviceRequest::Software => {
                GpuError::NoneOfKind { wanted: "software driver", available: available() }
            }
            _ => GpuError::NoneOfKind { wanted: "GPU", available: available() },
        })
    }

    /// The device to request from an adapter: with the adapter's own limits instead of WebGPU's defaults, so that a
    /// buffer may be as large as the memory allows, and with timestamps if it has them.
    pub fn descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
        wgpu::DeviceDescriptor {
            label: Some("splashdown"),
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: adapter.limits(),
            ..Default::default()
        }
    }

    async fn from_adapter(adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let (device, queue) = adapter.request_device(&Self::descriptor(adapter)).await.map_err(|error| {
            GpuError::OpenFailed { adapter: info.name.clone(), reason: error.to_string() }
        })?;
        Ok(Self::from_device(device, queue, info))
    }

    /// Takes over an open device, such as that of a window. From now on its errors are recorded here.
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue, info: wgpu::AdapterInfo) -> Self {
        let trouble = Arc::new(Mutex::new(None));
        let report = Arc::clone(&trouble);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let reason = error.to_string();
            if !is_of_window(&reason) {
                note(&report, Trouble::Refused(reason));
            }
        }));
        let report = Arc::clone(&trouble);
        device.set_device_lost_callback(move |reason, message| {
            // On a web page the browser destroys the device; elsewhere this is the end of the program.
            if reason != wgpu::DeviceLostReason::Destroyed || cfg!(target_arch = "wasm32") {
                note(&report, Trouble::Lost(format!("{reason:?}: {message}")));
            }
        });
        Self { limits: device.limits(), device, queue, info, checks_shaders: true, trouble }
    }

    /// The same device without the checks that keep shaders inside their buffers and out of endless loops, to measure
    /// the cost of the checks. A browser keeps its own checks.
    ///
    /// # Safety
    /// Every pass that runs on it must stay inside its buffers and terminate, whatever its buffers hold.
    #[must_use]
    pub unsafe fn without_shader_checks(self) -> Self {
        Self { checks_shaders: false, ..self }
    }

    /// True unless shaders run [without checks](Self::without_shader_checks).
    pub fn checks_shaders(&self) -> bool {
        self.checks_shaders
    }

    /// The name and the API, e.g. "NVIDIA H200 (Vulkan)".
    pub fn name(&self) -> String {
        describe(&self.info)
    }

    /// True if the device is a driver that computes on the CPU.
    pub fn is_software(&self) -> bool {
        is_software(&self.info)
    }

    /// The largest size of a buffer in bytes.
    pub fn largest_buffer(&self) -> u64 {
        largest_buffer(&self.limits)
    }

    /// Runs the callbacks of completed work, without waiting.
    ///
    /// # Errors
    /// As [`health`](Self::health).
    pub fn poll(&self) -> Result<(), GpuError> {
        // An error of `poll` means that nothing is complete; `health` reports a lost device.
        let _ = self.device.poll(wgpu::PollType::Poll);
        self.health("work on the device")
    }

    /// Waits for this submission and those before it, or for all. On a web page it returns immediately.
    ///
    /// # Errors
    /// As [`health`](Self::health).
    pub fn wait_for(&self, submission_index: Option<wgpu::SubmissionIndex>) -> Result<(), GpuError> {
        let outcome = self.device.poll(wgpu::PollType::Wait { submission_index, timeout: None });
        self.health("work on the device")?;
        outcome.map(drop).map_err(|error| GpuError::DeviceLost { reason: error.to_string() })
    }

    /// The result of `make`, and the error of this kind that it caused. On a web page errors arrive later, through
    /// [`health`](Self::health).
    pub(crate) fn scoped<T>(
        &self,
        filter: wgpu::ErrorFilter,
        make: impl FnOnce(&wgpu::Device) -> T,
    ) -> (T, Option<wgpu::Error>) {
        if cfg!(target_arch = "wasm32") {
            return (make(&self.device), None);
        }
        let scope = self.device.push_error_scope(filter);
        let made = make(&self.device);
        (made, block_on(scope.pop()))
    }

    /// The first error that the device reported asynchronously, if any.
    ///
    /// # Errors
    /// [`GpuError::DeviceLost`], [`GpuError::Refused`].
    pub fn health(&self, what: &str) -> Result<(), GpuError> {
        let trouble = self.trouble.lock().map(|trouble| trouble.clone()).unwrap_or(None);
        match trouble {
            None => Ok(()),
            Some(Trouble::Lost(reason)) => Err(GpuError::DeviceLost { reason }),
            Some(Trouble::Refused(reason)) => Err(GpuError::Refused { what: what.into(), reason }),
        }
    }
}

/// Stores the first report; later ones are usually its consequences.
fn note(trouble: &Mutex<Option<Trouble>>, new: Trouble) {
    if let Ok(mut trouble) = trouble.lock() {
        trouble.get_or_insert(new);
    }
}

/// Whether an error is about the surface of a window that shares the device. Its owner configures the surface again, for
/// example after a change of its size, and no buffer of this program is affected.
fn is_of_window(reason: &str) -> bool {
    reason.contains("In Surface::")
}

/// Name and interface. Browsers may hide the name.
fn describe(info: &wgpu::AdapterInfo) -> String {
    let interface = match info.backend {
        wgpu::Backend::BrowserWebGpu => "WebGPU".to_owned(),
        backend => format!("{backend:?}"),
    };
    let name = match (info.name.trim(), info.backend) {
        ("", wgpu::Backend::BrowserWebGpu) => "GPU of the browser",
        ("", _) => "unnamed device",
        (name, _) => name,
    };
    format!("{name} ({interface})")
}

#[cfg(test)]
mod tests {
    use super::{describe, is_of_window};

    #[test]
    fn a_device_without_a_name_is_described() {
        let mut info = wgpu::AdapterInfo::new(wgpu::DeviceType::Other, wgpu::Backend::BrowserWebGpu);
        assert_eq!(describe(&info), "GPU of the browser (WebGPU)");
        info.backend = wgpu::Backend::Vulkan;
        assert_eq!(describe(&info), "unnamed device (Vulkan)");
        info.name = "llvmpipe".to_owned();
        assert_eq!(describe(&info), "llvmpipe (Vulkan)");
    }

    #[test]
    fn errors_of_a_window_are_not_those_of_the_device() {
        let error =
            |context: &str| format!("Validation Error\n\nCaused by:\n  In {context}\n    it is refused\n");
        assert!(is_of_window(&error("Surface::configure")));
        assert!(is_of_window(&error("Surface::get_current_texture_view")));
        assert!(!is_of_window(&error("Device::create_buffer, label = 'surface'")));
        assert!(!is_of_window(&error("a CommandEncoder, label = 'surface vertices'")));
    }
}
