//! Errors of this crate.

use crate::Ticket;

/// The reason why a picture could not be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The picture has no pixels, or a side that exceeds the limit: that of the device for [`Renderer::draw`](crate::Renderer::draw),
    /// 32,768 for [`Offscreen`](crate::Offscreen).
    #[error(
        "a picture of {width} x {height} pixels cannot be drawn: each side must be between 1 and {limit}"
    )]
    PictureSize {
        /// Requested width in pixels.
        width: u32,
        /// Requested height in pixels.
        height: u32,
        /// Largest side.
        limit: u32,
    },
    /// The picture has too many pixels to be put together from tiles.
    #[error(
        "a picture of {width} x {height} pixels cannot be drawn: at most {} million pixels are allowed; reduce a side",
        limit / 1_000_000
    )]
    TooManyPixels {
        /// Requested width in pixels.
        width: u32,
        /// Requested height in pixels.
        height: u32,
        /// Largest number of pixels.
        limit: u64,
    },
    /// The host has too little memory for the picture.
    #[error(
        "there is not enough memory for a picture of {width} x {height} pixels, {} MiB; reduce its size or free memory",
        (4 * u64::from(*width) * u64::from(*height)).div_ceil(1 << 20)
    )]
    PictureMemory {
        /// Requested width in pixels.
        width: u32,
        /// Requested height in pixels.
        height: u32,
    },
    /// WebGPU does not support this number of samples per pixel.
    #[error("{given} samples per pixel were requested; WebGPU supports 1 and 4")]
    SampleCount {
        /// The requested number.
        given: u32,
    },
    /// Renderer and target have different texture formats.
    #[error(
        "the renderer was created for the format {renderer:?} and cannot draw into {target:?}; create it with the \
         format of the target"
    )]
    Format {
        /// Format of the renderer.
        renderer: wgpu::TextureFormat,
        /// Format of the target.
        target: wgpu::TextureFormat,
    },
    /// The camera is invalid.
    #[error("the camera is invalid: {reason}")]
    Camera {
        /// The wrong value and what is allowed.
        reason: String,
    },
    /// A value of the frame is out of range.
    #[error("{what} is {given}, allowed is {allowed}")]
    Value {
        /// Name of the value.
        what: &'static str,
        /// The given value.
        given: String,
        /// The allowed values.
        allowed: &'static str,
    },
    /// The frame has both a surface and liquid particles.
    #[error("a frame has either a surface or liquid particles; set one of the two to None")]
    TwoLiquids,
    /// The trees of the triangles do not fit the device.
    #[error(
        "rays were to be traced through {given} triangles; this device supports about {allowed}: draw with interactive \
         quality, or extract the surface with larger cells"
    )]
    TooManyTriangles {
        /// Number of triangles.
        given: usize,
        /// The number that fits.
        allowed: usize,
    },
    /// A buffer is too short for the number of elements.
    #[error("the buffer of {what} has {given} bytes, but {needed} are required")]
    BufferTooShort {
        /// Which buffer.
        what: &'static str,
        /// Its size in bytes.
        given: u64,
        /// The required size in bytes.
        needed: u64,
    },
    /// A buffer is larger than the largest storage binding.
    #[error(
        "the buffer of {what} has {given} bytes, but the largest storage binding of this device is {limit} bytes; draw \
         the surface without lines"
    )]
    BufferTooLong {
        /// Which buffer.
        what: &'static str,
        /// Its size in bytes.
        given: u64,
        /// The limit of the device in bytes.
        limit: u64,
    },
    /// A buffer was created without a required usage.
    #[error("the buffer of {what} lacks the usage {missing:?}; create it with that usage")]
    BufferUsage {
        /// Which buffer.
        what: &'static str,
        /// The missing usages.
        missing: wgpu::BufferUsages,
    },
    /// Host slices have different lengths.
    #[error("{what} has {given} elements; it must have {needed}, or none if the attribute is absent")]
    Length {
        /// Which slice.
        what: &'static str,
        /// Its length.
        given: usize,
        /// The length of the positions or vertices.
        needed: usize,
    },
    /// A triangle refers to a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {vertex}, but the mesh has only {vertices} vertices")]
    Index {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex it refers to.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// The largest number of pictures is already in flight.
    #[error("{limit} pictures are already in flight; collect one before submitting the next")]
    FramesInFlight {
        /// Largest number of pictures in flight.
        limit: usize,
    },
    /// The ticket was issued by another target.
    #[error("{ticket:?} belongs to another target")]
    UnknownTicket {
        /// The ticket.
        ticket: Ticket,
    },
    /// The device was lost or ran out of memory while a picture was in flight.
    #[error(
        "the graphics device was lost or ran out of memory ({reason}); open it again, or reduce the size of the picture"
    )]
    DeviceLost {
        /// The reason given by the driver.
        reason: String,
    },
}

/// Refuses radii that are not positive and finite.
pub(crate) fn check_radius(radius: f32) -> Result<(), RenderError> {
    if radius > 0.0 && radius.is_finite() {
        return Ok(());
    }
    Err(RenderError::Value {
        what: "the particle radius",
        given: format!("{radius} m"),
        allowed: "a finite number above 0",
    })
}

/// Refuses times of exposure that are negative or not finite.
pub(crate) fn check_shutter(what: &'static str, shutter: f32) -> Result<(), RenderError> {
    if shutter >= 0.0 && shutter.is_finite() {
        return Ok(());
    }
    Err(RenderError::Value { what, given: format!("{shutter} s"), allowed: "a finite number of at least 0" })
}
