//! Adapters: which there are, what they can do, and opening one.
//!
//! On Linux, Mesa's layer that chooses a device asks for a Wayland display whenever adapters are listed, and prints
//! "XDG_RUNTIME_DIR is invalid or not set" to the standard error where there is none. It is harmless. A program that
//! wants silence sets that variable to any directory before its first thread starts; a library must not.

use std::sync::{Arc, Mutex};

use crate::exec::Mapping;
use crate::{GpuError, block_on};

/// How to get a driver where there is none.
pub const MISSING_DRIVER_HINT: &str = "install your graphics card's Vulkan driver or, for drawing without a GPU, \
     a software one: on Debian and Ubuntu `apt-get install mesa-vulkan-drivers libvulkan1`, on Fedora \
     `dnf install mesa-vulkan-drivers vulkan-loader`; Windows and macOS bring theirs";

/// Which device to use.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum DeviceRequest {
    /// The best real GPU, else a software driver.
    #[default]
    Auto,
    /// The best real GPU; software drivers do not count.
    Hardware,
    /// A software driver, even where there is a GPU.
    Software,
    /// The adapter whose name or backend contains this, whatever the case.
    Named(String),
}

/// An open device.
#[derive(Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// What it calls itself.
    pub info: wgpu::AdapterInfo,
    /// What it allows.
    pub limits: wgpu::Limits,
    checks_shaders: bool,
    trouble: Arc<Mutex<Option<Trouble>>>,
}

/// What the device reported outside of any call.
#[derive(Clone, Debug)]
enum Trouble {
    Lost(String),
    Refused(String),
}

/// What [`list_adapters`] tells of an adapter.
#[derive(Clone, Debug)]
pub struct AdapterReport {
    /// What it calls itself.
    pub info: wgpu::AdapterInfo,
    /// What it allows.
    pub limits: wgpu::Limits,
    /// True if it runs on the CPU.
    pub software: bool,
    /// True if passes can be timed on it.
    pub timestamps: bool,
}

impl AdapterReport {
    /// The largest number of bytes one buffer may have.
    pub fn largest_buffer(&self) -> u64 {
        largest_buffer(&self.limits)
    }
}

fn largest_buffer(limits: &wgpu::Limits) -> u64 {
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
}

fn instance() -> wgpu::Instance {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    // OpenGL's compute shaders lack what the passes need; where it is the only API, the CPU does better.
    descriptor.backends.remove(wgpu::Backends::GL);
    wgpu::Instance::new(descriptor)
}

fn is_software(info: &wgpu::AdapterInfo) -> bool {
    info.device_type == wgpu::DeviceType::Cpu
}

/// Real hardware first.
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

/// Adapters, the best first.
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

    /// [`open`](Self::open) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub async fn open_async(request: &DeviceRequest) -> Result<Self, GpuError> {
        let found = adapters().await;
        Self::from_adapter(Self::choose(&found, request)?).await
    }

    /// The best of these adapters that is meant. Those of OpenGL are not, whatever is asked for.
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

    /// What to ask of an adapter: its own limits, not WebGPU's smallest, so that a buffer may be as large as
    /// the memory allows; and clocks, where it has them.
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

    /// Takes over a device that is open already: a window's. From now on its errors are noted here.
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue, info: wgpu::AdapterInfo) -> Self {
        let trouble = Arc::new(Mutex::new(None));
        let report = Arc::clone(&trouble);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            note(&report, Trouble::Refused(error.to_string()));
        }));
        let report = Arc::clone(&trouble);
        device.set_device_lost_callback(move |reason, message| {
            // On a page it is the browser that destroys; elsewhere it is the end of this program.
            if reason != wgpu::DeviceLostReason::Destroyed || cfg!(target_arch = "wasm32") {
                note(&report, Trouble::Lost(format!("{reason:?}: {message}")));
            }
        });
        Self { limits: device.limits(), device, queue, info, checks_shaders: true, trouble }
    }

    /// The same device without the checks that keep shaders inside their buffers and out of endless loops: for
    /// measuring what the checks cost. A browser has its own, which stay.
    ///
    /// # Safety
    /// Every pass that runs on it, with whatever its buffers hold, must stay inside its buffers and end by itself.
    #[must_use]
    pub unsafe fn without_shader_checks(self) -> Self {
        Self { checks_shaders: false, ..self }
    }

    /// True unless shaders run [without checks](Self::without_shader_checks).
    pub fn checks_shaders(&self) -> bool {
        self.checks_shaders
    }

    /// The name and the API behind it, e.g. "NVIDIA H200 (Vulkan)".
    pub fn name(&self) -> String {
        describe(&self.info)
    }

    /// True if the device is a driver that computes on the CPU.
    pub fn is_software(&self) -> bool {
        is_software(&self.info)
    }

    /// The largest number of bytes one buffer may have.
    pub fn largest_buffer(&self) -> u64 {
        largest_buffer(&self.limits)
    }

    /// The content of a buffer with [`wgpu::BufferUsages::MAP_READ`] that a submission fills, as soon as that is done.
    ///
    /// # Errors
    /// [`GpuError::DeviceLost`].
    pub async fn read_back(
        self: &Arc<Self>,
        staging: wgpu::Buffer,
        submission: wgpu::SubmissionIndex,
    ) -> Result<Vec<u8>, GpuError> {
        Mapping::new(self, staging, submission).take().await
    }

    /// Lets finished work report itself, without waiting.
    ///
    /// # Errors
    /// As [`health`](Self::health).
    pub fn poll(&self) -> Result<(), GpuError> {
        // An error of `poll` says that nothing was finished; a lost device shows in `health`.
        let _ = self.device.poll(wgpu::PollType::Poll);
        self.health("work on the device")
    }

    /// Waits for this submission and those before it, or for all. On a web page it does not wait: the browser reports.
    ///
    /// # Errors
    /// As [`health`](Self::health).
    pub fn wait_for(&self, submission_index: Option<wgpu::SubmissionIndex>) -> Result<(), GpuError> {
        let outcome = self.device.poll(wgpu::PollType::Wait { submission_index, timeout: None });
        self.health("work on the device")?;
        outcome.map(drop).map_err(|error| GpuError::DeviceLost { reason: error.to_string() })
    }

    /// What `make` makes, and the error of this kind that the device had with it. On a web page errors come later, by
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

    /// What the device has reported since, outside of any call.
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

/// Keeps the first report: what follows is mostly its consequence.
fn note(trouble: &Mutex<Option<Trouble>>, new: Trouble) {
    if let Ok(mut trouble) = trouble.lock() {
        trouble.get_or_insert(new);
    }
}

fn describe(info: &wgpu::AdapterInfo) -> String {
    format!("{} ({:?})", info.name, info.backend)
}
