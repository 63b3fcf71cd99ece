//! From the blocks, meshes and files of a scene to particles.
//!
//! A box of whole spacings gets `size / particle_spacing` particles along each axis, the outermost half a
//! spacing inside its faces: water that stands on a floor starts half a spacing above it, where the wall's
//! kernel integral expects it (`boundary`). A ball gets those particles of a lattice around its centre that lie
//! inside; a closed mesh those of the lattice that the box round it would have, so that it keeps its volume.
//! The particles of a file stay where they are. Where sources overlap, the one written first keeps the room:
//! blocks, then meshes, then files. The order is theirs, x fastest, then y, then z; ids count from 0.

mod filler;
mod near;
mod sources;
mod spacing;

use glam::Vec3;
use rayon::prelude::*;
use serde::Serialize;
use splashdown_io::{IoError, Particles};

use crate::bodies::{BodyError, LoadedBody};
use crate::scene::{DensityMode, Fluid, Scene, lattice, place};

pub use crate::scene::lattice::MAX_PARTICLES;
pub(crate) use crate::scene::lattice::fitting_spacing;
pub(crate) use filler::{Filler, Taken};
pub(crate) use sources::{Sources, file_title, mesh_title};
pub use spacing::typical_spacing;

/// How near to a body, in spacings, fluid may start: where densities are summed, and where they are integrated.
///
/// A sum feels a particle that is too near, so it keeps just under the half spacing at which fluid touches a
/// wall. An integrated density feels no gap either: what is left empty here stays empty, and a body would
/// displace its volume and half a spacing all around it (a fifth of a ball of 12 spacings). Centres of
/// particles outside fill the room outside.
const CLEARANCE: [f32; 2] = [0.49, 0.05];

/// Why a scene could not be filled with particles. [`Scene::load`] reports most of these earlier, with the
/// file's line; a scene built in code meets them here.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SampleError {
    /// More particles than [`MAX_PARTICLES`].
    #[error(
        "the fluid would have {count} particles at a spacing of {spacing} m; at most {MAX_PARTICLES} are allowed: use a \
         particle_spacing of {fitting} m or more"
    )]
    TooMany {
        /// How many it would have (an estimate).
        count: u64,
        /// The spacing given, in m.
        spacing: f32,
        /// A spacing that fits, in m.
        fitting: f32,
    },
    /// No particle at all.
    #[error(
        "the fluid has no particles: there is no block, mesh, file or emitter, or every block is smaller than the particle_spacing of {spacing} m"
    )]
    Empty {
        /// The spacing given, in m.
        spacing: f32,
    },
    /// A mesh that no particle fits into.
    #[error("{what} holds no particle at a spacing of {spacing} m: enlarge it, or refine particle_spacing")]
    TooSmall {
        /// The piece of fluid.
        what: String,
        /// The spacing given, in m.
        spacing: f32,
    },
    /// A mesh that cannot be filled.
    #[error(transparent)]
    Mesh(Box<BodyError>),
    /// A file of particles.
    #[error("{what}: {source}")]
    File {
        /// The piece of fluid.
        what: String,
        /// What is wrong with the file.
        source: Box<IoError>,
    },
    /// A mesh or a file outside the domain.
    #[error(
        "{what} {how}: it spans {} to {} m, the domain is {} to {} m; check its scale, position and rotation, or enlarge the domain",
        place(*low), place(*high), place(*min), place(*max)
    )]
    Beyond {
        /// The piece of fluid.
        what: String,
        /// Whether a part of it or all.
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
    /// Bodies take all the room.
    #[error(
        "no fluid is left: all {removed} particles would be inside bodies; move the bodies or the fluid, or check their scale"
    )]
    AllInside {
        /// How many there were.
        removed: u32,
    },
    /// A particle outside the domain.
    #[error(
        "block {block} reaches outside the domain: it has a particle at {position:?} m, the domain is {min:?} to {max:?} m; \
         move or shrink the block, or enlarge the domain"
    )]
    Outside {
        /// The block's place in `fluid.blocks`, from 0.
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

/// The particles of a scene at t = 0, with ids, positions (m) and velocities (m/s); densities and pressures are
/// absent. Of a file's particles those outside the domain are left out.
///
/// # Errors
/// [`SampleError`] if there are none, too many, or some outside the domain; or a mesh or file cannot be used.
pub fn particles(scene: &Scene) -> Result<Particles, SampleError> {
    let particles = fill(scene, Sources::read(&scene.fluid))?;
    if particles.is_empty() && scene.emitters.is_empty() {
        return Err(SampleError::Empty { spacing: scene.fluid.particle_spacing });
    }
    Ok(particles)
}

/// As [`particles`], from meshes and files that have been read. There may be none.
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

/// How many particles [`particles`] makes. Of blocks they are counted without storing them: exact up to
/// [`MAX_PARTICLES`], above that an estimate from the blocks' volumes, quick for sizes of any kind. Meshes are
/// filled and files read; one that cannot be used counts as none.
pub fn count(scene: &Scene) -> u64 {
    let fluid = &scene.fluid;
    let of_blocks = lattice::count(&scene.domain, fluid);
    if of_blocks > MAX_PARTICLES || has_blocks_only(fluid) {
        return of_blocks;
    }
    match particles(scene) {
        Ok(particles) => particles.len() as u64,
        Err(SampleError::TooMany { count, .. }) => count,
        Err(_) => of_blocks,
    }
}

/// What becomes of a scene's particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Inventory {
    /// Particles at the start.
    pub particles: u64,
    /// Particles of blocks, meshes and files that are left out because they would be inside bodies.
    pub removed: u64,
    /// Particles that the emitters will bring until the scene's end.
    pub emitted: u64,
}

/// Takes out the particles that lie inside bodies or too near to one; how many. Ids count from 0 again.
pub(crate) fn remove_inside(scene: &Scene, particles: &mut Particles, bodies: &[LoadedBody]) -> u32 {
    let removed = retain_outside(scene, particles, &bodies.iter().collect::<Vec<_>>());
    if removed > 0 {
        particles.ids = (0..particles.positions.len() as u32).collect();
    }
    removed
}

/// Takes out the particles that lie inside bodies, as they stand at the start, or too near to one; how many.
pub(crate) fn retain_outside(scene: &Scene, particles: &mut Particles, bodies: &[&LoadedBody]) -> u32 {
    let clearance = CLEARANCE[usize::from(scene.solver.density == DensityMode::Continuity)];
    let clearance = clearance * scene.fluid.particle_spacing;
    let poses: Vec<_> = bodies.iter().map(|body| body.pose()).collect();
    let free = |x: Vec3| {
        bodies.iter().zip(&poses).all(|(body, (position, rotation))| {
            body.solid.field.distance(rotation.conjugate() * (x - position)) >= clearance
        })
    };
    let kept: Vec<bool> = particles.positions.par_iter().map(|&x| free(x.into())).collect();
    let removed = kept.iter().filter(|kept| !**kept).count();
    if removed > 0 {
        keep(&mut particles.positions, &kept);
        keep(&mut particles.velocities, &kept);
        keep(&mut particles.ids, &kept);
        keep(&mut particles.densities, &kept);
        keep(&mut particles.pressures, &kept);
    }
    removed as u32
}

/// Those that are kept; a quantity that particles do not have is an empty list and stays one.
fn keep<T>(values: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    values.retain(|_| *kept.next().unwrap_or(&true));
}
