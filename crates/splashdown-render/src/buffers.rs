//! The GPU buffers that are drawn, straight from where a simulation left them, and their upload from host slices.

use crate::{RenderError, SurfaceStyle};
use bytemuck::Pod;
use glam::Vec3;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Buffer, BufferUsages, Device};

/// Particles on the GPU. All three buffers need [`BufferUsages::STORAGE`].
#[derive(Clone, Copy, Debug)]
pub struct ParticleBuffers<'a> {
    /// `vec4<f32>` per particle: position in metres; w is 0, or anything else for a particle that is not in
    /// play. Neither those nor particles that are not finite are drawn.
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
    /// 32 bytes per particle: its position in metres (three `f32`), how long it still lives in seconds (`f32`),
    /// its velocity in m/s (three `f32`), and any number times four plus its kind (`u32`): 0 spray, 1 foam, 2 a
    /// bubble. Needs [`BufferUsages::STORAGE`].
    pub particles: &'a Buffer,
    /// How many particles to draw.
    pub count: u32,
}

/// A closed triangle mesh on the GPU, counterclockwise seen from outside.
///
/// A mesh with holes is drawn too, but its thickness, and with that its tint and shadow, means nothing.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceBuffers<'a> {
    /// `vec4<f32>` per vertex: position in metres, w ignored. Needs [`BufferUsages::VERTEX`].
    pub vertices: &'a Buffer,
    /// `vec4<f32>` per vertex: outward normal of any length, w ignored. Needs [`BufferUsages::VERTEX`].
    pub normals: &'a Buffer,
    /// Three `u32` per triangle. Needs [`BufferUsages::INDEX`].
    pub indices: &'a Buffer,
    /// How many of them to draw.
    pub draw: Draw<'a>,
}

/// Solids on the GPU, all in one mesh in world space. [`UploadedBodies`](crate::UploadedBodies) makes them.
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
    /// How many of them to draw; [`Draw::Direct`].
    pub draw: Draw<'a>,
}

/// Where the number of indices comes from.
#[derive(Clone, Copy, Debug)]
pub enum Draw<'a> {
    /// Known to the host.
    Direct {
        /// Three times the number of triangles.
        index_count: u32,
    },
    /// Five `u32` at this byte offset of a buffer with [`BufferUsages::INDIRECT`], as in
    /// [`wgpu::util::DrawIndexedIndirectArgs`]: index count, instances (1), first index, base vertex, first
    /// instance (0).
    Indirect(&'a Buffer, u64),
}

impl ParticleBuffers<'_> {
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        let count = u64::from(self.count);
        check_buffer("positions", self.positions, BufferUsages::STORAGE, 16 * count)?;
        check_buffer("velocities", self.velocities, BufferUsages::STORAGE, 16 * count)?;
        check_buffer("densities", self.densities, BufferUsages::STORAGE, 8 * count)
    }
}

impl FoamBuffers<'_> {
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        check_buffer("foam", self.particles, BufferUsages::STORAGE, 32 * u64::from(self.count))
    }
}

impl BodyBuffers<'_> {
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        check_buffer("vertices", self.vertices, BufferUsages::VERTEX, 0)?;
        check_buffer("normals", self.normals, BufferUsages::VERTEX, 0)?;
        check_buffer("colours", self.colours, BufferUsages::VERTEX, 0)?;
        let Draw::Direct { index_count } = self.draw else { return Ok(()) };
        check_buffer("indices", self.indices, BufferUsages::INDEX, 4 * u64::from(index_count))
    }
}

impl SurfaceBuffers<'_> {
    /// Whether shaders can read the mesh themselves, which lines need.
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
        let needed = match self.draw {
            Draw::Direct { index_count } => 4 * u64::from(index_count),
            Draw::Indirect(arguments, offset) => {
                check_buffer("draw arguments", arguments, BufferUsages::INDIRECT, offset + 20)?;
                0
            }
        };
        check_buffer("indices", self.indices, BufferUsages::INDEX, needed)
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

/// Particles uploaded from the host.
#[derive(Debug)]
pub struct UploadedParticles {
    positions: Buffer,
    velocities: Buffer,
    densities: Buffer,
    count: u32,
}

impl UploadedParticles {
    /// Copies host slices (metres, m/s, kg/m^3, Pa) to the GPU. An empty slice means that the attribute is absent; it
    /// is drawn as zero.
    ///
    /// # Errors
    /// [`RenderError::Length`] if a slice that is not empty differs in length from `positions`.
    pub fn new(
        device: &Device,
        positions: &[[f32; 3]],
        velocities: &[[f32; 3]],
        densities: &[f32],
        pressures: &[f32],
    ) -> Result<UploadedParticles, RenderError> {
        let needed = positions.len();
        check_length("velocities", velocities.len(), needed)?;
        check_length("densities", densities.len(), needed)?;
        check_length("pressures", pressures.len(), needed)?;
        let scalar = |values: &[f32], index: usize| values.get(index).copied().unwrap_or(0.0);
        let pairs: Vec<[f32; 2]> =
            (0..needed).map(|i| [scalar(densities, i), scalar(pressures, i)]).collect();
        let mut fast = padded(velocities);
        fast.resize(needed, [0.0; 4]);
        Ok(UploadedParticles {
            positions: upload(device, "positions", &padded(positions), BufferUsages::STORAGE),
            velocities: upload(device, "velocities", &fast, BufferUsages::STORAGE),
            densities: upload(device, "densities", &pairs, BufferUsages::STORAGE),
            count: needed as u32,
        })
    }

    /// The buffers, to be drawn.
    pub fn buffers(&self) -> ParticleBuffers<'_> {
        ParticleBuffers {
            positions: &self.positions,
            velocities: &self.velocities,
            densities: &self.densities,
            count: self.count,
        }
    }
}

/// Foam, spray and bubbles uploaded from the host.
#[derive(Debug)]
pub struct UploadedFoam {
    particles: Buffer,
    count: u32,
}

impl UploadedFoam {
    /// Copies host slices to the GPU: places in metres, how long each still lives in seconds (an empty slice:
    /// for long), numbers by which particles differ a little in size (an empty slice: their places in the
    /// list), kinds (0 spray, 1 foam, 2 bubble).
    ///
    /// # Errors
    /// [`RenderError::Length`] if a slice differs in length from `positions`, where it may not be empty or is not.
    pub fn new(
        device: &Device,
        positions: &[[f32; 3]],
        lifetimes: &[f32],
        ids: &[u32],
        kinds: &[u32],
    ) -> Result<UploadedFoam, RenderError> {
        let needed = positions.len();
        check_length("lifetimes", lifetimes.len(), needed)?;
        check_length("ids", ids.len(), needed)?;
        if kinds.len() != needed {
            return Err(RenderError::Length { what: "kinds", given: kinds.len(), needed });
        }
        let rows: Vec<[u32; 8]> = (0..needed)
            .map(|i| {
                let [x, y, z] = positions[i].map(f32::to_bits);
                let lifetime = lifetimes.get(i).copied().unwrap_or(f32::MAX).to_bits();
                let id = ids.get(i).copied().unwrap_or(i as u32);
                [x, y, z, lifetime, 0, 0, 0, id << 2 | (kinds[i] & 3)]
            })
            .collect();
        Ok(UploadedFoam {
            particles: upload(device, "foam", &rows, BufferUsages::STORAGE),
            count: needed as u32,
        })
    }

    /// The buffers, to be drawn.
    pub fn buffers(&self) -> FoamBuffers<'_> {
        FoamBuffers { particles: &self.particles, count: self.count }
    }
}

/// A mesh uploaded from the host.
#[derive(Debug)]
pub struct UploadedSurface {
    vertices: Buffer,
    normals: Buffer,
    indices: Buffer,
    index_count: u32,
}

impl UploadedSurface {
    /// Copies a mesh (metres) to the GPU. Without normals, those of the triangles are averaged by area.
    ///
    /// # Errors
    /// [`RenderError::Length`] if there are normals, but not one per vertex; [`RenderError::Index`] if a triangle names
    /// a vertex that does not exist.
    pub fn new(
        device: &Device,
        vertices: &[[f32; 3]],
        normals: &[[f32; 3]],
        triangles: &[[u32; 3]],
    ) -> Result<UploadedSurface, RenderError> {
        check_length("normals", normals.len(), vertices.len())?;
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= vertices.len()) {
                return Err(RenderError::Index { triangle, vertex, vertices: vertices.len() });
            }
        }
        let normals = match normals.is_empty() {
            true => area_weighted_normals(vertices, triangles),
            false => padded(normals),
        };
        Ok(UploadedSurface {
            vertices: upload(
                device,
                "vertices",
                &padded(vertices),
                BufferUsages::VERTEX | BufferUsages::STORAGE,
            ),
            normals: upload(device, "normals", &normals, BufferUsages::VERTEX),
            indices: upload(device, "indices", triangles, BufferUsages::INDEX | BufferUsages::STORAGE),
            index_count: 3 * triangles.len() as u32,
        })
    }

    /// The buffers, to be drawn.
    pub fn buffers(&self) -> SurfaceBuffers<'_> {
        SurfaceBuffers {
            vertices: &self.vertices,
            normals: &self.normals,
            indices: &self.indices,
            draw: Draw::Direct { index_count: self.index_count },
        }
    }
}

fn check_length(what: &'static str, given: usize, needed: usize) -> Result<(), RenderError> {
    if given == 0 || given == needed { Ok(()) } else { Err(RenderError::Length { what, given, needed }) }
}

fn padded(vectors: &[[f32; 3]]) -> Vec<[f32; 4]> {
    vectors.iter().map(|&[x, y, z]| [x, y, z, 0.0]).collect()
}

pub(crate) fn upload<T: Pod>(device: &Device, label: &str, values: &[T], usage: BufferUsages) -> Buffer {
    // WebGPU has no empty bindings; one element's worth of zeros stands for an empty buffer.
    let bytes = if values.is_empty() { &[0; 16] } else { bytemuck::cast_slice(values) };
    device.create_buffer_init(&BufferInitDescriptor { label: Some(label), contents: bytes, usage })
}

fn area_weighted_normals(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[f32; 4]> {
    let mut sums = vec![Vec3::ZERO; vertices.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| Vec3::from(vertices[corner as usize]));
        // Twice the area long.
        let normal = (b - a).cross(c - a);
        for &corner in corners {
            sums[corner as usize] += normal;
        }
    }
    sums.into_iter().map(|sum| sum.normalize_or_zero().extend(0.0).to_array()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averaged_normals_point_outward() {
        // A tetrahedron around the origin, counterclockwise from outside.
        let vertices = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        let triangles = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
        for (vertex, normal) in vertices.iter().zip(area_weighted_normals(&vertices, &triangles)) {
            let (out, normal) =
                (Vec3::from(*vertex).normalize_or_zero(), Vec3::new(normal[0], normal[1], normal[2]));
            assert!(out.dot(normal) > 0.999, "{out} {normal}");
        }
        // Negative control: turned inside out.
        let inside_out = triangles.map(|[a, b, c]| [a, c, b]);
        let normal = area_weighted_normals(&vertices, &inside_out)[0];
        assert!(normal[0] < 0.0);
    }

    #[test]
    fn lengths_must_agree_unless_the_attribute_is_absent() {
        assert!(check_length("velocities", 0, 7).is_ok());
        assert!(check_length("velocities", 7, 7).is_ok());
        assert!(
            check_length("velocities", 6, 7)
                .unwrap_err()
                .to_string()
                .contains("has 6 elements; it must have 7")
        );
    }
}
