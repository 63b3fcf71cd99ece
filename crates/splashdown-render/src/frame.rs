//! The content of a picture.

use crate::glass::panes_of;
use crate::globals::{EdgeGlobals, Globals};
use crate::tiling::{Tile, around_exit, exit_reach};
use crate::{
    BodyBuffers, Camera, Domain, DrawnDroplets, DrawnFoam, DrawnLiquidParticles, DrawnParticles, DrawnSlice,
    DrawnSurface, Floor, Quality, RenderError, Sky, SurfaceStyle, Tank, TracedMeshes,
};
use glam::{Vec2, Vec3};

/// The content of one picture: [`Frame::new`] makes an empty one, the `with_` methods add to it.
///
/// Particles and a liquid can be combined: the particles are then visible through the liquid.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Frame<'a> {
    /// The camera.
    pub camera: Camera,
    /// The domain, drawn as a box of lines. It also sets the height of the floor and the size of
    /// its tiles.
    pub domain: Domain,
    /// Direction towards the sun, of any length, above the horizon. [`Frame::SUN`] suits a camera
    /// on the +z side.
    pub sun: [f32; 3],
    /// The sky and the light of sun and sky.
    pub sky: Sky,
    /// The floor below the domain, if any.
    pub floor: Option<Floor>,
    /// How the domain is drawn.
    pub tank: Tank,
    /// Particles as spheres.
    pub particles: Option<DrawnParticles<'a>>,
    /// The surface of the liquid as a mesh.
    pub surface: Option<DrawnSurface<'a>>,
    /// The surface of the liquid in screen space, directly from its particles; not together with
    /// `surface`.
    pub liquid_particles: Option<DrawnLiquidParticles<'a>>,
    /// A plane through the fluid.
    pub slice: Option<DrawnSlice<'a>>,
    /// Meshes of the liquid and of the bodies for tracing rays, and how carefully. Used if there is
    /// a `surface` and neither `particles` nor a `slice`; the rays then replace the approximations
    /// of the interactive picture.
    pub traced: Option<(&'a TracedMeshes, Quality)>,
    /// Droplets of the liquid that are not part of its mesh.
    pub droplets: Option<DrawnDroplets<'a>>,
    /// Foam, spray and bubbles.
    pub foam: Option<DrawnFoam<'a>>,
    /// Bodies.
    pub bodies: Option<BodyBuffers<'a>>,
    /// A line of text in the lower left corner.
    pub caption: Option<&'a str>,
}

/// `with_` methods that set an optional part of the frame.
macro_rules! setters {
    ($($(#[$doc:meta])* $method:ident, $field:ident: $type:ty;)*) => {
        impl<'a> Frame<'a> {
            $(
                $(#[$doc])*
                #[must_use]
                pub fn $method(self, $field: $type) -> Frame<'a> {
                    Frame { $field: Some($field), ..self }
                }
            )*
        }
    };
}

setters! {
    /// Adds particles as spheres.
    with_particles, particles: DrawnParticles<'a>;
    /// Adds the surface of the liquid as a mesh.
    with_surface, surface: DrawnSurface<'a>;
    /// Adds the surface of the liquid in screen space.
    with_liquid_particles, liquid_particles: DrawnLiquidParticles<'a>;
    /// Adds a plane through the fluid.
    with_slice, slice: DrawnSlice<'a>;
    /// Adds droplets.
    with_droplets, droplets: DrawnDroplets<'a>;
    /// Adds foam, spray and bubbles.
    with_foam, foam: DrawnFoam<'a>;
    /// Adds bodies.
    with_bodies, bodies: BodyBuffers<'a>;
    /// Adds a caption.
    with_caption, caption: &'a str;
}

impl<'a> Frame<'a> {
    /// A frame of an empty domain on a sunny day, lit from [`Frame::SUN`].
    pub fn new(camera: Camera, domain: Domain) -> Frame<'a> {
        Frame {
            camera,
            domain,
            sun: Frame::SUN,
            sky: Sky::day(),
            floor: Some(Floor::default()),
            tank: Tank::Glass,
            particles: None,
            surface: None,
            liquid_particles: None,
            slice: None,
            traced: None,
            droplets: None,
            foam: None,
            bodies: None,
            caption: None,
        }
    }

    /// Draws the liquid with traced rays: see [`Frame::traced`].
    #[must_use]
    pub fn with_tracing(self, meshes: &'a TracedMeshes, quality: Quality) -> Frame<'a> {
        Frame { traced: Some((meshes, quality)), ..self }
    }

    /// Whether panes of glass, and whether the edges of the domain are drawn, in a picture with or
    /// without a liquid.
    pub(crate) fn sides(&self, has_liquid: bool) -> (bool, bool) {
        match self.tank {
            Tank::Glass => (has_liquid, !has_liquid),
            Tank::Edges => (false, true),
            Tank::Hidden => (false, false),
        }
    }

    /// Whether a surface of liquid is drawn.
    pub(crate) fn has_liquid(&self) -> bool {
        let has_mesh = self.surface.is_some_and(|drawn| drawn.style != SurfaceStyle::Lines);
        has_mesh || self.liquid_particles.is_some()
    }

    /// Whether something refracts the picture behind it: a liquid or droplets.
    pub(crate) fn is_refracted(&self) -> bool {
        self.has_liquid() || self.droplets.is_some_and(|drawn| drawn.buffers.count > 0)
    }

    /// The number of samples if rays are traced.
    pub(crate) fn traced_samples(&self) -> Option<u32> {
        let (_, quality) = self.traced?;
        let only_liquid = self.surface.is_some_and(|surface| surface.style == SurfaceStyle::Liquid)
            && self.particles.is_none()
            && self.slice.is_none();
        only_liquid.then_some(quality.samples)
    }

    /// Whether the eye, or a point of its lens, lies within the bounds of the traced liquid.
    pub(crate) fn eye_may_be_in_liquid(&self) -> bool {
        self.traced.is_some_and(|(meshes, quality)| {
            let (eye, target) = (Vec3::from(self.camera.eye), Vec3::from(self.camera.target));
            // The near plane is at a thousandth of the distance of the target, up to a factor at the corners of the picture.
            let margin = Vec3::splat(quality.aperture + 0.01 * eye.distance(target));
            let [low, high] = meshes.water_bounds();
            eye.cmpge(low - margin).all() && eye.cmple(high + margin).all()
        })
    }

    /// The uniforms of a sample of a picture with traced rays.
    pub(crate) fn sample_globals(&self, tile: Tile, sample: u32) -> Result<Globals, RenderError> {
        let size = tile.tiling.picture();
        let mut globals = self.picture_globals(size, true)?;
        let Some((meshes, quality)) = self.traced else { return Ok(globals) };
        quality.check()?;
        let [width, height] = size.map(|side| side as f32);
        let view = self.camera.view(width / height)?;
        let target = Vec3::from(self.camera.target) - view.eye;
        let focus = quality.focus.unwrap_or_else(|| target.dot(view.forward).max(view.near));
        let (pixel, lens) = Quality::place(sample);
        let pixel = Vec2::new(2.0 * pixel[0] / width, 2.0 * pixel[1] / height);
        let (view, shift) = view.shifted(pixel, 0.5 * quality.aperture * Vec2::from(lens), focus);
        globals.clip_from_world = view.clip_from_world.to_cols_array_2d();
        globals.eye = view.eye.into();
        globals.ray_shift = shift.into();
        globals.linear_output = 1;
        globals.sample = sample;
        globals.sample_count = quality.samples;
        globals.shutter_time = quality.time(sample);
        if quality.shutter > 0.0 {
            // The samples move droplets and foam.
            globals.droplet_shutter = 0.0;
            globals.foam_shutter = 0.0;
        }
        (globals.water_root, globals.body_root) = meshes.roots();
        globals.body_heights = meshes.body_heights();
        tile.fill(&mut globals);
        Ok(globals)
    }

    /// Writes the uniforms of sky and floor.
    fn light(&self, sun: Vec3, globals: &mut Globals) -> Result<(), RenderError> {
        self.sky.fill(globals)?;
        let usual = Sky::day().on_floor(Vec3::from(Frame::SUN).normalize_or_zero());
        let daylight = self.sky.on_floor(sun) / usual;
        globals.bounced = (BOUNCED * daylight).into();
        globals.foam_light = self.sky.on_foam(sun).into();
        if let Some(floor) = &self.floor {
            floor.fill(globals)?;
            globals.bounced = (BOUNCED * daylight * floor.relative()).into();
        }
        Ok(())
    }

    /// The default sun: high, to the left and behind the box as seen from the +z side, so that the
    /// water reflects it towards the camera.
    pub const SUN: [f32; 3] = [-0.55, 0.85, -0.35];

    /// Checks the frame and computes the uniforms of the shaders.
    pub(crate) fn globals(&self, tile: Tile, target_is_srgb: bool) -> Result<Globals, RenderError> {
        let mut globals = self.picture_globals(tile.tiling.picture(), target_is_srgb)?;
        tile.fill(&mut globals);
        Ok(globals)
    }

    /// Pixels around a tile of a picture of this size that its passes read.
    pub(crate) fn border(&self, size: [u32; 2]) -> Result<u32, RenderError> {
        if !self.has_liquid() || self.traced_samples().is_some() {
            return Ok(0);
        }
        let around_exit = around_exit(size);
        let Some(drawn) = &self.liquid_particles else { return Ok(around_exit) };
        let view = self.camera.view(size[0] as f32 / size[1] as f32)?;
        let pixel_angle = 2.0 * view.up.length() / size[1] as f32;
        let nearest = view.eye.clamp(self.domain.min.into(), self.domain.max.into());
        Ok(drawn.border(view.eye.distance(nearest).max(view.near), pixel_angle).max(around_exit))
    }

    /// The uniforms of a picture in one piece.
    fn picture_globals(&self, size: [u32; 2], target_is_srgb: bool) -> Result<Globals, RenderError> {
        let [width, height] = size.map(|side| side as f32);
        let view = self.camera.view(width / height)?;
        self.domain.check()?;
        let sun = check_sun(self.sun)?;
        let (low, high) = (Vec3::from(self.domain.min), Vec3::from(self.domain.max));
        let extent = high - low;
        let scale = height / 720.0;
        let around = self.domain.surroundings();
        let floor_height = around.floor_height;
        let (shadow_min, shadow_size) = shadow_rectangle(&self.domain, sun, floor_height);
        let panes = panes_of(&self.domain);
        let mut globals = Globals {
            clip_from_world: view.clip_from_world.to_cols_array_2d(),
            eye: view.eye.into(),
            near: view.near,
            right: view.right.into(),
            pixel_angle: 2.0 * view.up.length() / height,
            up: view.up.into(),
            encode_srgb: u32::from(!target_is_srgb),
            forward: view.forward.into(),
            sun: sun.into(),
            floor_height,
            box_min: low.into(),
            tile_size: around.tile_size,
            box_max: high.into(),
            fade_distance: around.fade_distance,
            shadow_min: shadow_min.into(),
            shadow_size: shadow_size.into(),
            picture_size: [width, height],
            target_size: [width, height],
            ray_offset: 2e-5 * extent.length(),
            contact_distance: 0.006 * extent.length(),
            glass_thickness: around.glass_thickness,
            sunlit_panes: if self.tank == Tank::Glass { panes[0] | panes[2] << 2 } else { 0 },
            // Seen from inside, a pane would mirror the scene and hide nothing.
            glass: if self.domain.contains(view.eye) { [0; 4] } else { panes },
            sample_count: 1,
            // The positions of particles and of the plane behind the liquid are not known.
            exit_reach: if self.particles.is_some() || self.slice.is_some() { 0.0 } else { exit_reach(size) },
            line_width: (1.5 * scale).clamp(1.0, 8.0),
            ..Globals::default()
        };
        self.light(sun, &mut globals)?;
        for (edge, uniform) in self.domain.edges(view.eye).into_iter().zip(&mut globals.edges) {
            *uniform = EdgeGlobals {
                start: edge.start.into(),
                end: edge.end.into(),
                opacity: if edge.wall { 0.70 } else { 0.40 },
                dashes: if edge.wall { 0.0 } else { 24.0 },
            };
        }
        if let Some(bodies) = &self.bodies {
            bodies.check()?;
        }
        if let Some(particles) = &self.particles {
            particles.fill(&mut globals)?;
        }
        if let Some(slice) = &self.slice {
            slice.fill(&mut globals)?;
        }
        if let Some(foam) = &self.foam {
            foam.fill(&mut globals)?;
        }
        if let Some(droplets) = &self.droplets {
            droplets.fill(&mut globals)?;
        }
        if let Some(surface) = &self.surface {
            surface.fill(&mut globals)?;
        }
        if let Some(liquid) = &self.liquid_particles {
            if self.surface.is_some() {
                return Err(RenderError::TwoLiquids);
            }
            liquid.fill(&mut globals)?;
        }
        Ok(globals)
    }
}

/// Light from the default floor under the default sky and sun on surfaces that face it.
const BOUNCED: Vec3 = Vec3::new(0.178, 0.174, 0.161);

fn check_sun(sun: [f32; 3]) -> Result<Vec3, RenderError> {
    match Vec3::from(sun).try_normalize() {
        // The shadow of a lower sun would be too long for the shadow map.
        Some(sun) if sun.y >= 0.1 => Ok(sun),
        _ => Err(RenderError::Value {
            what: "the direction to the sun",
            given: format!("{sun:?}"),
            allowed: "a direction at least 6 degrees above the horizon",
        }),
    }
}

/// The part of the floor that the box can cast a shadow on: corner and size in (x, z), with a
/// margin for the blur.
fn shadow_rectangle(domain: &Domain, sun: Vec3, floor_height: f32) -> (Vec2, Vec2) {
    let on_floor = domain.corners().map(|corner| {
        let hit = corner - sun * ((corner.y - floor_height) / sun.y);
        Vec2::new(hit.x, hit.z)
    });
    let low = on_floor.iter().copied().fold(Vec2::INFINITY, Vec2::min);
    let high = on_floor.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
    let margin = 0.06 * (high - low);
    (low - margin, high - low + 2.0 * margin)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame() -> Frame<'static> {
        let domain = Domain::closed([0.0; 3], [2.0, 1.0, 1.0]);
        let camera = Camera::framing(&domain, 30.0, 20.0, 40.0, 1.5);
        Frame::new(camera, domain)
    }

    #[test]
    fn the_shadow_rectangle_contains_the_shadows_of_all_corners() {
        let globals = frame().globals(Tile::whole([300, 200]), true).unwrap();
        let sun = Vec3::from(globals.sun);
        for corner in frame().domain.corners() {
            let hit = corner - sun * ((corner.y - globals.floor_height) / sun.y);
            let uv =
                (Vec2::new(hit.x, hit.z) - Vec2::from(globals.shadow_min)) / Vec2::from(globals.shadow_size);
            assert!(uv.cmpgt(Vec2::ZERO).all() && uv.cmplt(Vec2::ONE).all(), "{uv}");
        }
    }

    #[test]
    fn a_sun_below_the_horizon_is_refused() {
        let error =
            Frame { sun: [0.0, -1.0, 0.0], ..frame() }.globals(Tile::whole([3, 2]), true).unwrap_err();
        assert!(error.to_string().contains("horizon"), "{error}");
        assert!(Frame { sun: [0.0; 3], ..frame() }.globals(Tile::whole([3, 2]), true).is_err());
    }
}
