//! What the particle spacing resolves: lengths of the scene in spacings.

use glam::Vec3;
use serde::Serialize;

use super::validated::{Validated, validated};
use crate::bodies::{BodyError, mesh_of, owner};
use crate::boundary::closed_bounds;
use crate::sample::mesh_title;
use crate::scene::{Body, DensityMode, MeshSource, Method, Motion, Outlet, Scene, Shape};
use crate::solid::{self, Triangles, widths};

/// Parts of solids and gaps are measured up to this many spacings.
const WIDEST: f32 = 16.0;
/// Surfaces closer than this, in spacings, touch.
const TOUCHING: f32 = 0.25;
/// Particles on both sides of a solid thinner than this interact through it: the support of two spacings, less half a
/// spacing on each side.
const THIN_SOLID: f32 = 1.0;
/// Below a body that is nearer to the floor there is no layer of particles, or one that cannot be replaced.
const SEALED: f32 = 1.5;
/// Narrower gaps and thinner pieces of fluid have too few particles across for a velocity profile.
const NARROW: f32 = 3.0;
/// Bodies with parts of one to three spacings that float in fluid whose density is integrated have been measured to sink up to
/// twice too deep (docs/validation.md, floating shapes).
const THIN_FLOAT: f32 = 4.0;
/// A shorter wave loses most of its height within a period.
const SHORT_WAVE: f32 = 20.0;
/// A lower wave is hidden by the steps of the layers of particles.
const LOW_WAVE: f32 = 1.0;

/// What the particle spacing resolves. Lengths are in particle spacings.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Resolution {
    /// The depth of the deepest piece of fluid along gravity; `None` without gravity or without pieces.
    pub depth: Option<f32>,
    /// The shortest extent of each piece of fluid, and the width of each outlet.
    pub fluid: Vec<Extent>,
    /// The widths of each body.
    pub bodies: Vec<BodyWidths>,
    /// The wave that an oscillating domain makes.
    pub wave: Option<Wave>,
    /// The validated cases nearest to the scene.
    pub validated: Vec<Validated>,
}

/// The shortest extent of something.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Extent {
    /// Its name in messages.
    pub owner: String,
    /// In spacings.
    pub spacings: f32,
}

/// How thick a body is, and how narrow the gap in front of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct BodyWidths {
    /// Its name in messages.
    pub owner: String,
    /// A twentieth of its surface belongs to parts that are at most this thick; `None`: thicker than 16 spacings, or a
    /// shell.
    pub thickness: Option<f32>,
    /// Whether it is a shell.
    pub is_shell: bool,
    /// A twentieth of its surface is at most this far from a body or a closed side, at the start; `None`: farther than 16
    /// spacings.
    pub gap: Option<f32>,
    /// Its longest side in spacings.
    #[serde(skip)]
    length: f32,
    /// It moves without a hinge, is lighter than the fluid, and the density of the fluid is integrated.
    #[serde(skip)]
    floats_in_continuity: bool,
    /// The height in spacings above the floor of a light body in the fluid, if no particles fit below it.
    #[serde(skip)]
    sealed_at: Option<f32>,
}

/// A wave.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Wave {
    /// Its length.
    pub length: f32,
    /// The amplitude of the motion that makes it. At resonance the wave is higher.
    pub amplitude: f32,
}

/// What the particle spacing of a scene resolves.
///
/// # Errors
/// [`BodyError`] of a mesh that cannot be read.
pub fn resolution(scene: &Scene) -> Result<Resolution, BodyError> {
    let depth = depth(scene);
    Ok(Resolution {
        depth,
        fluid: fluid(scene)?,
        bodies: bodies(scene)?,
        wave: depth.and_then(|depth| wave(scene, depth)),
        validated: validated(scene, depth),
    })
}

impl Resolution {
    /// What is too coarse, each as a sentence with advice.
    pub fn too_coarse(&self) -> Vec<String> {
        let mut all = Vec::new();
        for Extent { owner, spacings } in self.fluid.iter().filter(|piece| piece.spacings < NARROW) {
            all.push(format!(
                "{owner} is {spacings:.1} spacings across: a film of fewer than {NARROW} has no inner flow"
            ));
        }
        for BodyWidths { owner, thickness, gap, length, floats_in_continuity, sealed_at, .. } in &self.bodies
        {
            if *length < 1.0 {
                all.push(format!(
                    "{owner} is {length:.2} spacings long, less than a particle: check its scale"
                ));
                continue;
            }
            if let Some(thickness) = thickness.filter(|&thickness| thickness < THIN_SOLID) {
                all.push(format!(
                    "{owner} has parts {thickness:.1} spacings thick: fluid on both sides interacts through parts thinner than \
                     {THIN_SOLID}"
                ));
            }
            if let Some(thickness) =
                thickness.filter(|&thickness| *floats_in_continuity && thickness < THIN_FLOAT)
            {
                all.push(format!(
                    "{owner} has parts {thickness:.1} spacings thick: with density = \"continuity\" bodies this thin have floated up to \
                     twice too deep, and method = \"dfsph\" is more accurate"
                ));
            }
            if let Some(height) = sealed_at {
                all.push(format!(
                    "{owner} is lighter than the fluid around it and {height:.1} spacings above the floor: no particle fits below \
                     it, so that no pressure lifts it in water at rest; leave two spacings"
                ));
            }
            if let Some(gap) = gap.filter(|&gap| gap < NARROW) {
                all.push(format!(
                    "{owner} leaves a gap of {gap:.1} spacings: the flow through gaps narrower than {NARROW} is too slow"
                ));
            }
        }
        if let Some(Wave { length, amplitude }) = self.wave {
            if length < SHORT_WAVE {
                all.push(format!("the waves of the oscillating domain are {length:.0} spacings long: waves shorter than {SHORT_WAVE} decay within a period"));
            }
            if amplitude < LOW_WAVE {
                all.push(format!("the domain oscillates by {amplitude:.2} spacings: waves lower than {LOW_WAVE} spacing are hidden by the layers of particles"));
            }
        }
        all
    }
}

/// The largest extent of a piece of fluid along gravity.
fn depth(scene: &Scene) -> Option<f32> {
    let down = scene.gravity.try_normalize()?;
    let blocks = scene.fluid.blocks.iter().map(|block| {
        let (low, high) = block.shape.bounds();
        (high - low).dot(down.abs())
    });
    let deepest = blocks.fold(0.0, f32::max);
    (deepest > 0.0).then(|| deepest / scene.fluid.particle_spacing)
}

fn fluid(scene: &Scene) -> Result<Vec<Extent>, BodyError> {
    let spacing = scene.fluid.particle_spacing;
    let mut all = Vec::new();
    for (index, block) in scene.fluid.blocks.iter().enumerate() {
        let shortest = match block.shape {
            Shape::Box { size, .. } => size.min_element(),
            Shape::Sphere { radius, .. } => 2.0 * radius,
        };
        all.push(Extent { owner: format!("fluid.block[{index}]"), spacings: shortest / spacing });
    }
    for (index, filled) in scene.fluid.meshes.iter().enumerate() {
        let owner = mesh_title(index, filled);
        let (surface, is_shell) = surface(&owner, &filled.mesh, filled.shell)?;
        let (low, high) = (Vec3::NEG_INFINITY, Vec3::INFINITY);
        let found = widths(&[surface], low, high, TOUCHING * spacing, WIDEST * spacing);
        if let Some(thickness) = found[0].thickness.filter(|_| !is_shell) {
            all.push(Extent { owner, spacings: thickness / spacing });
        }
    }
    for emitter in &scene.emitters {
        let width = match &emitter.outlet {
            Outlet::Disc { radius } => 2.0 * radius,
            Outlet::Rectangle { size } => size[0].min(size[1]),
            Outlet::Mesh(_) => continue,
        };
        all.push(Extent { owner: format!("emitter {:?}", emitter.name), spacings: width / spacing });
    }
    Ok(all)
}

fn bodies(scene: &Scene) -> Result<Vec<BodyWidths>, BodyError> {
    let spacing = scene.fluid.particle_spacing;
    let is_integrated =
        scene.solver.method == Method::Wcsph && scene.solver.density == DensityMode::Continuity;
    let has_gravity = scene.gravity != Vec3::ZERO;
    let floats = |body: &Body| match body.motion {
        Motion::Dynamic { density, hinge: None, .. } => density < scene.fluid.material.rest_density,
        _ => false,
    };
    let floating: Vec<bool> = scene.bodies.iter().map(|body| has_gravity && floats(body)).collect();
    let named = scene.bodies.iter().map(|body| (owner("body", &body.name, &body.mesh), body));
    let (mut owners, mut surfaces) = (Vec::new(), Vec::new());
    for (owner, body) in named {
        let (triangles, is_shell) = surface(&owner, &body.mesh, body.shell)?;
        owners.push((owner, is_shell));
        surfaces.push(triangles);
    }
    let domain = &scene.domain;
    let closed = domain.closed.as_flattened().iter().enumerate();
    let bits = closed.map(|(bit, &closed)| u32::from(closed) << bit).sum();
    let [low, high] = closed_bounds(domain.min, domain.max, bits);
    let found = widths(&surfaces, low, high, TOUCHING * spacing, WIDEST * spacing);
    let in_spacings = |width: Option<f32>| width.map(|width| width / spacing);
    let places = surfaces.iter().map(|surface| (height_above_floor(scene, surface), longest_side(surface)));
    let places: Vec<_> = places.collect();
    let each = owners.into_iter().zip(found).zip(floating).zip(places).map(
        |((((owner, is_shell), widths), floats), (height, length))| BodyWidths {
            owner,
            thickness: in_spacings(widths.thickness.filter(|_| !is_shell)),
            is_shell,
            length: length / spacing,
            gap: in_spacings(widths.gap),
            floats_in_continuity: floats && is_integrated,
            sealed_at: height.filter(|&height| floats && height < SEALED),
        },
    );
    Ok(each.collect())
}

/// The lower and the upper corner of a surface that is not empty.
fn corners(surface: &Triangles) -> Option<(Vec3, Vec3)> {
    let points = || surface.iter().flatten().copied();
    Some((points().reduce(Vec3::min)?, points().reduce(Vec3::max)?))
}

/// The longest side of the box around a surface in m.
fn longest_side(surface: &Triangles) -> f32 {
    corners(surface).map_or(0.0, |(low, high)| (high - low).max_element())
}

/// The height of the lowest point of a surface above the closed side to which gravity points, in spacings. `None` for one
/// that does not meet a block of fluid.
fn height_above_floor(scene: &Scene, surface: &Triangles) -> Option<f32> {
    let (low, high) = corners(surface)?;
    let is_wet = scene.fluid.blocks.iter().any(|block| {
        let (from, to) = block.shape.bounds();
        low.cmplt(to).all() && high.cmpgt(from).all()
    });
    let axis = scene.gravity.abs().max_position();
    let side = usize::from(scene.gravity[axis] > 0.0);
    let height = if side == 0 { low - scene.domain.min } else { scene.domain.max - high };
    let is_above_floor = is_wet && scene.domain.closed[axis][side];
    is_above_floor.then(|| height[axis].max(0.0) / scene.fluid.particle_spacing)
}

/// The repaired triangles of a mesh at its initial pose, and whether it is a shell.
fn surface(owner: &str, source: &MeshSource, shell: Option<bool>) -> Result<(Triangles, bool), BodyError> {
    let (mesh, report) = solid::repair(&mesh_of(owner, source)?, shell);
    let place = |v: u32| source.position + source.rotation * Vec3::from(mesh.vertices[v as usize]);
    Ok((mesh.triangles.iter().map(|t| t.map(place)).collect(), report.shell))
}

/// The wave whose period is that of the domain's oscillation, by the dispersion of linear waves, omega^2 = g k tanh(k h)
/// (Lamb 1932, article 229).
fn wave(scene: &Scene, depth: f32) -> Option<Wave> {
    let oscillation = scene.domain.oscillation?;
    let spacing = scene.fluid.particle_spacing;
    let gravity = scene.gravity.length();
    let rate = std::f32::consts::TAU / oscillation.period;
    let mut number = rate * rate / gravity;
    // Newton's method for k tanh(k h) = omega^2 / g, from deep water.
    let depth = depth * spacing;
    for _ in 0..20 {
        let tanh = (number * depth).tanh();
        let slope = tanh + number * depth * (1.0 - tanh * tanh);
        number -= (number * tanh - rate * rate / gravity) / slope.max(f32::MIN_POSITIVE);
    }
    let length = std::f32::consts::TAU / number / spacing;
    let amplitude = oscillation.amplitude.length() / spacing;
    (length.is_finite() && length > 0.0).then_some(Wave { length, amplitude })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Resolution {
        resolution(&Scene::parse(text, "resolution").unwrap()).unwrap()
    }

    fn scene(more: &str, bodies: &str) -> String {
        format!(
            "[scene]\nname = \"x\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n{more}\n[fluid]\nparticle_spacing = 0.02\n\
             [[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, 0.5, 0.04]\n{bodies}"
        )
    }

    const PLATE: &str =
        "[[body]]\nname = \"plate\"\nmesh = \"cube\"\nscale = [0.4, 0.01, 0.4]\nposition = [0.5, 0.85, 0.5]";

    #[test]
    fn thin_plates_and_films_are_reported_and_thick_ones_are_not() {
        let found = of(&scene("", PLATE));
        assert!((found.depth.unwrap() - 25.0).abs() < 0.1, "{found:?}");
        assert!((found.fluid[0].spacings - 2.0).abs() < 0.01, "{found:?}");
        assert!((found.bodies[0].thickness.unwrap() - 0.5).abs() < 0.05, "{found:?}");
        assert!((found.bodies[0].gap.unwrap() - 7.25).abs() < 0.2, "{found:?}");
        let coarse = found.too_coarse();
        assert_eq!(coarse.len(), 2, "{coarse:?}");
        assert!(coarse[0].contains("fluid.block[0]") && coarse[1].contains("plate"), "{coarse:?}");
        let fine = scene("", &PLATE.replace("0.01", "0.1")).replace("0.04]", "1]");
        assert_eq!(of(&fine).too_coarse(), Vec::<String>::new());
    }

    #[test]
    fn thin_bodies_that_float_in_continuity_are_reported() {
        let coarse = |height: &str, motion: &str, solver: &str| {
            let plate = PLATE.replace("0.01", height);
            let text = scene("", &format!("{plate}\nmotion = \"dynamic\"\n{motion}\n[solver]\n{solver}\n"));
            of(&text.replace("0.04]", "1]")).too_coarse()
        };
        let continuity = "method = \"wcsph\"\ndensity = \"continuity\"";
        let found = coarse("0.04", "density = 300", continuity);
        assert!(found.len() == 1 && found[0].contains("plate") && found[0].contains("dfsph"), "{found:?}");
        assert_eq!(coarse("0.04", "density = 300", "accuracy = \"engineering\"").len(), 1);
        assert_eq!(coarse("0.04", "density = 300", "method = \"dfsph\"").len(), 0);
        assert_eq!(coarse("0.04", "density = 2000", continuity).len(), 0);
        assert_eq!(coarse("0.14", "density = 300", continuity).len(), 0);
        let hinged = "density = 300\nhinge = [0, 0, 1]\nhinge_point = [0.5, 0.85, 0.5]";
        assert_eq!(coarse("0.04", hinged, continuity).len(), 0);
    }

    /// In shallow water the length is the period times sqrt(g h), in deep water g T^2 / (2 pi).
    #[test]
    fn the_wave_of_an_oscillating_domain_has_the_length_of_linear_theory() {
        let shaken = |period: f32| {
            let shaking = format!("[domain.oscillation]\namplitude = [0.01, 0, 0]\nperiod = {period}\n");
            of(&scene(&shaking, "")).wave.unwrap()
        };
        let shallow = shaken(20.0);
        let expected = 20.0 * (9.81_f32 * 0.5).sqrt() / 0.02;
        assert!((shallow.length / expected - 1.0).abs() < 0.01, "{shallow:?}");
        let deep = shaken(0.3);
        let expected = 9.81 * 0.09 / std::f32::consts::TAU / 0.02;
        assert!((deep.length / expected - 1.0).abs() < 0.01, "{deep:?}");
        assert!((deep.amplitude - 0.5).abs() < 0.01, "{deep:?}");
    }

    #[test]
    fn a_body_smaller_than_a_particle_is_reported() {
        let body = |scale: f32| {
            format!(
                "[[body]]\nname = \"crumb\"\nmesh = \"cube\"\nscale = {scale}\nposition = [0.5, 0.8, 0.5]\n"
            )
        };
        let found = |scale: f32| of(&scene("", &body(scale))).too_coarse().join(" ");
        assert!(found(0.002).contains("0.10 spacings long, less than a particle"), "{}", found(0.002));
        assert!(!found(0.2).contains("less than a particle"));
    }

    #[test]
    fn a_light_body_close_to_the_floor_is_reported() {
        let found = |height: f32, density: f32, fluid: f32| {
            let text = format!(
                "[scene]\nname = \"raft\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[fluid]\n\
                 particle_spacing = 0.025\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [{fluid}, 0.5, 1]\n\
                 [[body]]\nname = \"raft\"\nmesh = \"cube\"\nscale = 0.2\nposition = [0.5, {}, 0.5]\n\
                 motion = \"dynamic\"\ndensity = {density}\n",
                0.1 + height
            );
            let scene = Scene::parse(&text, "raft.toml").unwrap_or_else(|errors| panic!("{errors}"));
            let all = resolution(&scene).unwrap().too_coarse();
            all.iter().any(|text| text.contains("0.4 spacings above the floor"))
        };
        assert!(found(0.01, 500.0, 1.0));
        assert!(!found(0.05, 500.0, 1.0), "two spacings above the floor");
        assert!(!found(0.01, 2000.0, 1.0), "heavier than water");
        assert!(!found(0.01, 500.0, 0.3), "beside the fluid");
    }
}
