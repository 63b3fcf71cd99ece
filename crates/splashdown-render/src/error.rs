//! What can go wrong while drawing.

use crate::Ticket;

/// Why a picture could not be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The system offers nothing to draw with.
    #[error(
        "no graphics adapter found ({reason}); pictures need a GPU driver or a software one: on Debian and Ubuntu \
         `apt-get install mesa-vulkan-drivers`, on Fedora `dnf install mesa-vulkan-drivers`, on Arch `pacman -S vulkan-swrast`"
    )]
    NoAdapter {
        /// What the system answered.
        reason: String,
    },
    /// An adapter is there but would not give a device.
    #[error("the adapter \"{adapter}\" gave no device: {reason}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// What the driver answered.
        reason: String,
    },
    /// The picture has no pixels, or more than the device can hold.
    #[error(
        "a picture of {width} x {height} pixels cannot be drawn: each side must be between 1 and {limit} on this device"
    )]
    PictureSize {
        /// Width asked for, in pixels.
        width: u32,
        /// Height asked for, in pixels.
        height: u32,
        /// Largest side that the device allows.
        limit: u32,
    },
    /// A number of samples per pixel that WebGPU does not know.
    #[error("{given} samples per pixel were asked for; only 1 and 4 exist everywhere")]
    SampleCount {
        /// The number asked for.
        given: u32,
    },
    /// Renderer and target store colours in different ways.
    #[error(
        "the renderer was made for {renderer:?} pictures and cannot draw into {target:?}; make it with the target's format"
    )]
    Format {
        /// Format the renderer was made for.
        renderer: wgpu::TextureFormat,
        /// Format of the target.
        target: wgpu::TextureFormat,
    },
    /// The camera looks nowhere.
    #[error("the camera is unusable: {reason}")]
    Camera {
        /// Which number is wrong and what is allowed.
        reason: String,
    },
    /// A number of the frame's description is out of range.
    #[error("{what} is {given}, allowed is {allowed}")]
    Value {
        /// Which number.
        what: &'static str,
        /// What was given.
        given: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// The frame has the same liquid twice.
    #[error("a frame has a surface or liquid particles, not both: set one of the two to None")]
    TwoLiquids,
    /// A buffer is shorter than the number of elements promises.
    #[error("the buffer of {what} holds {given} bytes, {needed} are needed")]
    BufferTooShort {
        /// Which buffer.
        what: &'static str,
        /// Its size in bytes.
        given: u64,
        /// The size that the counts ask for.
        needed: u64,
    },
    /// A buffer is larger than a shader can see.
    #[error(
        "the buffer of {what} holds {given} bytes, more than the {limit} that a shader can see on this device; draw the \
         surface without lines"
    )]
    BufferTooLong {
        /// Which buffer.
        what: &'static str,
        /// Its size in bytes.
        given: u64,
        /// The device's limit.
        limit: u64,
    },
    /// A buffer was made without a usage that drawing needs.
    #[error("the buffer of {what} lacks the usage {missing:?}; create it with that usage")]
    BufferUsage {
        /// Which buffer.
        what: &'static str,
        /// The usages that are missing.
        missing: wgpu::BufferUsages,
    },
    /// Host slices that belong together have different lengths.
    #[error("{what} has {given} elements; it must have {needed}, or none if the attribute is absent")]
    Length {
        /// Which slice.
        what: &'static str,
        /// Its length.
        given: usize,
        /// The length of the positions or vertices.
        needed: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {vertex}, but there are only {vertices} vertices")]
    Index {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// Too many pictures were submitted and none collected.
    #[error("{limit} pictures are already in flight; collect one before the next is submitted")]
    FramesInFlight {
        /// Most pictures that may be under way.
        limit: usize,
    },
    /// The ticket belongs to another target.
    #[error("{ticket:?} was not given by this target")]
    UnknownTicket {
        /// The ticket that was shown.
        ticket: Ticket,
    },
    /// The device went away or ran out of memory while a picture was under way.
    #[error(
        "the graphics device was lost or ran out of memory ({reason}); open it again, or make the picture smaller"
    )]
    DeviceLost {
        /// What the driver said.
        reason: String,
    },
}
