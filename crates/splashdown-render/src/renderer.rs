//! The order in which a picture comes together.

use crate::background::Background;
use crate::bodies::Bodies;
use crate::edges::Edges;
use crate::overlay::Overlay;
use crate::particles::Particles;
use crate::pipeline::{Bind, bind_group, bind_group_layout};
use crate::recorder::{End, Recorder, Start};
use crate::screen_space::ScreenSpace;
use crate::shadow::Shadow;
use crate::surface::Surface;
use crate::targets::Targets;
use crate::{Frame, RenderError};
use wgpu::{
    BindGroup, BindGroupLayout, BufferUsages, Color, CommandEncoder, Device, Queue, RenderPass,
    TextureFormat, TextureView,
};

/// Draws frames into textures of one format. Make one and keep it: it holds the pipelines.
///
/// The passes of a picture, in their order:
///
/// 1. the fluid's shadow on the floor (256 x 256, blurred);
/// 2. background, hidden edges, solids, particles; with a liquid also a copy to look through, the liquid's thickness, then its
///    surface, from a mesh or from smoothed distances; near edges; several samples per pixel, resolved into the target;
/// 3. colour bar and caption, pixel on pixel.
#[derive(Debug)]
pub struct Renderer {
    device: Device,
    queue: Queue,
    format: TextureFormat,
    sample_count: u32,
    globals_layout: BindGroupLayout,
    shadow: Shadow,
    background: Background,
    edges: Edges,
    bodies: Bodies,
    particles: Particles,
    surface: Surface,
    screen_space: ScreenSpace,
    overlay: Overlay,
    targets: Option<Targets>,
}

impl Renderer {
    /// Builds the pipelines for targets of `format` (8-bit RGBA or BGRA, with or without sRGB encoding) with 1 or 4
    /// samples per pixel. Targets themselves always have one sample; the others are resolved into it.
    ///
    /// # Errors
    /// [`RenderError::SampleCount`] for other numbers of samples.
    pub fn new(
        device: &Device,
        queue: &Queue,
        format: TextureFormat,
        sample_count: u32,
    ) -> Result<Renderer, RenderError> {
        if sample_count != 1 && sample_count != 4 {
            return Err(RenderError::SampleCount { given: sample_count });
        }
        let globals_layout = bind_group_layout(device, "globals", &[Bind::Uniform]);
        let shadow = Shadow::new(device, &globals_layout);
        let layouts = [&globals_layout, &shadow.environment_layout];
        Ok(Renderer {
            background: Background::new(device, layouts, format, sample_count),
            edges: Edges::new(device, [&globals_layout], format, sample_count),
            bodies: Bodies::new(device, layouts, format, sample_count),
            particles: Particles::new(device, queue, layouts, format, sample_count),
            surface: Surface::new(device, layouts, format, sample_count),
            screen_space: ScreenSpace::new(device, layouts, format, sample_count),
            overlay: Overlay::new(device, format),
            shadow,
            globals_layout,
            device: device.clone(),
            queue: queue.clone(),
            format,
            sample_count,
            targets: None,
        })
    }

    /// Format of the textures this renderer draws into.
    pub fn format(&self) -> TextureFormat {
        self.format
    }

    /// Records a picture of `size` pixels into `target`, a view of a texture of that size and of this renderer's format
    /// with the usage [`wgpu::TextureUsages::RENDER_ATTACHMENT`].
    ///
    /// The encoder must be submitted to the queue this renderer was made with. Pictures of several targets may be recorded
    /// before any is submitted.
    ///
    /// # Errors
    /// [`RenderError::PictureSize`] for an empty or too large picture, and [`RenderError::Camera`],
    /// [`RenderError::Value`], [`RenderError::BufferTooShort`] or [`RenderError::BufferUsage`] if the frame cannot be
    /// drawn. Nothing is recorded then.
    pub fn draw(
        &mut self,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        size: [u32; 2],
        frame: &Frame<'_>,
    ) -> Result<(), RenderError> {
        check_size(&self.device, size)?;
        let globals = frame.globals(size, self.format.is_srgb())?;
        let behind = frame.domain.edges(globals.eye.into()).iter().filter(|edge| edge.behind).count() as u32;
        let globals = self.bind_globals(bytemuck::bytes_of(&globals));
        if self.targets.as_ref().is_none_or(|targets| targets.size != size) {
            self.targets = Some(Targets::new(&self.device, size, self.format, self.sample_count));
        }
        self.overlay.prepare(&self.device, &self.queue, size, frame)?;
        let Some(targets) = &self.targets else { return Ok(()) };

        let recorder = &mut Recorder { encoder };
        self.shadow.record(&self.device, recorder, &globals, frame);
        let chunks =
            frame.particles.map(|drawn| self.particles.bind(&self.device, &drawn)).unwrap_or_default();
        let scene = |pass: &mut RenderPass<'_>| {
            pass.set_bind_group(0, &globals, &[]);
            pass.set_bind_group(1, &self.shadow.environment, &[]);
            self.background.record(pass);
            self.edges.record(pass, 0..behind);
            if let Some(bodies) = &frame.bodies {
                self.bodies.record(pass, bodies);
            }
            if !chunks.is_empty() {
                self.particles.record(pass, &chunks);
            }
        };

        if frame.surface.is_none() && frame.liquid_particles.is_none() {
            let mut pass = recorder.picture("picture", targets, target, Start::Clear, End::Discard);
            scene(&mut pass);
            self.edges.record(&mut pass, behind..12);
            drop(pass);
            self.overlay.record(recorder, target);
            return Ok(());
        }
        scene(&mut recorder.picture("scene", targets, &targets.scene, Start::Clear, End::Keep));
        {
            // Further than anything, in 16 bits.
            let nothing = Color { r: 60_000.0, ..Color::TRANSPARENT };
            let mut pass = recorder.cleared("distance of bodies", &targets.solid, nothing);
            if let Some(bodies) = &frame.bodies {
                pass.set_bind_group(0, &globals, &[]);
                self.bodies.record_distance(&mut pass, bodies);
            }
        }
        let liquid_chunks = frame
            .liquid_particles
            .map(|drawn| self.screen_space.bind(&self.device, &drawn.buffers))
            .unwrap_or_default();
        {
            let mut pass = recorder.cleared("thickness", &targets.thickness, Color::TRANSPARENT);
            pass.set_bind_group(0, &globals, &[]);
            match &frame.surface {
                Some(drawn) => {
                    self.surface.record_thickness(&self.device, &mut pass, targets, &drawn.buffers);
                }
                None => self.screen_space.record_amount(&self.device, &mut pass, targets, &liquid_chunks),
            }
        }
        let group = match &frame.surface {
            Some(_) => self.surface.bind(&self.device, targets),
            None => {
                self.screen_space.record_distances(&self.device, recorder, targets, &globals, &liquid_chunks)
            }
        };
        {
            // With one sample the scene went into a texture of its own and has to be drawn again.
            let again = targets.samples.is_none();
            let start = if again { Start::Clear } else { Start::Load };
            let mut pass = recorder.picture("picture", targets, target, start, End::Discard);
            if again {
                scene(&mut pass);
            }
            pass.set_bind_group(0, &globals, &[]);
            pass.set_bind_group(1, &self.shadow.environment, &[]);
            match &frame.surface {
                Some(drawn) => self.surface.record(&mut pass, &group, &drawn.buffers),
                None => self.screen_space.record(&mut pass, &group),
            }
            self.edges.record(&mut pass, behind..12);
        }
        self.overlay.record(recorder, target);
        Ok(())
    }

    /// A buffer of its own for each picture: several may be recorded before the first is submitted.
    fn bind_globals(&self, bytes: &[u8]) -> BindGroup {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("globals"),
            size: bytes.len() as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, bytes);
        bind_group(&self.device, "globals", &self.globals_layout, &[buffer.as_entire_binding()])
    }
}

/// Refuses pictures that the device cannot hold.
pub(crate) fn check_size(device: &Device, [width, height]: [u32; 2]) -> Result<(), RenderError> {
    let limit = device.limits().max_texture_dimension_2d;
    match (1..=limit).contains(&width) && (1..=limit).contains(&height) {
        true => Ok(()),
        false => Err(RenderError::PictureSize { width, height, limit }),
    }
}
