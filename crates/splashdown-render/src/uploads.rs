//! Upload of particles and meshes from host slices.

use crate::{Draw, DropletBuffers, FoamBuffers, ParticleBuffers, RenderError, SurfaceBuffers};
use bytemuck::Pod;
use glam::Vec3;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Buffer, BufferUsages, Device};

/// Particles uploaded from the host.
#[derive(Debug)]
pub struct UploadedParticles {
    positions: Buffer,
    velocities: Buffer,
    densities: Buffer,
    count: u32,
}

impl UploadedParticles {
    /// Copies host slices (metres, m/s, kg/m^3, Pa) to the GPU. An empty slice means that the
    /// attribute is absent; its values are then zero.
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
        let mut velocities = padded(velocities);
        velocities.resize(needed, [0.0; 4]);
        Ok(UploadedParticles {
            positions: upload(device, "positions", &padded(positions), BufferUsages::STORAGE),
            velocities: upload(device, "velocities", &velocities, BufferUsages::STORAGE),
            densities: upload(device, "densities", &pairs, BufferUsages::STORAGE),
            count: needed as u32,
        })
    }

    /// The buffers, for example for [`DrawnParticles`](crate::DrawnParticles).
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
    /// Copies host slices to the GPU.
    ///
    /// * `positions`: metres.
    /// * `lifetimes`: remaining lifetimes in seconds; if empty, unlimited.
    /// * `ids`: particles with different ids differ in size and shape; if empty, the index is the id.
    /// * `kinds`: 0 spray, 1 foam, 2 bubble.
    ///
    /// # Errors
    /// [`RenderError::Length`] if `kinds`, or another slice that is not empty, differs in length
    /// from `positions`.
    pub fn new(
        device: &Device,
        positions: &[[f32; 3]],
        lifetimes: &[f32],
        ids: &[u32],
        kinds: &[u32],
    ) -> Result<UploadedFoam, RenderError> {
        UploadedFoam::moving(device, positions, &[], lifetimes, ids, kinds)
    }

    /// As [`new`](Self::new), with velocities in m/s for motion blur; if empty, the particles rest.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn moving(
        device: &Device,
        positions: &[[f32; 3]],
        velocities: &[[f32; 3]],
        lifetimes: &[f32],
        ids: &[u32],
        kinds: &[u32],
    ) -> Result<UploadedFoam, RenderError> {
        let needed = positions.len();
        check_length("velocities", velocities.len(), needed)?;
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
                let [u, v, w] = velocities.get(i).copied().unwrap_or_default().map(f32::to_bits);
                [x, y, z, lifetime, u, v, w, id << 2 | (kinds[i] & 3)]
            })
            .collect();
        Ok(UploadedFoam {
            particles: upload(device, "foam", &rows, BufferUsages::STORAGE),
            count: needed as u32,
        })
    }

    /// The buffers, for [`DrawnFoam`](crate::DrawnFoam).
    pub fn buffers(&self) -> FoamBuffers<'_> {
        FoamBuffers { particles: &self.particles, count: self.count }
    }
}

/// Droplets uploaded from the host.
#[derive(Debug)]
pub struct UploadedDroplets {
    droplets: Buffer,
    count: u32,
}

impl UploadedDroplets {
    /// Copies positions (metres) and velocities (m/s) to the GPU. If `velocities` is empty, the droplets rest.
    ///
    /// # Errors
    /// [`RenderError::Length`] if there are velocities, but not one per droplet.
    pub fn new(
        device: &Device,
        positions: &[[f32; 3]],
        velocities: &[[f32; 3]],
    ) -> Result<UploadedDroplets, RenderError> {
        check_length("velocities", velocities.len(), positions.len())?;
        let rows: Vec<[f32; 8]> = (0..positions.len())
            .map(|i| {
                let [x, y, z] = positions[i];
                let [u, v, w] = velocities.get(i).copied().unwrap_or_default();
                [x, y, z, 0.0, u, v, w, 0.0]
            })
            .collect();
        let count = rows.len() as u32;
        Ok(UploadedDroplets { droplets: upload(device, "droplets", &rows, BufferUsages::STORAGE), count })
    }

    /// The buffers, for [`DrawnDroplets`](crate::DrawnDroplets).
    pub fn buffers(&self) -> DropletBuffers<'_> {
        DropletBuffers { droplets: &self.droplets, count: self.count }
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
    /// Copies a mesh (metres) to the GPU. If `normals` is empty, the normals of a vertex's
    /// triangles are averaged, weighted by area.
    ///
    /// # Errors
    /// [`RenderError::Length`] if there are normals, but not one per vertex; [`RenderError::Index`]
    /// if a triangle refers to a vertex that does not exist.
    pub fn new(
        device: &Device,
        vertices: &[[f32; 3]],
        normals: &[[f32; 3]],
        triangles: &[[u32; 3]],
    ) -> Result<UploadedSurface, RenderError> {
        check_length("normals", normals.len(), vertices.len())?;
        check_indices(triangles, vertices.len())?;
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

    /// The buffers, for [`DrawnSurface`](crate::DrawnSurface).
    pub fn buffers(&self) -> SurfaceBuffers<'_> {
        SurfaceBuffers {
            vertices: &self.vertices,
            normals: &self.normals,
            indices: &self.indices,
            draw: Draw::Direct { index_count: self.index_count },
        }
    }
}

/// Refuses triangles that refer to vertices that do not exist.
pub(crate) fn check_indices(triangles: &[[u32; 3]], vertices: usize) -> Result<(), RenderError> {
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= vertices) {
            return Err(RenderError::Index { triangle, vertex, vertices });
        }
    }
    Ok(())
}

pub(crate) fn check_length(what: &'static str, given: usize, needed: usize) -> Result<(), RenderError> {
    if given == 0 || given == needed { Ok(()) } else { Err(RenderError::Length { what, given, needed }) }
}

fn padded(vectors: &[[f32; 3]]) -> Vec<[f32; 4]> {
    vectors.iter().map(|&[x, y, z]| [x, y, z, 0.0]).collect()
}

pub(crate) fn upload<T: Pod>(device: &Device, label: &str, values: &[T], usage: BufferUsages) -> Buffer {
    // WebGPU has no empty bindings; an empty slice becomes 16 zero bytes.
    let bytes = if values.is_empty() { &[0; 16] } else { bytemuck::cast_slice(values) };
    device.create_buffer_init(&BufferInitDescriptor { label: Some(label), contents: bytes, usage })
}

pub(crate) fn area_weighted_normals(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[f32; 4]> {
    let mut sums = vec![Vec3::ZERO; vertices.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| Vec3::from(vertices[corner as usize]));
        // The length is twice the area of the triangle.
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
        // A tetrahedron around the origin, counterclockwise as seen from outside.
        let vertices = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        let triangles = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
        for (vertex, normal) in vertices.iter().zip(area_weighted_normals(&vertices, &triangles)) {
            let (out, normal) =
                (Vec3::from(*vertex).normalize_or_zero(), Vec3::new(normal[0], normal[1], normal[2]));
            assert!(out.dot(normal) > 0.999, "{out} {normal}");
        }
        // Negative control: inverted orientation.
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
