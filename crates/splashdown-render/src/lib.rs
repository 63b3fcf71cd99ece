//! Rendering of particles and liquid surfaces with wgpu, into any texture.
//!
//! ```no_run
//! use splashdown_gpu::{DeviceRequest, Gpu};
//! use splashdown_render::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let gpu = Gpu::open(&DeviceRequest::Auto)?;
//! let (device, queue) = (&gpu.device, &gpu.queue);
//! let mut renderer = Renderer::new(device, queue, Offscreen::FORMAT, 4)?;
//! let mut target = Offscreen::new(device, queue, [1280, 720])?;
//!
//! let particles = UploadedParticles::new(device, &[[0.5, 0.1, 0.5]], &[[1.0, 0.0, 0.0]], &[], &[])?;
//! let domain = Domain::closed([0.0; 3], [1.0; 3]);
//! let camera = Camera::framing(&domain, 30.0, 20.0, 35.0, 16.0 / 9.0);
//! let colouring = Colouring::new(Quantity::Speed, [0.0, 2.0]);
//! let frame = Frame::new(camera, domain)
//!     .with_particles(DrawnParticles::new(particles.buffers(), 0.05, colouring))
//!     .with_caption("t = 0.00 s");
//! let rgba: Vec<u8> = target.render_to_rgba(&mut renderer, &frame)?;
//! # Ok(())
//! # }
//! ```
//!
//! # Input and output
//!
//! [`ParticleBuffers`] and [`SurfaceBuffers`] refer to GPU buffers that a simulation has filled;
//! nothing is copied. [`UploadedParticles`] and [`UploadedSurface`] upload host slices into such
//! buffers. [`Renderer::draw`] records into the caller's encoder and texture, for windows.
//! [`Offscreen`] reads pictures back to the host.
//!
//! # Rendering modes
//!
//! * spheres coloured by a quantity ([`DrawnParticles`]);
//! * a liquid from a surface mesh, with or without its wireframe ([`DrawnSurface`]);
//! * the same with traced rays ([`TracedMeshes`], [`Quality`]): slower, and what published pictures use;
//! * a liquid directly from the particles, in screen space ([`DrawnLiquidParticles`]);
//! * a plane through the fluid coloured by a quantity ([`DrawnSlice`]);
//! * droplets of the liquid beside a mesh of it ([`DrawnDroplets`]);
//! * foam, spray and bubbles, combined with any other mode ([`DrawnFoam`]).
//!
//! `examples/modes.rs` draws all of them side by side and compares their times.
//!
//! # Structure
//!
//! Each rendering mode is a folder with its Rust and WGSL code; the module documentation describes
//! the method and the alternatives. The crate needs only what WebGPU guarantees: at most 3 storage
//! buffers per stage, blendable 16-bit float targets, and 4 samples.

mod background;
mod bodies;
mod buffers;
mod camera;
mod chunks;
mod colour_map;
mod colouring;
mod domain;
mod droplets;
mod edges;
mod error;
mod floor;
mod foam;
mod frame;
mod glass;
mod globals;
mod liquid;
mod offscreen;
mod overlay;
mod particles;
mod pipeline;
mod quality;
mod readback;
mod recorder;
mod renderer;
mod scene_copy;
mod screen_space;
mod shader;
mod shadow;
mod sky;
mod slice;
mod surface;
mod targets;
mod texture;
mod ticket;
mod tiling;
mod trace;
mod tree;
mod uploads;

/// The version of wgpu whose types appear in this crate's interface.
pub use wgpu;

pub use bodies::{PlacedBody, UploadedBodies};
pub use buffers::{
    BodyBuffers, Draw, DropletBuffers, FoamBuffers, ParticleBuffers, SurfaceBuffers, SurfaceStyle,
};
pub use camera::Camera;
pub use colour_map::ColourMap;
pub use colouring::{Colouring, Quantity};
pub use domain::{Domain, Surroundings, Tank};
pub use droplets::DrawnDroplets;
pub use error::RenderError;
pub use floor::{Floor, FloorPattern};
pub use foam::DrawnFoam;
pub use frame::Frame;
pub use liquid::Liquid;
pub use offscreen::{MemoryForecast, Offscreen};
pub use overlay::missing_characters;
pub use particles::DrawnParticles;
pub use quality::Quality;
pub use renderer::{PassTime, Renderer};
pub use screen_space::DrawnLiquidParticles;
pub use sky::Sky;
pub use slice::{Axis, DrawnSlice};
pub use surface::DrawnSurface;
pub use ticket::Ticket;
pub use tree::TracedMeshes;
pub use uploads::{UploadedDroplets, UploadedFoam, UploadedParticles, UploadedSurface};
