//! Particles as spheres.
//!
//! # How it works
//! Every particle is a quad, six vertices that pull their particle from the storage buffers, facing the eye in
//! the plane through the sphere's centre. With the centre at distance d, the cone that touches the sphere of
//! radius r cuts this plane in a circle of radius R, R^2 = d^2 r^2 / (d^2 - r^2). The vertex shader hands on q,
//! the place in the plane in units of R. The ray D to that place meets the sphere at s D with |s D - c| = r; as
//! D = c + R q with c and q perpendicular, the discriminant d^4 - |D|^2 (d^2 - r^2) is just d^2 r^2 (1 -
//! |q|^2), so
//!
//! ```text
//! s = d (d - r sqrt(1 - |q|^2)) / |D|^2
//! ```
//!
//! without the cancellation that makes small far spheres flicker. The outline is |q| = 1; the shader tests it
//! at each of the pixel's samples and hands on their mask, so spheres need no sorting. Depth is that of the
//! hit.
//!
//! The number that a particle is coloured by is worked out in the vertex shader and looked up in a texture of 256
//! colours, which also fills the colour bar.
//!
//! Software Vulkan (lavapipe, Mesa 22.3.6) on two cores draws 64,000 of them, a good five pixels across, with
//! background, shadow and four samples at 1280 x 720 in 0.19 s, of which the vertices take a third; 105,000 in
//! 0.27 s.
//!
//! # Why not the other way
//! Instanced quads: software drivers treat each instance as a draw of its own, and four vertices fill no vector
//! unit. Alpha to coverage: lavapipe (Mesa 22.3) writes the depth of samples that it leaves out, and the floor
//! shines through every outline; it also cannot say which samples. A fragment per sample: smooth seams between
//! spheres too, for four times the work. Icospheres: a hundred times the vertices for a rounder interior that
//! nobody sees.
//!
//! # Things we might try
//! Ambient occlusion from the cells of the neighbour search; a triangle instead of the quad (half the vertices, 1.3
//! times the pixels).

use crate::colour_map::ColourTextures;
use crate::pipeline::{Bind, Depth, Recipe, bind_group, bind_group_layout};
use crate::shader::{GLOBALS, QUANTITY, SPHERE, Shader};
use crate::{DrawnParticles, ParticleBuffers};
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, BufferBinding, Device, RenderPass, RenderPipeline,
    TextureFormat,
};

pub(crate) const SHADER: Shader =
    Shader { label: "particles", parts: &[GLOBALS, SPHERE, QUANTITY, include_str!("particles.wgsl")] };

/// Starts of bindings must be multiples of 256 bytes; a multiple of this many particles always is.
const GRAIN: u32 = 256;

#[derive(Debug)]
pub(crate) struct Particles {
    pipeline: RenderPipeline,
    layout: BindGroupLayout,
    colours: ColourTextures,
}

/// Particles that fit into one binding.
#[derive(Debug)]
pub(crate) struct Chunk {
    group: BindGroup,
    count: u32,
}

impl Particles {
    pub fn new(
        device: &Device,
        [globals, environment]: [&BindGroupLayout; 2],
        format: TextureFormat,
        samples: u32,
        colours: ColourTextures,
    ) -> Particles {
        let bindings = [Bind::Storage, Bind::Storage, Bind::Storage, Bind::VertexTexture];
        let layout = bind_group_layout(device, "particles", &bindings);
        let layouts = [globals, environment, &layout];
        let constants = [("SAMPLES", f64::from(samples))];
        let recipe = Recipe {
            samples,
            depth: Some(Depth::TestAndWrite),
            constants: &constants,
            ..Recipe::new(SHADER, &layouts, format)
        };
        Particles { pipeline: recipe.build(device), colours, layout }
    }

    /// Binds the particles, in as many pieces as the device's largest binding asks for.
    pub fn bind(&self, device: &Device, drawn: &DrawnParticles<'_>) -> Vec<Chunk> {
        let colours = self.colours.of(drawn.colouring.map);
        let ParticleBuffers { positions, velocities, densities, count } = drawn.buffers;
        chunks(device, count)
            .map(|(start, count)| Chunk {
                group: bind_group(
                    device,
                    "particles",
                    &self.layout,
                    &[
                        part(positions, 16, start, count),
                        part(velocities, 16, start, count),
                        part(densities, 8, start, count),
                        BindingResource::TextureView(colours),
                    ],
                ),
                count,
            })
            .collect()
    }

    /// Groups 0 (globals) and 1 (environment) are set.
    pub fn record(&self, pass: &mut RenderPass<'_>, chunks: &[Chunk]) {
        pass.set_pipeline(&self.pipeline);
        for chunk in chunks {
            pass.set_bind_group(2, &chunk.group, &[]);
            pass.draw(0..6 * chunk.count, 0..1);
        }
    }
}

/// First particle and number of particles of each piece that one storage binding of this device can hold.
pub(crate) fn chunks(device: &Device, count: u32) -> impl Iterator<Item = (u32, u32)> + use<> {
    chunks_of(device, count, 16)
}

/// The same for particles of so many bytes.
pub(crate) fn chunks_of(
    device: &Device,
    count: u32,
    stride: u64,
) -> impl Iterator<Item = (u32, u32)> + use<> {
    let limits = device.limits();
    // Six vertices for each particle must also stay countable.
    let fitting = (limits.max_storage_buffer_binding_size / stride).min(u64::from(u32::MAX / 6)) as u32;
    let most = (fitting / GRAIN * GRAIN).max(GRAIN);
    (0..count).step_by(most as usize).map(move |start| (start, most.min(count - start)))
}

/// A binding to some elements of a buffer.
pub(crate) fn part(buffer: &wgpu::Buffer, stride: u64, start: u32, count: u32) -> BindingResource<'_> {
    let size = std::num::NonZeroU64::new(stride * u64::from(count));
    BindingResource::Buffer(BufferBinding { buffer, offset: stride * u64::from(start), size })
}
