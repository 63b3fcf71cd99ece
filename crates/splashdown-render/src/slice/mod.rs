//! A plane through the fluid, coloured by density, speed or pressure.
//!
//! # How it works
//! Every particle nearer to the plane than the support radius is drawn as the disc in which the plane cuts its
//! kernel; blending adds up the kernel's weights and the weighted quantity, in the picture's own pixels. Their
//! quotient is the quantity's mean (Shepard 1968), which is a colour of the map. The weights alone, against
//! what they are inside the fluid, say where the fluid ends: there the plane is left out. The plane has depth,
//! so solids and particles cut it.
//!
//! It costs next to nothing beside the background: a fifth of drawing all particles as spheres (see
//! `examples/ways.rs`).
//!
//! # Why not the other way
//! The sum of m W alone would be the density once more, with dips along walls and surface that are none of the
//! fluid's; the quotient shows what the solver has. A texture fixed to the plane would be blurred from near and
//! wasteful from far.
//!
//! # Things we might try
//! Arrows or streaks for velocity; planes of any direction.

use crate::colour_map::ColourTextures;
use crate::frame::check_radius;
use crate::globals::Globals;
use crate::particles::{chunks, part};
use crate::pipeline::{ADD, Bind, Depth, OVER, Recipe, bind_group, bind_group_layout};
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

/// Direction that a plane is perpendicular to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// The plane holds y and z.
    X,
    /// The plane is level.
    Y,
    /// The plane holds x and y.
    Z,
}

/// A plane through the fluid and how to draw it.
#[derive(Clone, Copy, Debug)]
pub struct DrawnSlice<'a> {
    /// Where the particles are, and what they carry.
    pub buffers: ParticleBuffers<'a>,
    /// Direction that the plane is perpendicular to.
    pub axis: Axis,
    /// Where the plane is along the axis, metres.
    pub position: f32,
    /// Where a particle's weight becomes zero, metres: usually two particle spacings.
    pub support_radius: f32,
    /// Half the particle spacing in metres; says how many particles make up full fluid.
    pub radius: f32,
    /// The colours. The colour bar is that of the particles if those are drawn with one too.
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
        let gather = Recipe { blend: Some(ADD), ..Recipe::new(GATHER, &gather_layouts, SUMS_FORMAT) };
        let layout = bind_group_layout(device, "slice", &[Bind::Texels, Bind::Texels]);
        let layouts = [globals, environment, &layout];
        let recipe = Recipe {
            samples,
            depth: Some(Depth::TestAndWrite),
            blend: Some(OVER),
            topology: PrimitiveTopology::TriangleStrip,
            ..Recipe::new(SHADER, &layouts, format)
        };
        Slice {
            gather: gather.build(device),
            pipeline: recipe.build(device),
            particles_layout,
            layout,
            colours,
            sums: None,
        }
    }

    /// Sums up the particles around the plane; the group that drawing it needs.
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
            let ParticleBuffers { positions, velocities, densities, count } = drawn.buffers;
            for (start, count) in chunks(device, count) {
                let resources = [
                    part(positions, 16, start, count),
                    part(velocities, 16, start, count),
                    part(densities, 8, start, count),
                ];
                let group = bind_group(device, "slice particles", &self.particles_layout, &resources);
                pass.set_bind_group(1, &group, &[]);
                pass.draw(0..6 * count, 0..1);
            }
        }
        let colours = self.colours.of(drawn.colouring.map);
        let resources = [sums, colours].map(BindingResource::TextureView);
        bind_group(device, "slice", &self.layout, &resources)
    }

    /// Groups 0 (globals) and 1 (environment) are set.
    pub fn record(&self, pass: &mut RenderPass<'_>, group: &BindGroup) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(2, group, &[]);
        pass.draw(0..4, 0..1);
    }
}

impl DrawnSlice<'_> {
    /// Checks the numbers and hands them to the shaders.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        self.buffers.check()?;
        check_radius(self.radius)?;
        if !(self.support_radius >= 2.0 * self.radius && self.support_radius.is_finite()) {
            return Err(RenderError::Value {
                what: "the slice's support radius",
                given: format!("{} m", self.support_radius),
                allowed: "a finite number of at least a particle spacing, twice the radius",
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
        // Wendland's C2 kernel is 21 / (2 pi H^3) in its middle and has a volume of 1; here it is 1 in its middle.
        let volume = std::f32::consts::TAU * self.support_radius.powi(3) / 21.0;
        globals.slice_full = volume / (2.0 * self.radius).powi(3);
        Ok(())
    }
}
