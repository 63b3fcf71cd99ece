//! The passes of a picture with traced rays.

use super::floor::Floor;
use crate::background::Background;
use crate::bodies;
use crate::droplets::Droplets;
use crate::edges::Edges;
use crate::foam::{Foam, Kinds};
use crate::glass::{Glass, Panes};
use crate::pipeline::{Bind, Depth, PipelineDesc, bind_group, bind_group_layout};
use crate::recorder::{Recorder, Start};
use crate::shadow::FloorLight;
use crate::targets::{LAYER_FORMAT, texture};
use crate::{DrawnSurface, Frame, TracedMeshes};
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Color, ColorWrites, Device, Face, RenderPipeline,
    TextureFormat, TextureUsages, TextureView,
};

/// Format of light without tone mapping.
const LIGHT: TextureFormat = LAYER_FORMAT;
/// Format of the mean of the samples: with 11 bits, those that are small beside it would be lost, and a thousand samples
/// would darken the picture.
const MEAN: TextureFormat = TextureFormat::Rgba32Float;

#[derive(Debug)]
pub(crate) struct TracedPicture {
    floor: Floor,
    background: Background,
    bodies: RenderPipeline,
    depth: RenderPipeline,
    liquid: RenderPipeline,
    inside: RenderPipeline,
    droplets: Droplets,
    foam: Foam,
    glass: Glass,
    edges: Edges,
    accumulate: RenderPipeline,
    resolve: RenderPipeline,
    trees_layout: BindGroupLayout,
    texture_layout: BindGroupLayout,
    targets: Option<LightTargets>,
}

/// Textures of the size of the picture.
#[derive(Debug)]
struct LightTargets {
    size: [u32; 2],
    sample: TextureView,
    depth: TextureView,
    /// The mean of the samples up to an even and up to an odd one: each is computed from the other.
    means: [TextureView; 2],
    sample_group: BindGroup,
    mean_groups: [BindGroup; 2],
}

impl TracedPicture {
    pub fn new(
        device: &Device,
        globals: &BindGroupLayout,
        floor_light: &FloorLight,
        format: TextureFormat,
    ) -> TracedPicture {
        let trees_layout = bind_group_layout(device, "trees", &[Bind::FragmentStorage; 3]);
        let texture_layout = bind_group_layout(device, "light", &[Bind::Texels]);
        let environment = &floor_light.layout;
        let plain = [globals, environment];
        let traced = [globals, environment, &trees_layout];
        let of_texture = [globals, &texture_layout];
        let depth_layouts = [globals];
        let depth = PipelineDesc {
            depth: Some(Depth::TestAndWrite),
            cull: Some(Face::Back),
            vertex_buffers: 1,
            write: ColorWrites::empty(),
            ..PipelineDesc::new(super::DEPTH, &depth_layouts, LIGHT)
        };
        let liquid = PipelineDesc {
            depth: Some(Depth::Test),
            cull: Some(Face::Back),
            vertex_buffers: 2,
            ..PipelineDesc::new(super::LIQUID, &traced, LIGHT)
        };
        let inside =
            PipelineDesc { depth: Some(Depth::Write), ..PipelineDesc::new(super::INSIDE, &traced, LIGHT) };
        let of_textures = [globals, &texture_layout, &texture_layout];
        let accumulate = PipelineDesc::new(super::ACCUMULATE, &of_textures, MEAN);
        TracedPicture {
            floor: Floor::new(device, globals, &trees_layout, floor_light),
            background: Background::new(device, plain, LIGHT, 1),
            bodies: bodies::pipeline(device, bodies::TRACED, &traced, LIGHT, 1),
            depth: depth.build(device),
            liquid: liquid.build(device),
            inside: inside.build(device),
            droplets: Droplets::new(device, &traced, LIGHT, 1),
            foam: Foam::new(device, plain, LIGHT),
            glass: Glass::new(device, plain, LIGHT, 1),
            edges: Edges::new(device, [globals], LIGHT, 1),
            accumulate: accumulate.build(device),
            resolve: PipelineDesc::new(super::RESOLVE, &of_texture, format).build(device),
            trees_layout,
            texture_layout,
            targets: None,
        }
    }

    /// Creates the textures for a picture of this size.
    pub fn prepare(&mut self, device: &Device, size: [u32; 2]) {
        if self.targets.as_ref().is_none_or(|targets| targets.size != size) {
            self.targets = Some(LightTargets::new(device, size, &self.texture_layout));
        }
    }

    /// Binds the trees.
    pub fn bind(&self, device: &Device, meshes: &TracedMeshes) -> BindGroup {
        let resources = meshes.buffers().map(wgpu::Buffer::as_entire_binding);
        bind_group(device, "trees", &self.trees_layout, &resources)
    }

    /// Records a sample of the picture and adds it to the mean of those before it.
    pub fn record_sample(
        &self,
        device: &Device,
        recorder: &mut Recorder<'_>,
        globals: &BindGroup,
        trees: &BindGroup,
        frame: &Frame<'_>,
        sample: u32,
    ) {
        let (Some(targets), Some(surface), Some((meshes, quality))) =
            (&self.targets, &frame.surface, &frame.traced)
        else {
            return;
        };
        if sample == 0 {
            self.floor.record_sky(recorder, globals, trees, meshes.has_bodies());
        }
        // With few samples the caustics of the first serve all.
        if sample == 0 || quality.samples > 16 {
            self.floor.record_sunlight(recorder, globals, trees, meshes.has_bodies());
        }
        self.record_scene(device, recorder, targets, [globals, trees], frame, surface);
        let own = sample as usize % 2;
        let mut pass = recorder.cleared("mean of samples", &targets.means[own], Color::BLACK);
        pass.set_pipeline(&self.accumulate);
        pass.set_bind_group(0, globals, &[]);
        pass.set_bind_group(1, &targets.sample_group, &[]);
        pass.set_bind_group(2, &targets.mean_groups[1 - own], &[]);
        pass.draw(0..3, 0..1);
    }

    fn record_scene(
        &self,
        device: &Device,
        recorder: &mut Recorder<'_>,
        targets: &LightTargets,
        [globals, trees]: [&BindGroup; 2],
        frame: &Frame<'_>,
        surface: &DrawnSurface<'_>,
    ) {
        let (has_panes, has_edges) = frame.sides(true);
        let behind = frame.domain.edges_behind(frame.camera.eye.into());
        let foam = frame.foam.map(|drawn| self.foam.bind(device, &drawn)).unwrap_or_default();
        let droplets =
            frame.droplets.map(|drawn| self.droplets.bind(device, &drawn, None)).unwrap_or_default();
        {
            let mut pass = recorder.one_sample("scene", &targets.sample, &targets.depth, Start::Clear);
            pass.set_bind_group(0, globals, &[]);
            pass.set_bind_group(1, &self.floor.environment, &[]);
            self.background.record(&mut pass);
            if has_panes {
                self.glass.record(&mut pass, Panes::Behind);
            }
            if has_edges {
                self.edges.record(&mut pass, 0..behind);
            }
            pass.set_bind_group(2, trees, &[]);
            if let Some(buffers) = &frame.bodies {
                bodies::record(&self.bodies, &mut pass, buffers);
            }
            pass.set_pipeline(&self.depth);
            surface.buffers.draw(&mut pass);
        }
        {
            let mut pass = recorder.one_sample("traced liquid", &targets.sample, &targets.depth, Start::Load);
            pass.set_bind_group(0, globals, &[]);
            pass.set_bind_group(1, &self.floor.environment, &[]);
            pass.set_bind_group(2, trees, &[]);
            pass.set_pipeline(&self.liquid);
            pass.set_vertex_buffer(1, surface.buffers.normals.slice(..));
            surface.buffers.draw(&mut pass);
            if frame.eye_may_be_in_liquid() {
                pass.set_pipeline(&self.inside);
                pass.draw(0..3, 0..1);
            }
            self.droplets.record(&mut pass, &droplets);
        }
        let mut pass = recorder.one_sample("foam and glass", &targets.sample, &targets.depth, Start::Load);
        pass.set_bind_group(0, globals, &[]);
        pass.set_bind_group(1, &self.floor.environment, &[]);
        self.foam.record(&mut pass, &foam, Kinds::OverWater);
        if has_panes {
            self.glass.record(&mut pass, Panes::InFront);
        }
        if has_edges {
            self.edges.record(&mut pass, behind..12);
        }
    }

    /// Tone mapping of the mean up to a sample into the target.
    pub fn record_result(
        &self,
        recorder: &mut Recorder<'_>,
        globals: &BindGroup,
        target: &TextureView,
        last_sample: u32,
    ) {
        let Some(targets) = &self.targets else { return };
        let mut pass = recorder.cleared("tone mapping", target, Color::BLACK);
        pass.set_pipeline(&self.resolve);
        pass.set_bind_group(0, globals, &[]);
        pass.set_bind_group(1, &targets.mean_groups[last_sample as usize % 2], &[]);
        pass.draw(0..3, 0..1);
    }
}

impl LightTargets {
    fn new(device: &Device, size: [u32; 2], layout: &BindGroupLayout) -> LightTargets {
        let drawn = TextureUsages::RENDER_ATTACHMENT;
        let make = |label, format, usage| texture(device, label, size, format, 1, usage);
        let read = drawn | TextureUsages::TEXTURE_BINDING;
        let sample = make("sample", LIGHT, read);
        let means = ["mean of even samples", "mean of odd samples"].map(|label| make(label, MEAN, read));
        let group = |view| bind_group(device, "light", layout, &[BindingResource::TextureView(view)]);
        LightTargets {
            size,
            sample_group: group(&sample),
            mean_groups: [group(&means[0]), group(&means[1])],
            depth: make("depth", crate::pipeline::DEPTH, drawn),
            sample,
            means,
        }
    }
}
