//! Drawing one frame.

use std::sync::Arc;

use splashdown::scene::{Camera, Output, PictureKind, Scene};
use splashdown::{BodyMesh, BodyState};
use splashdown_gpu::Gpu;
use splashdown_io::{Particles, Picture};
use splashdown_render::{
    Colouring, DrawnParticles, DrawnSurface, Frame, Liquid, Offscreen, PlacedBody, Quality, RenderError,
    Renderer, Ticket, TracedMeshes, UploadedBodies, UploadedDroplets, UploadedFoam, UploadedParticles,
    UploadedSurface,
};

use super::{FrameData, motion};
use crate::{PictureTimings, RunError, appearance};

// Both crates check sizes: the scene before a device is opened.
const _: () = assert!(Output::MAX_SIDE == Offscreen::MAX_SIDE && Output::MAX_PIXELS == Offscreen::MAX_PIXELS);

/// Draws frames on a device.
pub struct FrameRenderer {
    gpu: Arc<Gpu>,
    scene: Scene,
    /// The camera of the present picture.
    camera: Camera,
    kinds: Vec<PictureKind>,
    renderer: Renderer,
    target: Offscreen,
    colouring: Colouring,
    liquid: Liquid,
    bodies: Vec<PlacedBody>,
    /// Pictures since the times of the passes were taken.
    measured: u64,
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
        let (scene, camera) = (scene.clone(), scene.camera);
        Ok(Self { gpu, scene, camera, kinds, renderer, target, colouring, liquid, bodies, measured: 0 })
    }

    /// Measures the passes of the pictures from now on. Returns false if the device has no timestamps.
    pub fn enable_timing(&mut self) -> bool {
        self.renderer.set_timing(true)
    }

    /// The times of the passes since the last call.
    pub fn take_timings(&mut self) -> PictureTimings {
        PictureTimings { pictures: std::mem::take(&mut self.measured), passes: self.renderer.take_timings() }
    }

    /// Opens the shutter for a time that is shorter by this factor from now on.
    pub fn shorten_exposure(&mut self, factor: f32) {
        // The frame rate determines nothing else in a picture.
        self.scene.frame_rate *= factor;
    }

    /// Draws one picture per kind from the scene's camera.
    ///
    /// # Errors
    /// [`RunError::Render`]; [`RunError::Gpu`] if the device was lost.
    pub fn draw(&mut self, data: &FrameData) -> Result<Vec<Arc<Picture>>, RunError> {
        self.draw_from(data, self.scene.camera_at(data.time))
    }

    /// As [`draw`](Self::draw), from this camera.
    ///
    /// # Errors
    /// As [`draw`](Self::draw).
    pub fn draw_from(&mut self, data: &FrameData, camera: Camera) -> Result<Vec<Arc<Picture>>, RunError> {
        self.camera = camera;
        let pictures = self.pictures(data)?;
        self.measured += pictures.len() as u64;
        self.gpu.health("a picture")?;
        Ok(pictures)
    }

    /// One picture per kind. All are submitted before waiting for the first.
    fn pictures(&mut self, data: &FrameData) -> Result<Vec<Arc<Picture>>, RenderError> {
        let mut tickets = Vec::new();
        for kind in self.kinds.clone() {
            tickets.push(match kind {
                PictureKind::Particles => self.submit_particles(data)?,
                PictureKind::Surface => self.submit_surface(data)?,
            });
        }
        let [width, height] = self.target.size();
        let collect =
            |ticket| self.target.collect(ticket).map(|rgba| Arc::new(Picture { width, height, rgba }));
        tickets.into_iter().map(collect).collect()
    }

    fn submit_particles(&mut self, data: &FrameData) -> Result<Ticket, RenderError> {
        let Particles { positions, velocities, densities, pressures, .. } = &*data.particles;
        let device = &self.gpu.device;
        let particles = UploadedParticles::new(device, positions, velocities, densities, pressures)?;
        let foam = upload_foam(&self.gpu, data)?;
        let bodies = self.upload_bodies(&data.bodies, 0.0);
        let caption = appearance::caption(&self.scene, data.time);
        let radius = self.scene.fluid.particle_radius();
        let mut frame = self.empty_frame(&caption, foam.as_ref());
        frame.bodies = bodies.as_ref().map(UploadedBodies::buffers);
        frame.particles = Some(DrawnParticles::new(particles.buffers(), radius, self.colouring));
        self.target.submit(&mut self.renderer, &frame)
    }

    /// Submits the liquid. If it or bodies move while the shutter is open, the samples are drawn at several moments.
    fn submit_surface(&mut self, data: &FrameData) -> Result<Ticket, RenderError> {
        let device = &self.gpu.device;
        let droplets = match data.droplets.as_ref().filter(|_| data.mesh.is_some()) {
            Some(droplets) => Some(UploadedDroplets::new(device, &droplets.positions, &droplets.velocities)?),
            None => None,
        };
        let foam = upload_foam(&self.gpu, data)?;
        let caption = appearance::caption(&self.scene, data.time);
        let quality = self.quality().filter(|_| data.mesh.is_some());
        let parts = match (&data.mesh, quality) {
            (Some(mesh), Some(Quality { shutter, samples, .. })) => {
                let spacing = self.scene.fluid.particle_spacing;
                motion::moments(mesh, &data.bodies, shutter, samples, spacing)
            }
            _ => 1,
        };
        let samples = quality.map_or(1, |quality| quality.samples);
        let mut part = 0;
        loop {
            let [first, end] = [part, part + 1].map(|part| samples * part / parts);
            let time = match quality {
                Some(quality) if parts > 1 => 0.5 * (quality.time(first) + quality.time(end - 1)),
                _ => 0.0,
            };
            let moment = self.moment(data, quality, time)?;
            let mut frame = self.empty_frame(&caption, foam.as_ref());
            frame.bodies = moment.bodies.as_ref().map(UploadedBodies::buffers);
            frame.surface =
                moment.surface.as_ref().map(|surface| DrawnSurface::new(surface.buffers(), self.liquid));
            frame.droplets = droplets
                .as_ref()
                .map(|droplets| appearance::droplets(&self.scene, droplets.buffers(), self.liquid));
            frame.traced = moment.traced.as_ref().zip(quality);
            if parts == 1 {
                return self.target.submit(&mut self.renderer, &frame);
            }
            part += 1;
            if end < samples {
                self.target.submit_samples(&mut self.renderer, &frame, first..end)?;
            } else if let Some(ticket) = self.target.submit_from(&mut self.renderer, &frame, first)? {
                return Ok(ticket);
            } else {
                // A large picture is drawn tile by tile, each from all moments.
                part = 0;
            }
        }
    }

    /// The scene's quality. The lens suits the distance of the camera.
    fn quality(&self) -> Option<Quality> {
        let mut quality = appearance::quality(&self.scene, self.scene.output.quality)?;
        quality.aperture *= self.camera.distance / self.scene.camera.distance;
        Some(quality)
    }

    /// Everything of a frame that liquid and particles have in common, without bodies.
    fn empty_frame<'a>(&self, caption: &'a str, foam: Option<&'a UploadedFoam>) -> Frame<'a> {
        let camera = appearance::placed_camera(&self.camera);
        let mut frame = appearance::empty_frame(&self.scene, camera).with_caption(caption);
        frame.foam = foam.map(|foam| appearance::foam(&self.scene, foam.buffers()));
        frame
    }

    /// Liquid and bodies at a time in s, relative to the frame.
    fn moment(&self, data: &FrameData, quality: Option<Quality>, time: f32) -> Result<Moment, RenderError> {
        let device = &self.gpu.device;
        let bodies = self.upload_bodies(&data.bodies, time);
        let Some(mesh) = &data.mesh else { return Ok(Moment { surface: None, bodies, traced: None }) };
        let moved = (time != 0.0 && !mesh.velocities.is_empty())
            .then(|| motion::moved(mesh, &appearance::domain(&self.scene), time));
        let vertices = moved.as_deref().unwrap_or(&mesh.vertices);
        let surface = UploadedSurface::new(device, vertices, &mesh.normals, &mesh.triangles)?;
        let traced = match quality {
            Some(_) => {
                let bodies = placed(&self.bodies, &data.bodies, time);
                Some(TracedMeshes::new(device, vertices, &mesh.normals, &mesh.triangles, bodies)?)
            }
            None => None,
        };
        Ok(Moment { surface: Some(surface), bodies, traced })
    }

    fn upload_bodies(&self, states: &[BodyState], time: f32) -> Option<UploadedBodies> {
        let placed = placed(&self.bodies, states, time);
        (!self.bodies.is_empty()).then(|| UploadedBodies::new(&self.gpu.device, placed))
    }
}

/// Bodies with their places at a time in s, relative to that of the states.
fn placed<'a>(
    bodies: &'a [PlacedBody],
    states: &'a [BodyState],
    time: f32,
) -> impl Iterator<Item = (&'a PlacedBody, [f32; 3], [f32; 4])> {
    bodies.iter().zip(states).map(move |(body, state)| {
        let (position, orientation) = motion::moved_body(state, time);
        (body, position, orientation)
    })
}

/// What is drawn of the liquid and bodies at one moment.
struct Moment {
    surface: Option<UploadedSurface>,
    bodies: Option<UploadedBodies>,
    traced: Option<TracedMeshes>,
}

fn upload_foam(gpu: &Gpu, data: &FrameData) -> Result<Option<UploadedFoam>, RenderError> {
    let Some(foam) = &data.foam else { return Ok(None) };
    let kinds: Vec<u32> = foam.kinds.iter().map(|&kind| kind as u32).collect();
    let (positions, velocities) = (&foam.positions, &foam.velocities);
    UploadedFoam::moving(&gpu.device, positions, velocities, &foam.lifetimes, &foam.ids, &kinds).map(Some)
}
