//! The errors of this crate.

/// An error of the GPU layer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter at all.
    #[error("no usable GPU or software Vulkan driver was found; {hint}")]
    NoAdapter {
        /// How to install one.
        hint: &'static str,
    },
    /// There are adapters, but none of the requested kind.
    #[error(
        "no {wanted} was found; available are: {available}. Use auto, cpu or a part of one of these names"
    )]
    NoneOfKind {
        /// The requested kind.
        wanted: &'static str,
        /// The names of the available adapters.
        available: String,
    },
    /// There are adapters, but not the requested one.
    #[error(
        "no device is called {name:?}; available are: {available}. Use auto, gpu, cpu or a part of one of these names"
    )]
    UnknownDevice {
        /// The name given.
        name: String,
        /// The names of the available adapters.
        available: String,
    },
    /// The driver refused to open the device.
    #[error("the driver of {adapter} refused to open it: {reason}")]
    OpenFailed {
        /// The adapter's name.
        adapter: String,
        /// The driver's message.
        reason: String,
    },
    /// A buffer is larger than the device can bind or allocate.
    #[error(
        "buffer {label:?} of {len} elements needs {bytes} bytes, and this device binds at most {limit} bytes: at most {fits} elements fit"
    )]
    TooLarge {
        /// The buffer's name.
        label: String,
        /// Requested elements.
        len: u64,
        /// Requested bytes.
        bytes: u64,
        /// The largest number of bytes.
        limit: u64,
        /// The largest number of elements.
        fits: u64,
    },
    /// The device ran out of memory.
    #[error(
        "the device has not enough memory for buffer {label:?} of {bytes} bytes; use fewer particles or another device"
    )]
    OutOfMemory {
        /// The buffer's name.
        label: String,
        /// Requested bytes.
        bytes: u64,
    },
    /// The device was lost: unplugged, reset by the system, or hung.
    #[error(
        "the device was lost ({reason}); files written before stay valid. Start again, or use --device cpu"
    )]
    DeviceLost {
        /// The driver's message.
        reason: String,
    },
    /// wgpu refused a command; a bug in this crate or in a pass.
    #[error("the device refused {what}: {reason}")]
    Refused {
        /// The refused operation.
        what: String,
        /// wgpu's message.
        reason: String,
    },
    /// A buffer was used after it was freed, or in another executor.
    #[error("buffer {label:?} was freed, or belongs to another executor")]
    NoSuchBuffer {
        /// The buffer's label.
        label: String,
    },
    /// A pass gets a buffer of the wrong type, or none, for one of its bindings; a bug in the recording code.
    #[error("pass {pass}: {reason}")]
    BadBinding {
        /// The pass's label.
        pass: &'static str,
        /// The difference.
        reason: String,
    },
    /// A command does not fit its buffers; a bug in the recording code.
    #[error("recording {recording:?}: {reason}")]
    BadCommand {
        /// The recording's label.
        recording: String,
        /// The misfit.
        reason: String,
    },
    /// The WGSL of a pass could not be assembled or compiled.
    #[error("pass {pass}: {reason}")]
    BadShader {
        /// The pass's label.
        pass: &'static str,
        /// The problem.
        reason: String,
    },
}
