//! Drawing one frame.

use std::sync::Arc;

use splashdown::BodyMesh;
use splashdown::scene::{Camera, PictureKind, Scene};
use splashdown_gpu::Gpu;
use splashdown_io::{Particles, Picture};
use splashdown_render::{
    Colouring, DrawnFoam, DrawnParticles, DrawnSurface, Liquid, Offscreen, PlacedBody, RenderError, Renderer,
    TracedMeshes, UploadedBodies, UploadedDroplets, UploadedFoam, UploadedParticles, UploadedSurface,
};

use super::FrameData;
use crate::{RunError, appearance};

/// Draws frames on a device.
pub struct FrameRenderer {
    gpu: Arc<Gpu>,
    scene: Scene,
    kinds: Vec<PictureKind>,
    renderer: Renderer,
    target: Offscreen,
    colouring: Colouring,
    liquid: Liquid,
    bodies: Vec<PlacedBody>,
}

impl FrameRenderer {
    /// Prepares the device for the scene's pictures.
    ///
    /// # Errors
    /// [`RenderError`] if it cannot draw pictures of this size.
    pub fn new(
        gpu: Arc<Gpu>,
        scene: &Scene,
        bodies: &[BodyMesh],
        kinds: Vec<PictureKind>,
    ) -> Result<Self, RenderError> {
        let renderer = Renderer::new(&gpu.device, &gpu.queue, Offscreen::FORMAT, 4)?;
        let target = Offscreen::new(&gpu.device, &gpu.queue, scene.output.picture_size)?;
        let colouring = appearance::colouring(scene, scene.output.colour_by);
        let liquid = appearance::liquid(scene);
        let place = |body: &BodyMesh| {
            let colour = body.colour.unwrap_or(PlacedBody::COLOUR);
            PlacedBody::new(&body.mesh.vertices, &body.mesh.triangles, colour)
        };
        let bodies = bodies.iter().map(place).collect::<Result<_, _>>()?;
        Ok(Self { gpu, scene: scene.clone(), kinds, renderer, target, colouring, liquid, bodies })
    }

    /// Looks from another camera from now on.
    pub fn set_camera(&mut self, camera: Camera) {
        self.scene.camera = camera;
    }

    /// Draws one picture per kind.
    ///
    /// # Errors
    /// [`RunError::Render`]; [`RunError::Gpu`] if the device was lost.
    pub fn draw(&mut self, data: &FrameData) -> Result<Vec<Arc<Picture>>, RunError> {
        let pictures = self.pictures(data)?;
        self.gpu.health("a picture")?;
        Ok(pictures)
    }

    /// One picture per kind. All are submitted before waiting for the first.
    fn pictures(&mut self, data: &FrameData) -> Result<Vec<Arc<Picture>>, RenderError> {
        let device = &self.gpu.device;
        let Particles { positions, velocities, densities, pressures, .. } = &*data.particles;
        let particles = match self.kinds.contains(&PictureKind::Particles) {
            true => Some(UploadedParticles::new(device, positions, velocities, densities, pressures)?),
            false => None,
        };
        let mesh = data.mesh.as_ref().filter(|_| self.kinds.contains(&PictureKind::Surface));
        let surface = match mesh {
            Some(mesh) => Some(UploadedSurface::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles)?),
            None => None,
        };
        let droplets = match data.droplets.as_ref().filter(|_| mesh.is_some()) {
            Some(droplets) => Some(UploadedDroplets::new(device, &droplets.positions, &droplets.velocities)?),
            None => None,
        };
        let foam = match &data.foam {
            Some(foam) => {
                let kinds: Vec<u32> = foam.kinds.iter().map(|&kind| kind as u32).collect();
                let (positions, velocities) = (&foam.positions, &foam.velocities);
                Some(UploadedFoam::moving(device, positions, velocities, &foam.lifetimes, &foam.ids, &kinds)?)
            }
            None => None,
        };
        let placed = self.bodies.iter().zip(&*data.bodies);
        let bodies = (!self.bodies.is_empty()).then(|| {
            UploadedBodies::new(
                device,
                placed.map(|(body, state)| (body, state.position.to_array(), state.orientation.to_array())),
            )
        });
        let quality = appearance::quality(&self.scene, self.scene.output.quality);
        let traced = match (mesh, quality) {
            (Some(mesh), Some(quality)) => {
                let placed = self.bodies.iter().zip(&*data.bodies);
                let bodies = placed
                    .map(|(body, state)| (body, state.position.to_array(), state.orientation.to_array()));
                let meshes =
                    TracedMeshes::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles, bodies)?;
                Some((meshes, quality))
            }
            _ => None,
        };
        let caption = appearance::caption(&self.scene, data.time);
        let radius = self.scene.fluid.particle_radius();
        let camera = appearance::camera(&self.scene, data.time);
        let mut empty = appearance::empty_frame(&self.scene, camera).with_caption(&caption);
        empty.bodies = bodies.as_ref().map(UploadedBodies::buffers);
        empty.foam = foam.as_ref().map(|foam| DrawnFoam::new(foam.buffers(), radius));
        let mut tickets = Vec::new();
        for kind in &self.kinds {
            let mut frame = empty;
            match kind {
                PictureKind::Particles => {
                    frame.particles = particles
                        .as_ref()
                        .map(|particles| DrawnParticles::new(particles.buffers(), radius, self.colouring));
                }
                PictureKind::Surface => {
                    frame.surface =
                        surface.as_ref().map(|surface| DrawnSurface::new(surface.buffers(), self.liquid));
                    frame.droplets = droplets
                        .as_ref()
                        .map(|droplets| appearance::droplets(&self.scene, droplets.buffers(), self.liquid));
                    frame.traced = traced.as_ref().map(|(meshes, quality)| (meshes, *quality));
                }
            }
            tickets.push(self.target.submit(&mut self.renderer, &frame)?);
        }
        let [width, height] = self.target.size();
        let collect =
            |ticket| self.target.collect(ticket).map(|rgba| Arc::new(Picture { width, height, rgba }));
        tickets.into_iter().map(collect).collect()
    }
}
