//! What can go wrong between this crate and a device.

/// An error of the GPU layer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter at all.
    #[error("no usable GPU or software Vulkan driver was found; {hint}")]
    NoAdapter {
        /// How to get one.
        hint: &'static str,
    },
    /// Adapters there are, but not of the kind asked for.
    #[error(
        "no {wanted} was found; available are: {available}. Use auto, cpu or a part of one of these names"
    )]
    NoneOfKind {
        /// The kind asked for.
        wanted: &'static str,
        /// The names there are.
        available: String,
    },
    /// Adapters there are, but not the one asked for.
    #[error(
        "no device is called {name:?}; available are: {available}. Use auto, gpu, cpu or a part of one of these names"
    )]
    UnknownDevice {
        /// The name given.
        name: String,
        /// The names there are.
        available: String,
    },
    /// The driver refused to make a device.
    #[error("the driver of {adapter} refused to open it: {reason}")]
    OpenFailed {
        /// The adapter's name.
        adapter: String,
        /// The driver's words.
        reason: String,
    },
    /// A buffer is larger than the device can bind or allocate.
    #[error(
        "buffer {label:?} of {len} elements needs {bytes} bytes, and this device binds at most {limit} bytes: at most {fits} elements fit"
    )]
    TooLarge {
        /// The buffer's name.
        label: String,
        /// Elements asked for.
        len: u64,
        /// Bytes asked for.
        bytes: u64,
        /// Most bytes.
        limit: u64,
        /// Most elements.
        fits: u64,
    },
    /// The device ran out of memory.
    #[error(
        "the device has not enough memory for buffer {label:?} of {bytes} bytes; use fewer particles or another device"
    )]
    OutOfMemory {
        /// The buffer's name.
        label: String,
        /// Bytes asked for.
        bytes: u64,
    },
    /// The device went away: unplugged, reset by the system, or hung.
    #[error(
        "the device was lost ({reason}); what was written before stays valid. Start again, or use --device cpu"
    )]
    DeviceLost {
        /// The driver's words.
        reason: String,
    },
    /// wgpu refused a command; a bug in this crate or in a pass.
    #[error("the device refused {what}: {reason}")]
    Refused {
        /// What was asked for.
        what: String,
        /// wgpu's words.
        reason: String,
    },
    /// A recording names a buffer of the wrong type, or misses one; a bug in whoever recorded it.
    #[error("pass {pass}: {reason}")]
    BadBinding {
        /// The pass's label.
        pass: &'static str,
        /// What differs.
        reason: String,
    },
    /// A command does not fit its buffers; a bug in whoever recorded it.
    #[error("recording {recording:?}: {reason}")]
    BadCommand {
        /// The recording's label.
        recording: String,
        /// What does not fit.
        reason: String,
    },
    /// A WGSL text could not be put together.
    #[error("pass {pass}: {reason}")]
    BadShader {
        /// The pass's label.
        pass: &'static str,
        /// What is wrong.
        reason: String,
    },
}
