//! The passes of a picture and their order.

use crate::background::Background;
use crate::bodies::Bodies;
use crate::colour_map::ColourTextures;
use crate::droplets::Droplets;
use crate::edges::Edges;
use crate::foam::{Foam, FoamLayer, Kinds};
use crate::glass::{Glass, Panes};
use crate::overlay::Overlay;
use crate::particles::Particles;
use crate::pipeline::{Bind, bind_group, bind_group_layout};
use crate::recorder::{End, Recorder, Start};
use crate::scene_copy::SceneCopy;
use crate::screen_space::{ScreenSpace, margin};
use crate::shadow::Shadow;
use crate::slice::Slice;
use crate::surface::Surface;
use crate::targets::{FoamTargets, MeshTargets, Targets};
use crate::tiling::Tile;
use crate::trace::TracedPicture;
use crate::{Frame, RenderError, SurfaceStyle};
use splashdown_gpu::{PassTimer, Timings};
use std::ops::Range;
use std::time::Duration;
use wgpu::{
    BindGroup, BindGroupLayout, BufferUsages, Color, CommandEncoder, Device, Queue, RenderPass,
    TextureFormat, TextureView,
};

/// The largest number of passes of a picture that are measured. A picture has at most 24.
const MEASURED_PASSES: u32 = 32;
/// The largest number of pictures whose times have not been read back. Further pictures are not
/// measured.
const MEASURED_PICTURES: usize = 4;

/// Time that a pass of a picture took on the GPU.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassTime {
    /// The label of the pass, which graphics debuggers also show.
    pub label: &'static str,
    /// Milliseconds, the sum over all passes of that label.
    pub milliseconds: f32,
}

/// What is drawn of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Extent {
    /// Only the scene behind a liquid, which other tiles refract.
    BehindLiquid,
    All,
}

/// Draws frames into textures of one format. It owns the pipelines, so create it once and reuse it.
///
/// The passes of a picture, in order:
///
/// 1. the shadow of the fluid on the floor (256 x 256, blurred);
/// 2. the sums of a slice;
/// 3. the scene: background, hidden edges, bodies, particles, slice; with a liquid or droplets, the result is resolved
///    to a texture that they refract;
/// 4. with a liquid or droplets: if there is one sample per pixel, a copy of that texture in the target; then, with a liquid, bubbles
///    in the texture, at depths with one sample per pixel;
/// 5. with a liquid, its thickness; then for a mesh its normals, the pixels that it covers, and the
///    shading of these pixels; for a liquid of particles, their distances and smoothing;
/// 6. the picture: the shading of smoothed distances, wireframe and droplets;
/// 7. the same depths of the picture; foam and spray in a layer with one sample per pixel, drawn over the picture;
/// 8. the near panes and edges; all samples are resolved into the target;
/// 9. colour bar and caption.
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
    slice: Slice,
    droplets: Droplets,
    foam: Foam,
    foam_layer: FoamLayer,
    glass: Glass,
    surface: Surface,
    scene_copy: SceneCopy,
    screen_space: ScreenSpace,
    overlay: Overlay,
    /// Created with the first picture that needs it.
    traced: Option<TracedPicture>,
    targets: Option<Targets>,
    timer: Option<PassTimer>,
    /// The times of the latest picture that have been read back.
    pass_times: Vec<PassTime>,
    /// Those of all pictures.
    timings: Timings,
}

impl Renderer {
    /// Creates the pipelines for targets of `format` (8-bit RGBA or BGRA, with or without sRGB
    /// encoding) with 1 or 4 samples per pixel. Targets always have one sample; several samples are
    /// resolved into it.
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
        let shadow = Shadow::new(device, queue, &globals_layout);
        let layouts = [&globals_layout, &shadow.floor_light.layout];
        let colours = ColourTextures::new(device, queue);
        Ok(Renderer {
            background: Background::new(device, layouts, format, sample_count),
            edges: Edges::new(device, [&globals_layout], format, sample_count),
            bodies: Bodies::new(device, layouts, format, sample_count),
            particles: Particles::new(device, layouts, format, sample_count, colours.clone()),
            slice: Slice::new(device, layouts, format, sample_count, colours),
            droplets: Droplets::new(device, &layouts, format, sample_count),
            foam: Foam::new(device, layouts, format),
            foam_layer: FoamLayer::new(device, format, sample_count),
            glass: Glass::new(device, layouts, format, sample_count),
            surface: Surface::new(device, layouts, format, sample_count),
            scene_copy: SceneCopy::new(device, format),
            screen_space: ScreenSpace::new(device, layouts, format, sample_count),
            overlay: Overlay::new(device, format),
            shadow,
            globals_layout,
            device: device.clone(),
            queue: queue.clone(),
            format,
            sample_count,
            traced: None,
            targets: None,
            timer: None,
            pass_times: Vec::new(),
            timings: Timings::default(),
        })
    }

    /// Format of the targets.
    pub fn format(&self) -> TextureFormat {
        self.format
    }

    /// Switches the timing of passes on or off; returns whether it is on. Timing needs a device
    /// with [`wgpu::Features::TIMESTAMP_QUERY`].
    pub fn set_timing(&mut self, on: bool) -> bool {
        if !on {
            (self.timer, self.pass_times) = (None, Vec::new());
        } else if self.timer.is_none() {
            self.timer = PassTimer::new(&self.device, &self.queue, MEASURED_PASSES, MEASURED_PICTURES);
        }
        self.timer.is_some()
    }

    /// Times of the passes in order, of the latest picture whose times have been read back; empty
    /// before the first, and if timing is off.
    ///
    /// The read-back is asynchronous: times arrive a few pictures late, and only if the device is
    /// polled, which every submission does.
    pub fn pass_times(&mut self) -> &[PassTime] {
        let groups = self.timer.as_mut().map(PassTimer::collect).unwrap_or_default();
        for &(label, time) in groups.iter().flatten() {
            self.timings.add(label, time);
        }
        if let Some(latest) = groups.last() {
            self.pass_times = sums(latest);
        }
        &self.pass_times
    }

    /// The times of all passes that have been read back since the last call, of all pictures: see
    /// [`set_timing`](Self::set_timing). An [`Offscreen`](crate::Offscreen) waits for every submission while they
    /// are measured, so that none is left out.
    pub fn take_timings(&mut self) -> Timings {
        self.pass_times();
        std::mem::take(&mut self.timings)
    }

    /// Whether passes are measured.
    pub(crate) fn is_timed(&self) -> bool {
        self.timer.is_some()
    }

    /// Records a picture of `size` pixels into `target`, a view of a texture of that size and of
    /// this renderer's format with the usage [`wgpu::TextureUsages::RENDER_ATTACHMENT`].
    ///
    /// Submit the encoder to the queue of this renderer. Several pictures can be recorded before
    /// any is submitted.
    ///
    /// # Errors
    /// [`RenderError::PictureSize`] for an empty or too large picture, and [`RenderError::Camera`],
    /// [`RenderError::Value`], [`RenderError::TwoLiquids`], [`RenderError::BufferTooShort`],
    /// [`RenderError::BufferTooLong`] or [`RenderError::BufferUsage`] if the frame cannot be drawn.
    /// In case of an error nothing is recorded.
    pub fn draw(
        &mut self,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        size: [u32; 2],
        frame: &Frame<'_>,
    ) -> Result<(), RenderError> {
        check_size(&self.device, size)?;
        let tile = Tile::whole(size);
        match frame.traced_samples() {
            Some(samples) => self.draw_samples(encoder, target, tile, frame, 0..samples),
            None => self.draw_tile(encoder, target, tile, frame, Extent::All),
        }
    }

    /// Records a tile of a picture into `target`, a view of a texture of the tiles' size.
    pub(crate) fn draw_tile(
        &mut self,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        tile: Tile,
        frame: &Frame<'_>,
        extent: Extent,
    ) -> Result<(), RenderError> {
        let size = tile.tiling.texture();
        let mut globals = frame.globals(tile, self.format.is_srgb())?;
        globals.splat_margin = margin(&self.device, size) as f32;
        if let Some(surface) = &frame.surface {
            surface.buffers.check_style(&self.device, surface.style)?;
        }
        let behind = frame.domain.edges_behind(globals.eye.into());
        let globals = self.bind_globals(bytemuck::bytes_of(&globals));
        let layers = if frame.is_refracted() { tile.tiling.count() } else { 1 };
        if self.targets.as_ref().is_none_or(|targets| !targets.suit(size, layers)) {
            self.targets = Some(Targets::new(&self.device, size, layers, self.format, self.sample_count));
        }
        let surface = frame.surface.filter(|drawn| drawn.style != SurfaceStyle::Lines);
        if let Some(targets) = &mut self.targets
            && surface.is_some()
            && targets.mesh.is_none()
        {
            targets.mesh = Some(MeshTargets::new(&self.device, size, self.format, self.sample_count));
        }
        if let Some(targets) = &mut self.targets
            && frame.foam.is_some_and(|drawn| drawn.buffers.count > 0)
            && targets.foam.is_none()
        {
            targets.foam = Some(FoamTargets::new(&self.device, size, self.sample_count));
        }
        self.overlay.prepare(&self.device, &self.queue, tile, frame)?;
        // Collects the times read back so far, so that the timer can measure this picture.
        self.pass_times();
        let Some(targets) = &self.targets else { return Ok(()) };

        let mut recorder = Recorder::new(encoder, self.timer.as_mut());
        self.shadow.record(&self.device, &mut recorder, &globals, frame);
        let slice = frame
            .slice
            .map(|drawn| self.slice.gather(&self.device, &mut recorder, targets, &globals, &drawn));
        let chunks =
            frame.particles.map(|drawn| self.particles.bind(&self.device, &drawn)).unwrap_or_default();
        let foam = frame.foam.map(|drawn| self.foam.bind(&self.device, &drawn)).unwrap_or_default();
        let droplets = frame
            .droplets
            .map(|drawn| self.droplets.bind(&self.device, &drawn, Some(targets)))
            .unwrap_or_default();
        let (has_liquid, is_refracted) = (frame.has_liquid(), frame.is_refracted());
        let (has_panes, has_edges) = frame.sides(has_liquid);
        let scene = |pass: &mut RenderPass<'_>| {
            pass.set_bind_group(0, &globals, &[]);
            pass.set_bind_group(1, &self.shadow.environment, &[]);
            self.background.record(pass);
            if has_panes {
                self.glass.record(pass, Panes::Behind);
            }
            if has_edges {
                self.edges.record(pass, 0..behind);
            }
            if let Some(bodies) = &frame.bodies {
                self.bodies.record(pass, bodies);
            }
            if !chunks.is_empty() {
                self.particles.record(pass, &chunks);
            }
            if let Some(group) = &slice {
                self.slice.record(pass, group);
            }
        };
        if is_refracted {
            scene(&mut recorder.picture(
                "scene",
                targets,
                &targets.scene,
                Start::Clear,
                End::ResolveAndStore,
            ));
            // Larger than any distance, and representable as a 16-bit float.
            let no_body = Color { r: 60_000.0, ..Color::TRANSPARENT };
            let mut pass = recorder.cleared("distance of bodies", &targets.solid, no_body);
            if let Some(bodies) = &frame.bodies {
                pass.set_bind_group(0, &globals, &[]);
                self.bodies.record_distance(&mut pass, bodies);
            }
        }
        if is_refracted && targets.samples.is_none() {
            let mut pass = recorder.cleared("scene copy", target, Color::BLACK);
            self.scene_copy.record(&self.device, &mut pass, &targets.scene);
        }
        let layer = targets.foam.as_ref().filter(|_| !foam.is_empty());
        if has_liquid && let Some(layer) = layer {
            let depths = self.foam_layer.depths(&self.device, &mut recorder, targets, layer);
            let mut pass = recorder.one_sample("bubbles", &targets.scene, depths, Start::Load);
            pass.set_bind_group(0, &globals, &[]);
            pass.set_bind_group(1, &self.shadow.environment, &[]);
            self.foam.record(&mut pass, &foam, Kinds::UnderWater);
        }
        if is_refracted {
            targets.scenes.record(recorder.encoder(), tile.index);
            targets.solids.record(recorder.encoder(), tile.index);
        }
        if extent == Extent::BehindLiquid {
            recorder.finish();
            return Ok(());
        }
        if let Some(drawn) = &surface {
            let groups = [&globals, &self.shadow.environment];
            self.surface.record(&self.device, &mut recorder, targets, target, groups, &drawn.buffers);
        }
        let distances = if let Some(drawn) = &frame.liquid_particles {
            let chunks = self.screen_space.bind(&self.device, &drawn.buffers);
            {
                let mut pass = recorder.cleared("particle thickness", &targets.thickness, Color::TRANSPARENT);
                pass.set_bind_group(0, &globals, &[]);
                self.screen_space.record_thickness(&self.device, &mut pass, targets, &chunks);
            }
            let space = &mut self.screen_space;
            Some(space.record_distances(&self.device, &mut recorder, targets, &globals, &chunks))
        } else {
            None
        };
        let in_front = |pass: &mut RenderPass<'_>| {
            pass.set_bind_group(0, &globals, &[]);
            pass.set_bind_group(1, &self.shadow.environment, &[]);
            if has_panes {
                self.glass.record(pass, Panes::InFront);
            }
            if has_edges {
                self.edges.record(pass, behind..12);
            }
        };
        {
            let start = if is_refracted { Start::Load } else { Start::Clear };
            let end = if layer.is_some() { End::Store } else { End::Resolve };
            let mut pass = recorder.picture("picture", targets, target, start, end);
            if !is_refracted {
                scene(&mut pass);
            }
            pass.set_bind_group(0, &globals, &[]);
            pass.set_bind_group(1, &self.shadow.environment, &[]);
            if let Some(distances) = &distances {
                self.screen_space.record(&mut pass, distances);
            }
            if let Some(drawn) = &frame.surface {
                self.surface.record_lines(&self.device, &mut pass, drawn);
            }
            self.droplets.record(&mut pass, &droplets);
            if layer.is_none() {
                in_front(&mut pass);
            }
        }
        if let Some(layer) = layer {
            let depths = self.foam_layer.depths(&self.device, &mut recorder, targets, layer);
            {
                let mut pass = recorder.over_depth("foam", &layer.colours, depths);
                pass.set_bind_group(0, &globals, &[]);
                pass.set_bind_group(1, &self.shadow.environment, &[]);
                let kinds = if has_liquid { Kinds::OverWater } else { Kinds::All };
                self.foam.record(&mut pass, &foam, kinds);
            }
            let mut pass = recorder.picture("foam over picture", targets, target, Start::Load, End::Resolve);
            self.foam_layer.record(&self.device, &mut pass, layer);
            in_front(&mut pass);
        }
        self.overlay.record(&mut recorder, target);
        recorder.finish();
        Ok(())
    }

    /// Records some samples of a tile with traced rays; the last one completes it.
    pub(crate) fn draw_samples(
        &mut self,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        tile: Tile,
        frame: &Frame<'_>,
        samples: Range<u32>,
    ) -> Result<(), RenderError> {
        let Some((meshes, quality)) = frame.traced else { return Ok(()) };
        quality.check()?;
        let globals = samples
            .clone()
            .map(|sample| frame.sample_globals(tile, sample))
            .collect::<Result<Vec<_>, _>>()?;
        let of_result = frame.globals(tile, self.format.is_srgb())?;
        let globals: Vec<BindGroup> =
            globals.iter().map(|globals| self.bind_globals(bytemuck::bytes_of(globals))).collect();
        let of_result = self.bind_globals(bytemuck::bytes_of(&of_result));
        self.overlay.prepare(&self.device, &self.queue, tile, frame)?;
        self.pass_times();
        let (device, layout, format) = (&self.device, &self.globals_layout, self.format);
        let floor_light = &self.shadow.floor_light;
        let traced =
            self.traced.get_or_insert_with(|| TracedPicture::new(device, layout, floor_light, format));
        traced.prepare(device, tile.tiling.texture());
        let trees = traced.bind(device, meshes);
        let mut recorder = Recorder::new(encoder, self.timer.as_mut());
        for (sample, globals) in samples.clone().zip(&globals) {
            traced.record_sample(device, &mut recorder, globals, &trees, frame, sample);
        }
        if samples.end == quality.samples {
            traced.record_result(&mut recorder, &of_result, target, samples.end - 1);
            self.overlay.record(&mut recorder, target);
        }
        recorder.finish();
        Ok(())
    }

    /// Creates a new buffer for each picture, because several can be recorded before the first is
    /// submitted.
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

/// Refuses sizes that the device does not support.
pub(crate) fn check_size(device: &Device, [width, height]: [u32; 2]) -> Result<(), RenderError> {
    let limit = device.limits().max_texture_dimension_2d;
    match (1..=limit).contains(&width) && (1..=limit).contains(&height) {
        true => Ok(()),
        false => Err(RenderError::PictureSize { width, height, limit }),
    }
}

/// Sums times by label, in the order of the passes.
fn sums(times: &[(&'static str, Duration)]) -> Vec<PassTime> {
    let mut sums: Vec<PassTime> = Vec::new();
    for &(label, time) in times {
        let milliseconds = 1e3 * time.as_secs_f32();
        match sums.iter_mut().find(|sum| sum.label == label) {
            Some(sum) => sum.milliseconds += milliseconds,
            None => sums.push(PassTime { label, milliseconds }),
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_summed_by_label() {
        let times = [("smooth", 1_000_000), ("smooth", 500_000), ("clean", 0)]
            .map(|(label, nanoseconds)| (label, Duration::from_nanos(nanoseconds)));
        let expected =
            [PassTime { label: "smooth", milliseconds: 1.5 }, PassTime { label: "clean", milliseconds: 0.0 }];
        assert_eq!(sums(&times), expected);
    }
}
