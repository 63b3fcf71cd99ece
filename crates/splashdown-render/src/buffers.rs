//! References to the GPU buffers that are drawn, for example those of a simulation.

use crate::RenderError;
use crate::chunks::Column;
use wgpu::{Buffer, BufferUsages, Device, IndexFormat, RenderPass};

/// Particles on the GPU. All three buffers need [`BufferUsages::STORAGE`].
#[derive(Clone, Copy, Debug)]
pub struct ParticleBuffers<'a> {
    /// `vec4<f32>` per particle: position in metres, and 0 for an active particle. Particles with
    /// another w and particles whose position is not finite are not drawn.
    pub positions: &'a Buffer,
    /// `vec4<f32>` per particle: velocity in m/s, w ignored.
    pub velocities: &'a Buffer,
    /// `vec2<f32>` per particle: density in kg/m^3, pressure in Pa.
    pub densities: &'a Buffer,
    /// How many particles to draw.
    pub count: u32,
}

/// Foam, spray and bubbles on the GPU.
#[derive(Clone, Copy, Debug)]
pub struct FoamBuffers<'a> {
    /// 32 bytes per particle: position in metres (three `f32`), remaining lifetime in seconds
    /// (`f32`), velocity in m/s (three `f32`), and a tag (`u32`). The tag is `4 * id + kind` with
    /// kind 0 spray, 1 foam, 2 bubble. Needs [`BufferUsages::STORAGE`].
    pub particles: &'a Buffer,
    /// How many particles to draw.
    pub count: u32,
}

/// Droplets on the GPU.
#[derive(Clone, Copy, Debug)]
pub struct DropletBuffers<'a> {
    /// 32 bytes per droplet: position in metres (three `f32`), four bytes that are not read, velocity in m/s (three
    /// `f32`), four bytes that are not read. Needs [`BufferUsages::STORAGE`].
    pub droplets: &'a Buffer,
    /// How many droplets to draw.
    pub count: u32,
}

/// A closed triangle mesh on the GPU, counterclockwise as seen from outside.
///
/// A mesh with holes is drawn too, but its thickness is wrong, and therefore its tint and shadow.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceBuffers<'a> {
    /// `vec4<f32>` per vertex: position in metres, w ignored. Needs [`BufferUsages::VERTEX`].
    pub vertices: &'a Buffer,
    /// `vec4<f32>` per vertex: outward normal of any length, w ignored. Needs
    /// [`BufferUsages::VERTEX`].
    pub normals: &'a Buffer,
    /// Three `u32` per triangle. Needs [`BufferUsages::INDEX`].
    pub indices: &'a Buffer,
    /// How many indices to draw.
    pub draw: Draw<'a>,
}

/// Bodies on the GPU, all in one mesh in world space; made by
/// [`UploadedBodies`](crate::UploadedBodies).
#[derive(Clone, Copy, Debug)]
pub struct BodyBuffers<'a> {
    /// `vec4<f32>` per vertex: position in metres, w ignored. Needs [`BufferUsages::VERTEX`].
    pub vertices: &'a Buffer,
    /// `vec4<f32>` per vertex: normal of any length, w ignored. Needs [`BufferUsages::VERTEX`].
    pub normals: &'a Buffer,
    /// `vec4<f32>` per vertex: linear colour, w ignored. Needs [`BufferUsages::VERTEX`].
    pub colours: &'a Buffer,
    /// Three `u32` per triangle. Needs [`BufferUsages::INDEX`].
    pub indices: &'a Buffer,
    /// How many indices to draw.
    pub draw: Draw<'a>,
}

/// The source of the number of indices.
#[derive(Clone, Copy, Debug)]
pub enum Draw<'a> {
    /// The number is known on the host.
    Direct {
        /// Three times the number of triangles.
        index_count: u32,
    },
    /// The number is in a buffer with [`BufferUsages::INDIRECT`]: five `u32` at this byte offset,
    /// as in [`wgpu::util::DrawIndexedIndirectArgs`]: index count, instance count (1), first index,
    /// base vertex, first instance (0).
    Indirect(&'a Buffer, u64),
}

impl<'a> Draw<'a> {
    /// Checks the index buffer against the number of indices, and the arguments if there are any.
    fn check(&self, indices: &Buffer) -> Result<(), RenderError> {
        let needed = match self {
            Draw::Direct { index_count } => 4 * u64::from(*index_count),
            Draw::Indirect(arguments, offset) => {
                check_buffer("draw arguments", arguments, BufferUsages::INDIRECT, offset + 20)?;
                0
            }
        };
        check_buffer("indices", indices, BufferUsages::INDEX, needed)
    }

    /// Draws an indexed mesh with its vertices in slot 0.
    fn record(&self, pass: &mut RenderPass<'_>, vertices: &Buffer, indices: &Buffer) {
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.set_index_buffer(indices.slice(..), IndexFormat::Uint32);
        match self {
            Draw::Direct { index_count } => pass.draw_indexed(0..*index_count, 0, 0..1),
            Draw::Indirect(arguments, offset) => pass.draw_indexed_indirect(arguments, *offset),
        }
    }
}

impl<'a> ParticleBuffers<'a> {
    /// The positions as a column of [`bind_chunks`](crate::chunks::bind_chunks).
    pub(crate) fn position_column(&self) -> Column<'a> {
        Column { buffer: self.positions, stride: 16 }
    }

    /// Positions, velocities and densities.
    pub(crate) fn columns(&self) -> [Column<'a>; 3] {
        [
            self.position_column(),
            Column { buffer: self.velocities, stride: 16 },
            Column { buffer: self.densities, stride: 8 },
        ]
    }

    pub(crate) fn check(&self) -> Result<(), RenderError> {
        for (what, column) in ["positions", "velocities", "densities"].into_iter().zip(self.columns()) {
            column.check(what, self.count)?;
        }
        Ok(())
    }
}

impl<'a> FoamBuffers<'a> {
    /// The particles as a column of [`bind_chunks`](crate::chunks::bind_chunks).
    pub(crate) fn column(&self) -> Column<'a> {
        Column { buffer: self.particles, stride: 32 }
    }

    pub(crate) fn check(&self) -> Result<(), RenderError> {
        self.column().check("foam", self.count)
    }
}

impl<'a> DropletBuffers<'a> {
    /// The droplets as a column of [`bind_chunks`](crate::chunks::bind_chunks).
    pub(crate) fn column(&self) -> Column<'a> {
        Column { buffer: self.droplets, stride: 32 }
    }

    pub(crate) fn check(&self) -> Result<(), RenderError> {
        self.column().check("droplets", self.count)
    }
}

impl Column<'_> {
    fn check(&self, what: &'static str, count: u32) -> Result<(), RenderError> {
        check_buffer(what, self.buffer, BufferUsages::STORAGE, self.stride * u64::from(count))
    }
}

impl BodyBuffers<'_> {
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        check_buffer("vertices", self.vertices, BufferUsages::VERTEX, 0)?;
        check_buffer("normals", self.normals, BufferUsages::VERTEX, 0)?;
        check_buffer("colours", self.colours, BufferUsages::VERTEX, 0)?;
        self.draw.check(self.indices)
    }

    /// Draws the mesh with its vertices in slot 0.
    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>) {
        self.draw.record(pass, self.vertices, self.indices);
    }
}

/// What is drawn of a surface.
///
/// The wireframe needs vertex and index buffers with [`wgpu::BufferUsages::STORAGE`], and draw
/// arguments with a base vertex of 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SurfaceStyle {
    /// The liquid.
    #[default]
    Liquid,
    /// The liquid and its wireframe.
    LiquidWithLines,
    /// The wireframe alone; edges of back faces are fainter.
    Lines,
}

impl SurfaceBuffers<'_> {
    /// Checks that shaders can read the mesh as storage buffers, which the wireframe requires.
    pub(crate) fn check_style(&self, device: &Device, style: SurfaceStyle) -> Result<(), RenderError> {
        if style == SurfaceStyle::Liquid {
            return Ok(());
        }
        let limit = device.limits().max_storage_buffer_binding_size;
        for (what, buffer) in [("vertices", self.vertices), ("indices", self.indices)] {
            check_buffer(what, buffer, BufferUsages::STORAGE, 0)?;
            if buffer.size() > limit {
                return Err(RenderError::BufferTooLong { what, given: buffer.size(), limit });
            }
        }
        Ok(())
    }

    pub(crate) fn check(&self) -> Result<(), RenderError> {
        check_buffer("vertices", self.vertices, BufferUsages::VERTEX, 0)?;
        check_buffer("normals", self.normals, BufferUsages::VERTEX, 0)?;
        self.draw.check(self.indices)
    }

    /// Draws the mesh with its vertices in slot 0.
    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>) {
        self.draw.record(pass, self.vertices, self.indices);
    }
}

fn check_buffer(
    what: &'static str,
    buffer: &Buffer,
    usage: BufferUsages,
    needed: u64,
) -> Result<(), RenderError> {
    if !buffer.usage().contains(usage) {
        return Err(RenderError::BufferUsage { what, missing: usage - buffer.usage() });
    }
    if buffer.size() < needed {
        return Err(RenderError::BufferTooShort { what, given: buffer.size(), needed });
    }
    Ok(())
}
