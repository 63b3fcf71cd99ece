//! A plane through the fluid, coloured by density, speed or pressure.
//!
//! # How it works
//! Every particle within the support radius of the plane is drawn as the disc in which the plane
//! intersects the support of its kernel. Blending sums the kernel weights and the weighted quantity
//! at the resolution of the picture; their quotient is the weighted average of the quantity
//! (Shepard 1968), which is looked up in the colour map. The sum of the weights, relative to its
//! value inside the fluid, marks the boundary of the fluid: the plane is transparent outside. The
//! plane has depth, so bodies and particles intersect it correctly.
//!
//! It costs a fifth of drawing all particles as spheres (see `examples/modes.rs`).
//!
//! # Why not the other way
//! The sum of m W alone is a density, but with artificial dips along walls and free surfaces; the
//! quotient shows the values of the solver. A texture fixed to the plane would be blurred at close
//! range and wasteful at a distance.
//!
//! # Things we might try
//! Arrows or streaks for velocity; planes of arbitrary orientation.

use crate::chunks::bind_chunks;
use crate::colour_map::ColourTextures;
use crate::error::check_radius;
use crate::globals::Globals;
use crate::pipeline::{ADD, Bind, Depth, OVER, PipelineDesc, bind_group, bind_group_layout};
use crate::recorder::Recorder;
use crate::shader::{GLOBALS, QUANTITY, Shader};
use crate::targets::{Targets, texture};
use crate::{Colouring, ParticleBuffers, RenderError};
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Color, Device, PrimitiveTopology, RenderPass,
    RenderPipeline, TextureFormat, TextureUsages, TextureView,
};

pub(crate) const GATHER: Shader =
    Shader { label: "slice gather", parts: &[GLOBALS, QUANTITY, include_str!("gather.wgsl")] };
pub(crate) const SHADER: Shader = Shader { label: "slice", parts: &[GLOBALS, include_str!("slice.wgsl")] };

const SUMS_FORMAT: TextureFormat = TextureFormat::Rg16Float;

/// Normal of an axis-aligned plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// The plane is parallel to y and z.
    X,
    /// The plane is horizontal.
    Y,
    /// The plane is parallel to x and y.
    Z,
}

/// A plane through the fluid, coloured by a quantity.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct DrawnSlice<'a> {
    /// The particles.
    pub buffers: ParticleBuffers<'a>,
    /// Normal of the plane.
    pub axis: Axis,
    /// Position of the plane along the axis, metres.
    pub position: f32,
    /// Distance in metres at which the weight of a particle becomes zero: usually two particle
    /// spacings.
    pub support_radius: f32,
    /// Half the particle spacing in metres, which determines the sum of the weights inside the
    /// fluid.
    pub radius: f32,
    /// The colours. If the frame also has particles with a colour bar, the picture shows that
    /// colour bar.
    pub colouring: Colouring,
}

#[derive(Debug)]
pub(crate) struct Slice {
    gather: RenderPipeline,
    pipeline: RenderPipeline,
    particles_layout: BindGroupLayout,
    layout: BindGroupLayout,
    colours: ColourTextures,
    sums: Option<([u32; 2], TextureView)>,
}

impl Slice {
    pub fn new(
        device: &Device,
        [globals, environment]: [&BindGroupLayout; 2],
        format: TextureFormat,
        samples: u32,
        colours: ColourTextures,
    ) -> Slice {
        let bindings = [Bind::Storage, Bind::Storage, Bind::Storage];
        let particles_layout = bind_group_layout(device, "slice particles", &bindings);
        let gather_layouts = [globals, &particles_layout];
        let gather =
            PipelineDesc { blend: Some(ADD), ..PipelineDesc::new(GATHER, &gather_layouts, SUMS_FORMAT) };
        let layout = bind_group_layout(device, "slice", &[Bind::Texels, Bind::Texels]);
        let layouts = [globals, environment, &layout];
        let desc = PipelineDesc {
            samples,
            depth: Some(Depth::TestAndWrite),
            blend: Some(OVER),
            topology: PrimitiveTopology::TriangleStrip,
            ..PipelineDesc::new(SHADER, &layouts, format)
        };
        Slice {
            gather: gather.build(device),
            pipeline: desc.build(device),
            particles_layout,
            layout,
            colours,
            sums: None,
        }
    }

    /// Records the sums over the particles near the plane; returns the bind group for
    /// [`Slice::record`].
    pub fn gather(
        &mut self,
        device: &Device,
        recorder: &mut Recorder<'_>,
        targets: &Targets,
        globals: &BindGroup,
        drawn: &DrawnSlice<'_>,
    ) -> BindGroup {
        let size = targets.size;
        let kept = self.sums.take().filter(|(kept, _)| *kept == size);
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let make = || (size, texture(device, "slice sums", size, SUMS_FORMAT, 1, usage));
        let (_, sums) = self.sums.insert(kept.unwrap_or_else(make));
        {
            let mut pass = recorder.cleared("slice gather", sums, Color::TRANSPARENT);
            pass.set_pipeline(&self.gather);
            pass.set_bind_group(0, globals, &[]);
            let ParticleBuffers { count, .. } = drawn.buffers;
            let columns = drawn.buffers.columns();
            for chunk in bind_chunks(device, "slice particles", &self.particles_layout, count, &columns, &[])
            {
                chunk.draw(&mut pass, 1, 6);
            }
        }
        let colours = self.colours.of(drawn.colouring.map);
        let resources = [sums, colours].map(BindingResource::TextureView);
        bind_group(device, "slice", &self.layout, &resources)
    }

    /// Draws the plane. Expects groups 0 (globals) and 1 (environment) to be bound.
    pub fn record(&self, pass: &mut RenderPass<'_>, group: &BindGroup) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(2, group, &[]);
        pass.draw(0..4, 0..1);
    }
}

impl<'a> DrawnSlice<'a> {
    /// A plane perpendicular to `axis` at `position` (metres), through particles of a radius in
    /// metres (half the particle spacing). The support radius is two particle spacings.
    pub fn new(
        buffers: ParticleBuffers<'a>,
        axis: Axis,
        position: f32,
        radius: f32,
        colouring: Colouring,
    ) -> DrawnSlice<'a> {
        DrawnSlice { buffers, axis, position, support_radius: 4.0 * radius, radius, colouring }
    }

    /// Checks the values and writes the uniforms.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        self.buffers.check()?;
        check_radius(self.radius)?;
        if !(self.support_radius >= 2.0 * self.radius && self.support_radius.is_finite()) {
            return Err(RenderError::Value {
                what: "the slice's support radius",
                given: format!("{} m", self.support_radius),
                allowed: "a finite number of at least one particle spacing (twice the radius)",
            });
        }
        if !self.position.is_finite() {
            return Err(RenderError::Value {
                what: "the slice's position",
                given: format!("{} m", self.position),
                allowed: "a finite number",
            });
        }
        let [low, high] = self.colouring.checked_range()?;
        globals.slice_axis = match self.axis {
            Axis::X => 0,
            Axis::Y => 1,
            Axis::Z => 2,
        };
        globals.slice_position = self.position;
        globals.slice_support_radius = self.support_radius;
        globals.slice_quantity = self.colouring.quantity.index();
        globals.slice_low = low;
        globals.slice_scale = 1.0 / (high - low);
        // The Wendland C2 kernel has W(0) = 21 / (2 pi H^3) and an integral of 1; the shader uses
        // W(0) = 1.
        let volume = std::f32::consts::TAU * self.support_radius.powi(3) / 21.0;
        globals.slice_full = volume / (2.0 * self.radius).powi(3);
        Ok(())
    }
}
