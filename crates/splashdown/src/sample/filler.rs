//! Puts a scene's sources of fluid together, each beside those before it.

use glam::Vec3;
use splashdown_io::{Mesh, Particles};

use super::near::Near;
use super::sources::{bounds, placed, turned_velocities};
use super::{MAX_PARTICLES, SampleError, fitting_spacing};
use crate::bodies::solid_of;
use crate::scene::lattice::{self, Sampler};
use crate::scene::{Domain, Fluid, FluidFile, FluidMesh};
use crate::solid::Solid;

/// A particle this near to one of an earlier mesh, file or block, in spacings, is left out.
const CROWDED: f32 = 0.6;
/// How far a mesh may reach out of the domain, in spacings: for the rounding of positions.
const SLACK: f32 = 0.02;

/// What became of one source.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Taken {
    /// Particles that were added.
    pub made: u64,
    /// Particles left out because they overlap an earlier source.
    pub crowded: u64,
    /// Left out because they lie outside the domain.
    pub outside: u64,
}

/// Particles in the making.
#[derive(Debug)]
pub(crate) struct Filler<'a> {
    domain: &'a Domain,
    spacing: f32,
    positions: Vec<[f32; 3]>,
    velocities: Vec<[f32; 3]>,
    near: Near,
}

impl<'a> Filler<'a> {
    /// None yet.
    pub fn new(domain: &'a Domain, spacing: f32) -> Self {
        Self { domain, spacing, positions: Vec::new(), velocities: Vec::new(), near: Near::new(spacing) }
    }

    /// The blocks of a fluid, which must come first.
    ///
    /// # Errors
    /// [`SampleError`] if there are too many particles, or some outside the domain.
    pub fn blocks(&mut self, fluid: &Fluid) -> Result<(), SampleError> {
        #[cfg(test)]
        crate::work::count("fluid sampled");
        let estimate = lattice::estimate(fluid);
        self.room_for(estimate)?;
        self.positions.reserve(estimate as usize);
        self.velocities.reserve(estimate as usize);
        let domain = self.domain;
        let mut outside = None;
        for (block, sampler) in Sampler::all(domain, fluid).iter().enumerate() {
            let velocity = fluid.blocks[block].velocity.to_array();
            sampler.for_each(|position, free| {
                if !free {
                    return;
                }
                let position = position.map(|x| x as f32);
                if !holds(domain, position) && outside.is_none() {
                    outside = Some((block, position));
                }
                self.positions.push(position);
                self.velocities.push(velocity);
            });
        }
        if let Some((block, position)) = outside {
            let (min, max) = (domain.min.to_array(), domain.max.to_array());
            return Err(SampleError::Outside { block, position, min, max });
        }
        if !fluid.meshes.is_empty() || !fluid.files.is_empty() {
            self.near.insert(&self.positions);
        }
        Ok(())
    }

    /// Fills a closed mesh as it was read; `what` names it in messages.
    ///
    /// # Errors
    /// [`SampleError`] of the mesh, its place and its number of particles.
    pub fn mesh(&mut self, what: &str, filled: &FluidMesh, mesh: &Mesh) -> Result<Taken, SampleError> {
        let source = &filled.mesh;
        let solid = solid_of(what, source, mesh, self.domain, self.spacing)?;
        let place = |v: &[f32; 3]| source.position + source.rotation * Vec3::from(*v);
        let (low, high) = bounds(solid.mesh.vertices.iter().map(place));
        let slack = SLACK * self.spacing;
        if low.cmplt(self.domain.min - slack).any() || high.cmpgt(self.domain.max + slack).any() {
            return Err(self.outside(what, "reaches outside the domain", (low, high)));
        }
        // A mesh of many windings may count parts of its volume twice; what it really makes is counted below.
        let expected = f64::from(solid.mass.volume) / f64::from(self.spacing).powi(3);
        self.room_for(expected as u64)?;
        let points = self.lattice(&solid, filled, low, high);
        if points.is_empty() {
            return Err(SampleError::TooSmall { what: what.to_owned(), spacing: self.spacing });
        }
        let velocity = filled.velocity.to_array();
        self.add(points.into_iter().map(|x| (x, velocity)))
    }

    /// Points of the lattice inside a solid: that of a box round it, so that what is flush with walls, or has
    /// whole spacings as its size, comes out as a block does.
    fn lattice(&self, solid: &Solid, filled: &FluidMesh, low: Vec3, high: Vec3) -> Vec<[f32; 3]> {
        let box_round = lattice::axes(self.domain, f64::from(self.spacing), low, high);
        let origin = Vec3::from(box_round.map(|(first, _)| first as f32));
        let source = &filled.mesh;
        let mut points = solid.fill(source.position, source.rotation, self.spacing, origin, 0.0);
        let room = lattice::room(self.domain, f64::from(self.spacing));
        let in_room =
            |x: &[f32; 3]| (0..3).all(|a| f64::from(x[a]) >= room.0[a] && f64::from(x[a]) <= room.1[a]);
        points.retain(in_room);
        points
    }

    /// Takes in the particles of a file at their positions; returns these positions, too.
    ///
    /// # Errors
    /// [`SampleError`] of the number of particles, or if most of them lie outside the domain.
    pub fn file(
        &mut self,
        what: &str,
        file: &FluidFile,
        read: &Particles,
    ) -> Result<(Taken, Vec<[f32; 3]>), SampleError> {
        let velocities = turned_velocities(read, file);
        let positions = placed(read, file);
        let taken = self.add(positions.iter().copied().zip(velocities))?;
        if 2 * taken.outside > positions.len() as u64 {
            let bounds = bounds(positions.iter().map(|x| Vec3::from(*x)));
            return Err(self.outside(what, "lies mostly outside the domain", bounds));
        }
        Ok((taken, positions))
    }

    fn add(
        &mut self,
        particles: impl ExactSizeIterator<Item = ([f32; 3], [f32; 3])>,
    ) -> Result<Taken, SampleError> {
        self.room_for(particles.len() as u64)?;
        let before = self.positions.len();
        let mut taken = Taken::default();
        for (x, v) in particles {
            if !holds(self.domain, x) {
                taken.outside += 1;
            } else if self.near.crowded(x.into(), CROWDED * self.spacing) {
                taken.crowded += 1;
            } else {
                self.positions.push(x);
                self.velocities.push(v);
            }
        }
        taken.made = (self.positions.len() - before) as u64;
        self.near.insert(&self.positions[before..]);
        Ok(taken)
    }

    fn room_for(&self, more: u64) -> Result<(), SampleError> {
        let count = (self.positions.len() as u64).saturating_add(more);
        if count <= MAX_PARTICLES {
            return Ok(());
        }
        let spacing = self.spacing;
        Err(SampleError::TooMany { count, spacing, fitting: fitting_spacing(spacing, count, MAX_PARTICLES) })
    }

    fn outside(&self, what: &str, how: &'static str, (low, high): (Vec3, Vec3)) -> SampleError {
        let (what, [low, high]) = (what.to_owned(), [low, high].map(|x| x.to_array()));
        let (min, max) = (self.domain.min.to_array(), self.domain.max.to_array());
        SampleError::Beyond { what, how, low, high, min, max }
    }

    /// Everything that was put in, numbered from 0.
    pub fn finish(self) -> Particles {
        let ids = (0..self.positions.len() as u32).collect();
        Particles::from_positions(self.positions).with_ids(ids).with_velocities(self.velocities)
    }
}

fn holds(domain: &Domain, x: [f32; 3]) -> bool {
    (0..3).all(|a| x[a] >= domain.min[a] && x[a] <= domain.max[a])
}
