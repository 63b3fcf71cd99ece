//! What a picture shows.

use crate::globals::{EdgeGlobals, Globals};
use crate::{
    BodyBuffers, Camera, ColourMap, Domain, DrawnFoam, DrawnLiquidParticles, DrawnSlice, Liquid,
    ParticleBuffers, RenderError, SurfaceBuffers,
};
use glam::{Vec2, Vec3};

/// Everything about one picture.
///
/// Particles and a liquid may both be there: the particles are then seen through the liquid.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Where the picture is taken from.
    pub camera: Camera,
    /// The box, drawn as lines; it also sets the floor's height and the scale of its tiles.
    pub domain: Domain,
    /// Direction towards the sun, of any length, above the horizon. [`Frame::SUN`] suits a camera on the +z side.
    pub sun: [f32; 3],
    /// Particles as spheres.
    pub particles: Option<DrawnParticles<'a>>,
    /// The liquid's surface as a mesh.
    pub surface: Option<DrawnSurface<'a>>,
    /// The liquid's surface straight from its particles; not together with `surface`.
    pub liquid_particles: Option<DrawnLiquidParticles<'a>>,
    /// A plane through the fluid.
    pub slice: Option<DrawnSlice<'a>>,
    /// Foam, spray and bubbles.
    pub foam: Option<DrawnFoam<'a>>,
    /// Solids.
    pub bodies: Option<BodyBuffers<'a>>,
    /// A line of text in the lower left corner.
    pub caption: Option<&'a str>,
}

/// Particles and how to draw them.
#[derive(Clone, Copy, Debug)]
pub struct DrawnParticles<'a> {
    /// Where they are.
    pub buffers: ParticleBuffers<'a>,
    /// Radius of the spheres in metres, usually half the particle spacing.
    pub radius: f32,
    /// Their colours.
    pub colouring: Colouring,
}

/// Which number becomes which colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colouring {
    /// The number.
    pub quantity: Quantity,
    /// Values at the two ends of the colour map, in the quantity's unit. Values beyond get the end's colour; equal ends
    /// are drawn apart a little.
    pub range: [f32; 2],
    /// The colours.
    pub map: ColourMap,
    /// Whether the picture has a colour bar.
    pub colour_bar: bool,
}

/// A number that each particle has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Length of the velocity, m/s.
    Speed,
    /// Density, kg/m^3.
    Density,
    /// Pressure, Pa.
    Pressure,
}

/// A surface and how to draw it.
#[derive(Clone, Copy, Debug)]
pub struct DrawnSurface<'a> {
    /// Where it is.
    pub buffers: SurfaceBuffers<'a>,
    /// How the liquid looks.
    pub liquid: Liquid,
    /// Whether the mesh itself is to be seen.
    pub style: SurfaceStyle,
}

/// What of a surface is drawn.
///
/// Lines need buffers of vertices and indices with [`wgpu::BufferUsages::STORAGE`], and draw arguments whose
/// base vertex is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SurfaceStyle {
    /// The liquid.
    #[default]
    Liquid,
    /// The liquid, and the edges of the triangles on it.
    LiquidWithLines,
    /// The edges of the triangles alone; those that face away are fainter.
    Lines,
}

impl<'a> Frame<'a> {
    /// An empty box under [`Frame::SUN`], to be filled by `Frame { particles: .., ..Frame::new(camera, domain) }`.
    pub fn new(camera: Camera, domain: Domain) -> Frame<'a> {
        Frame {
            camera,
            domain,
            sun: Frame::SUN,
            particles: None,
            surface: None,
            liquid_particles: None,
            slice: None,
            foam: None,
            bodies: None,
            caption: None,
        }
    }

    /// A sun that stands high on the left behind the box, seen from the +z side, so that water glitters towards
    /// the camera.
    pub const SUN: [f32; 3] = [-0.55, 0.85, -0.35];

    /// Refuses numbers that would draw nonsense, and works out what the shaders read.
    pub(crate) fn globals(&self, size: [u32; 2], target_is_srgb: bool) -> Result<Globals, RenderError> {
        let [width, height] = size.map(|side| side as f32);
        let view = self.camera.view(width / height)?;
        self.domain.check()?;
        let sun = check_sun(self.sun)?;
        let (low, high) = (Vec3::from(self.domain.min), Vec3::from(self.domain.max));
        let extent = high - low;
        let scale = height / 720.0;
        // A little below the box, so that the floor never fights with the fluid's lower side.
        let floor_height = low.y - 0.002 * extent.length();
        let (shadow_min, shadow_size) = shadow_rectangle(&self.domain, sun, floor_height);
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
            tile_size: nice_tile(0.2 * extent.x.max(extent.z)),
            box_max: high.into(),
            fade_distance: 2.6 * extent.length(),
            shadow_min: shadow_min.into(),
            shadow_size: shadow_size.into(),
            picture_size: [width, height],
            line_width: (1.5 * scale).clamp(1.0, 8.0),
            ..Globals::default()
        };
        for (edge, drawn) in self.domain.edges(view.eye).into_iter().zip(&mut globals.edges) {
            *drawn = EdgeGlobals {
                start: edge.start.into(),
                end: edge.end.into(),
                opacity: if edge.wall { 0.70 } else { 0.40 },
                dashes: if edge.wall { 0.0 } else { 24.0 },
            };
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
        if let Some(bodies) = &self.bodies {
            bodies.check()?;
            // Solids let no light through; the liquid's own values, if there is one, take this place.
            globals.shadow_absorption = [1.0; 3];
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

impl DrawnParticles<'_> {
    fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        self.buffers.check()?;
        check_radius(self.radius)?;
        let [low, high] = self.colouring.checked_range()?;
        globals.particle_radius = self.radius;
        globals.quantity = self.colouring.quantity.index();
        globals.range_low = low;
        globals.range_scale = 1.0 / (high - low);
        // Spheres let no light through; a few layers of them are dark.
        globals.shadow_absorption = [0.35 / self.radius; 3];
        globals.set_shadow_of_particles(self.radius);
        Ok(())
    }
}

impl Quantity {
    /// As in `shared/quantity.wgsl`.
    pub(crate) fn index(self) -> u32 {
        match self {
            Quantity::Speed => 0,
            Quantity::Density => 1,
            Quantity::Pressure => 2,
        }
    }
}

impl Colouring {
    /// The two ends, apart from each other.
    pub(crate) fn checked_range(&self) -> Result<[f32; 2], RenderError> {
        let [low, high] = self.range;
        if !(low.is_finite() && high.is_finite() && low <= high) {
            return Err(RenderError::Value {
                what: "the range of the colours",
                given: format!("{low} to {high}"),
                allowed: "two finite numbers, the smaller one first",
            });
        }
        // Below this, differences are lost in the rounding of the values themselves.
        let least = (1e-5 * low.abs().max(high.abs())).max(1e-6);
        Ok([low, high.max(low + least)])
    }
}

impl DrawnSurface<'_> {
    fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        self.buffers.check()?;
        self.liquid.fill(globals)
    }
}

/// Refuses radii that would draw nothing or everything.
pub(crate) fn check_radius(radius: f32) -> Result<(), RenderError> {
    if radius > 0.0 && radius.is_finite() {
        return Ok(());
    }
    Err(RenderError::Value {
        what: "the particles' radius",
        given: format!("{radius} m"),
        allowed: "a finite number above 0",
    })
}

fn check_sun(sun: [f32; 3]) -> Result<Vec3, RenderError> {
    match Vec3::from(sun).try_normalize() {
        // A lower sun would throw shadows of endless length.
        Some(sun) if sun.y >= 0.1 => Ok(sun),
        _ => Err(RenderError::Value {
            what: "the direction to the sun",
            given: format!("{sun:?}"),
            allowed: "a direction at least 6 degrees above the horizon",
        }),
    }
}

/// The part of the floor that the box can throw a shadow on: corner and size in (x, z), with a margin for the blur.
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

/// 1, 2 or 5 times a power of ten, at most the given length: tiles that serve as a ruler.
fn nice_tile(length: f32) -> f32 {
    let power = 10f32.powf(length.log10().floor());
    match length / power {
        ratio if ratio >= 5.0 => 5.0 * power,
        ratio if ratio >= 2.0 => 2.0 * power,
        _ => power,
    }
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
    fn the_shadow_s_rectangle_holds_every_corner_s_shadow() {
        let globals = frame().globals([300, 200], true).unwrap();
        let sun = Vec3::from(globals.sun);
        for corner in frame().domain.corners() {
            let hit = corner - sun * ((corner.y - globals.floor_height) / sun.y);
            let uv =
                (Vec2::new(hit.x, hit.z) - Vec2::from(globals.shadow_min)) / Vec2::from(globals.shadow_size);
            assert!(uv.cmpgt(Vec2::ZERO).all() && uv.cmplt(Vec2::ONE).all(), "{uv}");
        }
    }

    #[test]
    fn tiles_are_round_numbers() {
        for (length, tile) in [(0.4, 0.2), (0.99, 0.5), (1.0, 1.0), (7.0, 5.0), (23.0, 20.0)] {
            assert!((nice_tile(length) - tile).abs() < 1e-5 * tile, "{length} gives {}", nice_tile(length));
        }
    }

    #[test]
    fn a_range_without_width_is_widened_and_nonsense_refused() {
        let range = |low, high| {
            let colour = Colouring {
                quantity: Quantity::Speed,
                range: [low, high],
                map: ColourMap::Water,
                colour_bar: true,
            };
            colour.checked_range()
        };
        let [low, high] = range(0.0, 0.0).unwrap();
        assert!(low == 0.0 && high > 0.0);
        let [low, high] = range(1000.0, 1000.0).unwrap();
        assert!(low == 1000.0 && high > 1000.0);
        assert!(
            range(1.0, 0.0).is_err() && range(f32::NAN, 1.0).is_err() && range(0.0, f32::INFINITY).is_err()
        );
    }

    #[test]
    fn a_sun_below_the_horizon_is_refused() {
        let error = Frame { sun: [0.0, -1.0, 0.0], ..frame() }.globals([3, 2], true).unwrap_err();
        assert!(error.to_string().contains("horizon"), "{error}");
        assert!(Frame { sun: [0.0; 3], ..frame() }.globals([3, 2], true).is_err());
    }
}
