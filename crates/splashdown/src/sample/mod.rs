//! From the blocks of a scene to particles on a lattice.
//!
//! A box of whole spacings gets `size / particle_spacing` particles along each axis, the outermost half a spacing inside its
//! faces: water that stands on a floor starts half a spacing above it, where the wall's kernel integral expects it
//! (`boundary`). A ball gets those particles of a lattice around its centre that lie inside. Where blocks overlap, the one
//! written first keeps the room. The order is that of the blocks, x fastest, then y, then z; ids count from 0.

mod lattice;

use glam::Vec3;
use rayon::prelude::*;
use splashdown_io::Particles;

use crate::bodies::LoadedBody;
use crate::scene::{Domain, Fluid, Scene};
pub(crate) use lattice::Sampler;

/// Most particles of a scene: 2^26.
pub const MAX_PARTICLES: u64 = 1 << 26;

/// Why a scene could not be filled with particles. [`Scene::load`] reports all of these earlier, with the file's line; a
/// scene built in code meets them here.
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
    #[error("the fluid has no particles: every block is smaller than the particle_spacing of {spacing} m")]
    Empty {
        /// The spacing given, in m.
        spacing: f32,
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

/// The particles of a scene at t = 0, with ids, positions (m) and velocities (m/s); densities and pressures are absent.
///
/// # Errors
/// [`SampleError`] if there are none, too many, or some outside the domain.
pub fn particles(scene: &Scene) -> Result<Particles, SampleError> {
    let (domain, fluid) = (&scene.domain, &scene.fluid);
    let spacing = fluid.particle_spacing;
    let estimate = estimate(fluid);
    if estimate > MAX_PARTICLES {
        let fitting = fitting_spacing(spacing, estimate);
        return Err(SampleError::TooMany { count: estimate, spacing, fitting });
    }
    let mut positions: Vec<[f32; 3]> = Vec::with_capacity(estimate as usize);
    let mut velocities: Vec<[f32; 3]> = Vec::with_capacity(estimate as usize);
    let mut outside = None;
    for (block, sampler) in Sampler::all(domain, fluid).iter().enumerate() {
        let velocity = fluid.blocks[block].velocity.to_array();
        sampler.for_each(|position, free| {
            if !free {
                return;
            }
            let position = position.map(|x| x as f32);
            let inside = (0..3).all(|a| position[a] >= domain.min[a] && position[a] <= domain.max[a]);
            if !inside && outside.is_none() {
                outside = Some((block, position));
            }
            positions.push(position);
            velocities.push(velocity);
        });
    }
    if let Some((block, position)) = outside {
        let (min, max) = (domain.min.to_array(), domain.max.to_array());
        return Err(SampleError::Outside { block, position, min, max });
    }
    if positions.is_empty() && scene.emitters.is_empty() {
        return Err(SampleError::Empty { spacing });
    }
    let ids = (0..positions.len() as u32).collect();
    Ok(Particles { ids, positions, velocities, densities: Vec::new(), pressures: Vec::new() })
}

/// How many particles [`particles`] makes, without storing them. Exact up to [`MAX_PARTICLES`], above that an estimate from the
/// blocks' volumes; quick for sizes of any kind.
pub fn count(scene: &Scene) -> u64 {
    count_in(&scene.domain, &scene.fluid)
}

pub(crate) fn count_in(domain: &Domain, fluid: &Fluid) -> u64 {
    let estimate = estimate(fluid);
    if estimate > MAX_PARTICLES {
        return estimate;
    }
    Sampler::all(domain, fluid).iter().map(|sampler| sampler.counts().0).sum()
}

/// Particles from the blocks' volumes, overlaps counted twice.
pub(crate) fn estimate(fluid: &Fluid) -> u64 {
    let spacing = f64::from(fluid.particle_spacing);
    // `as` saturates, and makes a NaN 0.
    fluid.blocks.iter().map(|block| lattice::estimate(&block.shape, spacing)).sum::<f64>() as u64
}

/// A spacing at which `count` particles become no more than allowed, rounded up to two digits.
pub(crate) fn fitting_spacing(spacing: f32, count: u64) -> f32 {
    let exact = f64::from(spacing) * (count as f64 / MAX_PARTICLES as f64).cbrt();
    let unit = 10f64.powf(exact.log10().floor() - 1.0);
    ((exact / unit * 1.001).ceil() * unit) as f32
}

/// Takes out the particles that lie inside bodies or nearer to one than `clearance` (m); how many. Ids count from 0 again.
pub(crate) fn remove_inside(particles: &mut Particles, bodies: &[LoadedBody], clearance: f32) -> u32 {
    let poses: Vec<_> = bodies.iter().map(LoadedBody::pose).collect();
    let free = |x: Vec3| {
        bodies.iter().zip(&poses).all(|(body, (position, rotation))| {
            body.solid.field.distance(rotation.conjugate() * (x - position)) >= clearance
        })
    };
    let kept: Vec<usize> = (0..particles.positions.len())
        .into_par_iter()
        .filter(|&i| free(particles.positions[i].into()))
        .collect();
    let removed = (particles.positions.len() - kept.len()) as u32;
    if removed > 0 {
        particles.positions = kept.iter().map(|&i| particles.positions[i]).collect();
        particles.velocities = kept.iter().map(|&i| particles.velocities[i]).collect();
        particles.ids = (0..kept.len() as u32).collect();
    }
    removed
}
