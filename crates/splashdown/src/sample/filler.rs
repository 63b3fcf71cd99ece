//! Places the particles of a scene's blocks, meshes and files, and leaves out those that overlap earlier
//! ones.

use glam::Vec3;
use splashdown_io::{Mesh, Particles};

use super::grid::PointGrid;
use super::sources::{bounds, positions_in_scene, velocities_in_scene};
use super::{MAX_PARTICLES, SampleError, fitting_spacing};
use crate::bodies::solid_of;
use crate::scene::lattice::{self, Sampler};
use crate::scene::{Domain, Fluid, FluidFile, FluidMesh};
use crate::solid::Solid;

/// Smallest distance, in spacings, between a new particle and one of an earlier block, mesh or file. Nearer
/// particles are left out.
const MIN_DISTANCE: f32 = 0.6;
/// Tolerance, in spacings, for a mesh that reaches out of the domain. It covers the rounding of positions.
const SLACK: f32 = 0.02;

/// The numbers of particles of one source that were added and left out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Added {
    /// Particles that were added.
    pub created: u64,
    /// Particles left out because they overlap an earlier source.
    pub overlapping: u64,
    /// Particles left out because they lie outside the domain.
    pub outside: u64,
}

/// Collects the initial particles of a scene, source by source.
#[derive(Debug)]
pub(crate) struct Filler<'a> {
    domain: &'a Domain,
    spacing: f32,
    positions: Vec<[f32; 3]>,
    velocities: Vec<[f32; 3]>,
    grid: PointGrid,
}

impl<'a> Filler<'a> {
    /// An empty filler; `spacing` in m.
    pub fn new(domain: &'a Domain, spacing: f32) -> Self {
        Self { domain, spacing, positions: Vec::new(), velocities: Vec::new(), grid: PointGrid::new(spacing) }
    }

    /// Adds the blocks of a fluid. Call it before [`mesh`](Self::mesh) and [`file`](Self::file): blocks are
    /// not compared with particles that exist already.
    ///
    /// # Errors
    /// [`SampleError`] if there are too many particles, or if one lies outside the domain.
    pub fn blocks(&mut self, fluid: &Fluid) -> Result<(), SampleError> {
        #[cfg(test)]
        crate::work::count("fluid sampled");
        let estimate = lattice::estimate(fluid);
        self.check_count(estimate)?;
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
                if !is_inside(domain, position) && outside.is_none() {
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
            self.grid.insert(&self.positions);
        }
        Ok(())
    }

    /// Fills a closed mesh with particles. `mesh` is the mesh as read; `what` names it in messages.
    ///
    /// # Errors
    /// [`SampleError`] if the mesh cannot be filled, reaches outside the domain, or gives no particles or too
    /// many.
    pub fn mesh(&mut self, what: &str, filled: &FluidMesh, mesh: &Mesh) -> Result<Added, SampleError> {
        let source = &filled.mesh;
        let solid = solid_of(what, source, mesh, self.domain, self.spacing, filled.shell)?;
        let place = |v: &[f32; 3]| source.position + source.rotation * Vec3::from(*v);
        let (low, high) = bounds(solid.mesh.vertices.iter().map(place));
        let slack = SLACK * self.spacing;
        if low.cmplt(self.domain.min - slack).any() || high.cmpgt(self.domain.max + slack).any() {
            return Err(self.outside(what, "reaches outside the domain", (low, high)));
        }
        // The volume counts overlapping parts of a mesh twice, so this is an estimate. `add` checks the exact
        // number.
        let expected = f64::from(solid.mass.volume) / f64::from(self.spacing).powi(3);
        self.check_count(expected as u64)?;
        let points = self.lattice(&solid, filled, low, high);
        if points.is_empty() {
            return Err(SampleError::TooSmall { what: what.to_owned(), spacing: self.spacing });
        }
        let velocity = filled.velocity.to_array();
        self.add(points.into_iter().map(|x| (x, velocity)))
    }

    /// The lattice points inside a solid. The lattice is that of the solid's bounding box, so that a mesh
    /// which touches a wall, or whose size is a multiple of the spacing, is sampled like a block.
    fn lattice(&self, solid: &Solid, filled: &FluidMesh, low: Vec3, high: Vec3) -> Vec<[f32; 3]> {
        let axes = lattice::axes(self.domain, f64::from(self.spacing), low, high);
        let origin = Vec3::from(axes.map(|(first, _)| first as f32));
        let source = &filled.mesh;
        let mut points = solid.fill(source.position, source.rotation, self.spacing, origin, 0.0);
        let (min, max) = lattice::particle_bounds(self.domain, f64::from(self.spacing));
        points.retain(|x| (0..3).all(|a| f64::from(x[a]) >= min[a] && f64::from(x[a]) <= max[a]));
        points
    }

    /// Adds the particles of a file. Also returns the positions of all of the file's particles in the scene.
    ///
    /// # Errors
    /// [`SampleError`] if there are too many particles, or if most of them lie outside the domain.
    pub fn file(
        &mut self,
        what: &str,
        file: &FluidFile,
        read: &Particles,
    ) -> Result<(Added, Vec<[f32; 3]>), SampleError> {
        let velocities = velocities_in_scene(read, file);
        let positions = positions_in_scene(read, file);
        let added = self.add(positions.iter().copied().zip(velocities))?;
        if 2 * added.outside > positions.len() as u64 {
            let bounds = bounds(positions.iter().map(|x| Vec3::from(*x)));
            return Err(self.outside(what, "lies mostly outside the domain", bounds));
        }
        Ok((added, positions))
    }

    fn add(
        &mut self,
        particles: impl ExactSizeIterator<Item = ([f32; 3], [f32; 3])>,
    ) -> Result<Added, SampleError> {
        self.check_count(particles.len() as u64)?;
        let before = self.positions.len();
        let mut added = Added::default();
        for (x, v) in particles {
            if !is_inside(self.domain, x) {
                added.outside += 1;
            } else if self.grid.any_within(x.into(), MIN_DISTANCE * self.spacing) {
                added.overlapping += 1;
            } else {
                self.positions.push(x);
                self.velocities.push(v);
            }
        }
        added.created = (self.positions.len() - before) as u64;
        self.grid.insert(&self.positions[before..]);
        Ok(added)
    }

    fn check_count(&self, more: u64) -> Result<(), SampleError> {
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

    /// The collected particles, with ids from 0.
    pub fn finish(self) -> Particles {
        let ids = (0..self.positions.len() as u32).collect();
        Particles::from_positions(self.positions).with_ids(ids).with_velocities(self.velocities)
    }
}

fn is_inside(domain: &Domain, x: [f32; 3]) -> bool {
    (0..3).all(|a| x[a] >= domain.min[a] && x[a] <= domain.max[a])
}
