//! Pictures of particles and liquid surfaces, drawn with wgpu into any texture.
//!
//! ```no_run
//! use splashdown_render::*;
//!
//! # fn main() -> Result<(), RenderError> {
//! let (device, queue, _) = open_device()?;
//! let mut renderer = Renderer::new(&device, &queue, Offscreen::FORMAT, 4)?;
//! let mut target = Offscreen::new(&device, &queue, [1280, 720])?;
//!
//! let particles = UploadedParticles::new(&device, &[[0.5, 0.1, 0.5]], &[[1.0, 0.0, 0.0]], &[], &[])?;
//! let domain = Domain::closed([0.0; 3], [1.0; 3]);
//! let camera = Camera::framing(&domain, 30.0, 20.0, 35.0, 16.0 / 9.0);
//! let frame = Frame {
//!     particles: Some(DrawnParticles {
//!         buffers: particles.buffers(),
//!         radius: 0.05,
//!         colouring: Colouring {
//!             quantity: Quantity::Speed,
//!             range: [0.0, 2.0],
//!             map: ColourMap::Water,
//!             colour_bar: true,
//!         },
//!     }),
//!     caption: Some("t = 0.00 s"),
//!     ..Frame::new(camera, domain)
//! };
//! let rgba: Vec<u8> = target.render_to_rgba(&mut renderer, &frame)?;
//! # Ok(())
//! # }
//! ```
//!
//! [`ParticleBuffers`] and [`SurfaceBuffers`] name GPU buffers that a simulation has filled; nothing is copied.
//! [`UploadedParticles`] and [`UploadedSurface`] put host slices into such buffers. [`Renderer::draw`] records into the
//! caller's encoder and texture, for windows; [`Offscreen`] reads pictures back.
//!
//! The fluid can be seen as spheres coloured by a quantity ([`DrawnParticles`]), as liquid from a mesh, with or
//! without its lines ([`DrawnSurface`]), as liquid straight from the particles ([`DrawnLiquidParticles`]), and
//! as a plane of colours ([`DrawnSlice`]); foam, spray and bubbles go with all of them ([`DrawnFoam`]).
//! `examples/ways.rs` draws all of them side by side and compares their times.
//!
//! Each thing drawn is a folder with its Rust and its WGSL, which opens with how it works and why not otherwise. Only
//! what WebGPU guarantees is asked for: at most 3 storage buffers per stage, 16-bit floats to blend into, 4 samples.

mod background;
mod bodies;
mod buffers;
mod camera;
mod colour_map;
#[cfg(not(target_arch = "wasm32"))]
mod device;
mod domain;
mod edges;
mod error;
mod foam;
mod frame;
mod globals;
mod liquid;
mod offscreen;
mod overlay;
mod particles;
mod pipeline;
mod recorder;
mod renderer;
mod screen_space;
mod shader;
mod shadow;
mod slice;
mod solids;
mod surface;
mod targets;
mod timer;

pub use buffers::{
    BodyBuffers, Draw, FoamBuffers, ParticleBuffers, SurfaceBuffers, UploadedFoam, UploadedParticles,
    UploadedSurface,
};
pub use camera::Camera;
pub use colour_map::ColourMap;
#[cfg(not(target_arch = "wasm32"))]
pub use device::open_device;
pub use domain::Domain;
pub use error::RenderError;
pub use foam::DrawnFoam;
pub use frame::{Colouring, DrawnParticles, DrawnSurface, Frame, Quantity, SurfaceStyle};
pub use liquid::Liquid;
pub use offscreen::{Offscreen, Ticket};
pub use renderer::Renderer;
pub use screen_space::DrawnLiquidParticles;
pub use slice::{Axis, DrawnSlice};
pub use solids::{PlacedBody, UploadedBodies};
pub use timer::PassTime;
