//! Selection of the device that runs a simulation.

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use splashdown_gpu::{CpuExecutor, DeviceRequest, Executor, Gpu, GpuError, GpuExecutor};

/// The device that runs a simulation.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum Device {
    /// The best GPU, or the CPU if there is no GPU. Software drivers are not used: the CPU executor is about
    /// twelve times as fast (`docs/performance.md`).
    #[default]
    Auto,
    /// The best GPU; an error if there is none.
    Gpu,
    /// The CPU.
    Cpu,
    /// The adapter whose name contains this text. Software drivers are included.
    Named(String),
}

impl FromStr for Device {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text.to_lowercase().as_str() {
            "auto" => Self::Auto,
            "gpu" => Self::Gpu,
            "cpu" => Self::Cpu,
            _ => Self::Named(text.to_owned()),
        })
    }
}

impl fmt::Display for Device {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Auto => "auto",
            Self::Gpu => "gpu",
            Self::Cpu => "cpu",
            Self::Named(name) => name,
        })
    }
}

impl Device {
    /// Opens the device and makes an executor on it.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] and [`GpuError::UnknownDevice`]; never for [`Auto`](Self::Auto) and [`Cpu`](Self::Cpu).
    pub fn executor(&self) -> Result<Executor, GpuError> {
        self.open(true)
    }

    /// As [`executor`](Self::executor), without the bounds checks in shaders. For measuring the cost of these checks.
    ///
    /// # Safety
    /// Run only passes of this library on it, and only over buffers that these passes have written. See
    /// [`Gpu::without_shader_checks`].
    ///
    /// # Errors
    /// As [`executor`](Self::executor).
    pub unsafe fn unchecked_executor(&self) -> Result<Executor, GpuError> {
        self.open(false)
    }

    fn open(&self, checks_shaders: bool) -> Result<Executor, GpuError> {
        let gpu = |request: &DeviceRequest| {
            let gpu = Gpu::open(request)?;
            // SAFETY: guaranteed by the caller of `unchecked_executor`.
            let gpu = if checks_shaders { gpu } else { unsafe { gpu.without_shader_checks() } };
            Ok(Executor::from(GpuExecutor::new(Arc::new(gpu))))
        };
        match self {
            Self::Cpu => Ok(CpuExecutor::new().into()),
            Self::Gpu => gpu(&DeviceRequest::Hardware),
            Self::Named(name) => gpu(&DeviceRequest::Named(name.clone())),
            Self::Auto => match gpu(&DeviceRequest::Hardware) {
                Ok(executor) => Ok(executor),
                Err(error) => {
                    tracing::info!("simulating on the CPU: {error}");
                    Ok(CpuExecutor::new().into())
                }
            },
        }
    }
}
