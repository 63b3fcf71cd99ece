//! Creates the initial particles of a scene from its blocks, meshes and files.
//!
//! * A box whose size is a multiple of the spacing gets `size / particle_spacing` particles along each axis.
//!   The outermost ones lie half a spacing inside its faces: fluid that rests on a floor starts half a
//!   spacing above it, so that its image behind the wall continues the lattice (`boundary`).
//! * A ball gets the points of a lattice around its centre that lie inside it.
//! * A closed mesh gets the points inside it of the lattice of its bounding box.
//! * The particles of a file keep their positions.
//!
//! Blocks come first, then meshes, then files. Where two sources overlap, the particles of the later one are
//! left out. Within a source, x varies fastest, then y, then z. Ids count from 0.

mod filler;
mod grid;
mod hydrostatic;
mod sources;
mod spacing;

use std::iter::repeat_n;

use glam::Vec3;
use rayon::prelude::*;
use serde::Serialize;
use splashdown_io::{Attribute, IoError, Particles};

use crate::bodies::{BodyError, LoadedBody};
use crate::scene::lattice::Sampler;
use crate::scene::{DensityMode, Domain, Fluid, Method, Scene, place};

pub use crate::scene::lattice::MAX_PARTICLES;
pub(crate) use crate::scene::lattice::fitting_spacing;
pub(crate) use filler::{Added, Filler};
pub(crate) use hydrostatic::can_start_at_rest;
pub use hydrostatic::start_at_rest;
pub(crate) use sources::{Sources, file_title, mesh_title};
pub(crate) use spacing::crowding;
pub use spacing::{fitted_spacing, typical_spacing};

/// Smallest distance, in spacings, between fluid that is not packed and a body: for density summation, and for density from
/// the continuity equation.
///
/// A summed density is too large if a particle is too near to a body. The distance is therefore just under
/// half a spacing, at which fluid touches a wall. An integrated density starts at the rest density
/// everywhere, so the fluid does not close an initial gap around a body. With a gap of half a spacing a body
/// would displace more than its volume (a quarter more for a ball 12 spacings across), so all particles whose
/// centres lie outside stay.
const CLEARANCE: [f32; 2] = [0.49, 0.05];
/// For fluid that is packed around bodies: all particles outside remain, and with them the volume. The offset separates
/// particles on opposite faces of a body, so that it displaces its volume if both lie in layers of particles.
const CUT: (f32, Vec3) = (0.0, Vec3::new(0.03, 0.02, 0.01));
/// The distance for other fluid of a summed density, which is relaxed: nearer particles can end inside of an edge. Without
/// those closer than half a spacing a bucket of water lost a seventh of it.
const NEAREST: f32 = 0.05;
/// Smallest width, in spacings, of a gap between bodies or between a body and a wall that holds fluid.
const NARROWEST: f32 = 0.95;

/// Why a scene could not be filled with particles. [`Scene::load`] reports most of these errors with the line
/// of the scene file. For a scene built in code they are reported when it is filled.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SampleError {
    /// More particles than [`MAX_PARTICLES`].
    #[error(
        "the fluid would have {count} particles at a spacing of {spacing} m; at most {MAX_PARTICLES} are allowed: use a \
         particle_spacing of {fitting} m or more"
    )]
    TooMany {
        /// The estimated number of particles.
        count: u64,
        /// The spacing given, in m.
        spacing: f32,
        /// A spacing that fits, in m.
        fitting: f32,
    },
    /// The scene has no particles.
    #[error(
        "the fluid has no particles: there is no block, mesh, file or emitter, or every block is smaller than the particle_spacing of {spacing} m"
    )]
    Empty {
        /// The spacing given, in m.
        spacing: f32,
    },
    /// A mesh is too small for a single particle.
    #[error("{what} holds no particle at a spacing of {spacing} m: enlarge it, or refine particle_spacing")]
    TooSmall {
        /// The piece of fluid.
        what: String,
        /// The spacing given, in m.
        spacing: f32,
    },
    /// A mesh cannot be filled.
    #[error(transparent)]
    Mesh(Box<BodyError>),
    /// A particle file cannot be read.
    #[error("{what}: {source}")]
    File {
        /// The piece of fluid.
        what: String,
        /// What is wrong with the file.
        source: Box<IoError>,
    },
    /// A mesh reaches outside the domain, or most particles of a file lie outside it.
    #[error(
        "{what} {how}: it spans {} to {} m, the domain is {} to {} m; check its scale, position and rotation, or enlarge the domain",
        place(*low), place(*high), place(*min), place(*max)
    )]
    Beyond {
        /// The piece of fluid.
        what: String,
        /// The verb phrase of the message: "reaches outside the domain" or "lies mostly outside the domain".
        how: &'static str,
        /// Its lower corner in m.
        low: [f32; 3],
        /// Its upper corner in m.
        high: [f32; 3],
        /// The domain's lower corner, in m.
        min: [f32; 3],
        /// The domain's upper corner, in m.
        max: [f32; 3],
    },
    /// All particles lie inside bodies.
    #[error(
        "no fluid is left: all {removed} particles would be inside bodies; move the bodies or the fluid, or check their scale"
    )]
    AllInside {
        /// The number of particles.
        removed: u32,
    },
    /// The fluid cannot rest.
    #[error(
        "the fluid starts on average {ratio:.1} times as dense as at rest: set fluid.particle_spacing to the distance of its \
         particles, correct the scale of its files, or leave particles out"
    )]
    Overfull {
        /// The mean density over that at rest, or the mean number of particles in a cube of one spacing.
        ratio: f32,
    },
    /// A particle of a block lies outside the domain.
    #[error(
        "block {block} reaches outside the domain: it has a particle at {position:?} m, the domain is {min:?} to {max:?} m; \
         move or shrink the block, or enlarge the domain"
    )]
    Outside {
        /// The block's index in `fluid.blocks`.
        block: usize,
        /// The first such particle, in m.
        position: [f32; 3],
        /// The domain's lower corner, in m.
        min: [f32; 3],
        /// The domain's upper corner, in m.
        max: [f32; 3],
    },
}

impl From<BodyError> for SampleError {
    fn from(error: BodyError) -> Self {
        Self::Mesh(Box::new(error))
    }
}

/// The particles of a scene, with ids, positions (m) and velocities (m/s), without densities and pressures.
/// A simulation of the scene then applies `initial_pressure`. Particles of a file that lie outside the domain are left out.
///
/// # Errors
/// [`SampleError`] if there are no particles or too many, if a block or mesh reaches outside the domain, or
/// if a mesh or file cannot be used.
pub fn particles(scene: &Scene) -> Result<Particles, SampleError> {
    let particles = fill(scene, Sources::read(&scene.fluid))?;
    if particles.is_empty() && scene.emitters.is_empty() {
        return Err(SampleError::Empty { spacing: scene.fluid.particle_spacing });
    }
    Ok(particles)
}

/// As [`particles`], from meshes and files that have been read. The result may be empty.
pub(crate) fn fill(scene: &Scene, sources: Sources) -> Result<Particles, SampleError> {
    let fluid = &scene.fluid;
    let mut filler = Filler::new(&scene.domain, fluid.particle_spacing);
    filler.blocks(fluid)?;
    for (index, (mesh, read)) in fluid.meshes.iter().zip(sources.meshes).enumerate() {
        filler.mesh(&mesh_title(index, mesh), mesh, &read?)?;
    }
    for (index, (file, read)) in fluid.files.iter().zip(sources.files).enumerate() {
        filler.file(&file_title(index, file), file, &read?)?;
    }
    Ok(filler.finish())
}

/// True if no part of the fluid is a mesh or a file.
pub(crate) fn has_blocks_only(fluid: &Fluid) -> bool {
    fluid.meshes.is_empty() && fluid.files.is_empty()
}

/// The numbers of particles of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Inventory {
    /// Particles at the start.
    pub particles: u64,
    /// Particles of blocks, meshes and files that are left out because they would be inside bodies.
    pub removed: u64,
    /// Particles that the emitters create until the scene's end.
    pub emitted: u64,
}

/// The smallest distance of particles from bodies, and an offset of the places where it is measured, in spacings.
pub(crate) fn clearance_of(scene: &Scene) -> (f32, Vec3) {
    (CLEARANCE[usize::from(scene.solver.density == DensityMode::Continuity)], Vec3::ZERO)
}

fn is_summed(scene: &Scene) -> bool {
    scene.solver.method != Method::Wcsph || scene.solver.density == DensityMode::Summation
}

/// Whether gaps at bodies are closed by packing: around blocks that do not overlap, whose density is summed.
pub(crate) fn is_packed_around_bodies(scene: &Scene) -> bool {
    let samplers = || Sampler::all(&scene.domain, &scene.fluid);
    !scene.bodies.is_empty()
        && scene.emitters.is_empty()
        && has_blocks_only(&scene.fluid)
        && is_summed(scene)
        && samplers().iter().all(|sampler| sampler.counts().1 == 0)
}

/// Whether all particles come from files.
fn has_files_only(fluid: &Fluid) -> bool {
    fluid.blocks.is_empty() && fluid.meshes.is_empty() && !fluid.files.is_empty()
}

/// Removes the particles inside or too near to a body, renumbers the ids from 0 and returns the number
/// removed.
pub(crate) fn remove_inside(scene: &Scene, particles: &mut Particles, bodies: &[LoadedBody]) -> u32 {
    let clearance = if is_packed_around_bodies(scene) {
        CUT
    } else if has_files_only(&scene.fluid) {
        // In a frame of an earlier run, fluid under pressure is nearer to bodies than a block would start.
        (0.0, Vec3::ZERO)
    } else if is_summed(scene) {
        (NEAREST, Vec3::ZERO)
    } else {
        clearance_of(scene)
    };
    let removed = retain_outside(scene, particles, &bodies.iter().collect::<Vec<_>>(), clearance);
    if removed > 0 {
        particles.ids = (0..particles.positions.len() as u32).collect();
    }
    removed
}

/// Removes the particles inside or too near to a body at its initial pose and returns the number removed.
pub(crate) fn retain_outside(
    scene: &Scene,
    particles: &mut Particles,
    bodies: &[&LoadedBody],
    (clearance, offset): (f32, Vec3),
) -> u32 {
    let spacing = scene.fluid.particle_spacing;
    let (clearance, offset) = (clearance * spacing, offset * spacing);
    let free = |x: Vec3| {
        let mut near = surfaces_near(bodies, x + offset, spacing);
        if near.iter().any(|(distance, _)| *distance < clearance) {
            return false;
        }
        let bodies = near.len();
        near.extend(walls_near(&scene.domain, x, spacing));
        // A gap between surfaces that face one another.
        let is_narrow = |(k, (distance, normal)): (usize, &(f32, Vec3))| {
            near[k + 1..].iter().any(|(other, opposite)| {
                distance + other < NARROWEST * spacing && normal.dot(*opposite) < -0.5
            })
        };
        !near.iter().enumerate().take(bodies).any(is_narrow)
    };
    let kept: Vec<bool> = particles.positions.par_iter().map(|&x| free(x.into())).collect();
    let removed = kept.iter().filter(|kept| !**kept).count();
    if removed > 0 {
        retain_flagged(&mut particles.positions, &kept);
        retain_flagged(&mut particles.velocities, &kept);
        retain_flagged(&mut particles.ids, &kept);
        retain_flagged(&mut particles.densities, &kept);
        retain_flagged(&mut particles.pressures, &kept);
        for Attribute { components, values, .. } in &mut particles.attributes {
            let kept: Vec<bool> = kept.iter().flat_map(|&kept| repeat_n(kept, *components)).collect();
            retain_flagged(values, &kept);
        }
    }
    removed as u32
}

/// The distances in m and the normals of the bodies that are less than `reach` (m) from a point.
fn surfaces_near(bodies: &[&LoadedBody], x: Vec3, reach: f32) -> Vec<(f32, Vec3)> {
    let near = |body: &&LoadedBody| {
        let (position, rotation) = body.pose();
        let y = rotation.conjugate() * (x - position);
        let distance = body.solid.field.distance(y);
        (distance < reach).then(|| (distance, rotation * body.solid.field.normal(y)))
    };
    bodies.iter().filter_map(near).collect()
}

/// The distances in m and the normals of the closed sides that are less than `reach` (m) from a point.
fn walls_near(domain: &Domain, x: Vec3, reach: f32) -> impl Iterator<Item = (f32, Vec3)> {
    (0..6).filter_map(move |k| {
        let (axis, side) = (k / 2, k % 2);
        let distance = if side == 0 { x[axis] - domain.min[axis] } else { domain.max[axis] - x[axis] };
        let normal = if side == 0 { Vec3::AXES[axis] } else { -Vec3::AXES[axis] };
        (domain.closed[axis][side] && distance < reach).then_some((distance, normal))
    })
}

/// For each position whether it is farther than `reach` (m) from all bodies.
pub(crate) fn far_from(bodies: &[LoadedBody], positions: &[[f32; 3]], reach: f32) -> Vec<bool> {
    let bodies: Vec<&LoadedBody> = bodies.iter().collect();
    positions.par_iter().map(|&x| surfaces_near(&bodies, x.into(), reach).is_empty()).collect()
}

/// Removes the values whose flag is false. The list of an absent quantity is empty and stays empty.
fn retain_flagged<T>(values: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    values.retain(|_| *kept.next().unwrap_or(&true));
}
