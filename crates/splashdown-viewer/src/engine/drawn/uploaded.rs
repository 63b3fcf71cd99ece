//! A frame that was read from files, in the buffers that are drawn.

use splashdown::surface::SurfaceStats;
use splashdown_io::Particles;
use splashdown_render::{RenderError, UploadedDroplets, UploadedFoam, UploadedParticles, UploadedSurface};
use splashdown_run::PlayedFrame;

use super::{Drawn, DrawnMesh};

impl Drawn {
    /// Copies a frame to the device that draws.
    ///
    /// # Errors
    /// [`RenderError`] if the arrays of a file do not fit together.
    pub fn of_frame(device: &wgpu::Device, frame: &PlayedFrame) -> Result<Self, RenderError> {
        let none = Particles::default();
        let particles = frame.particles.as_ref().unwrap_or(&none);
        let uploaded = UploadedParticles::new(
            device,
            &particles.positions,
            &particles.velocities,
            &particles.densities,
            &particles.pressures,
        )?;
        let buffers = uploaded.buffers();
        let droplets = match frame.droplets.as_ref().filter(|droplets| !droplets.is_empty()) {
            Some(droplets) => {
                let uploaded = UploadedDroplets::new(device, &droplets.positions, &droplets.velocities)?;
                let buffers = uploaded.buffers();
                Some((buffers.droplets.clone(), buffers.count))
            }
            None => None,
        };
        let mesh = match &frame.mesh {
            Some(mesh) => {
                let uploaded = UploadedSurface::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles)?;
                let buffers = uploaded.buffers();
                let mut stats = SurfaceStats::default();
                (stats.vertices, stats.triangles) = (mesh.vertices.len() as u32, mesh.triangles.len() as u32);
                stats.droplets = droplets.as_ref().map_or(0, |(_, count)| *count);
                Some(DrawnMesh {
                    vertices: buffers.vertices.clone(),
                    normals: buffers.normals.clone(),
                    indices: buffers.indices.clone(),
                    arguments: None,
                    stats,
                })
            }
            None => None,
        };
        let foam = match &frame.foam {
            Some(foam) => {
                let kinds: Vec<u32> = foam.kinds.iter().map(|&kind| kind as u32).collect();
                let (positions, velocities) = (&foam.positions, &foam.velocities);
                let uploaded =
                    UploadedFoam::moving(device, positions, velocities, &foam.lifetimes, &foam.ids, &kinds)?;
                let buffers = uploaded.buffers();
                Some((buffers.particles.clone(), buffers.count))
            }
            None => None,
        };
        Ok(Self {
            positions: buffers.positions.clone(),
            velocities: buffers.velocities.clone(),
            densities: buffers.densities.clone(),
            count: buffers.count,
            mesh,
            droplets,
            foam,
        })
    }
}
