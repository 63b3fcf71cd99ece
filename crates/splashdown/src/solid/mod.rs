//! From a triangle mesh as it is found to a solid that a fluid can meet.
//!
//! *How it works.* The mesh is mended ([`RepairReport`] says how). On a grid round it the distance to the
//! nearest triangle is found with a tree of boxes; inside and outside are told apart by the generalised winding
//! number (Jacobson et al. 2013), which does not mind holes, doubled faces or torn seams. A mesh that is too
//! open for an inside becomes a shell: a sheet with a thickness. Then every node learns the share of the kernel
//! that the solid fills round it ([`DistanceField`]). The result is kept on disk under the hash of what it was
//! made from.
//!
//! *Why not* the mesh itself in the simulation: a look-up in a grid costs the same for twelve triangles and for
//! a million.

mod bvh;
mod cache;
mod field;
mod mass;
mod repair;
mod sample;

pub use cache::default_cache_folder;
pub use field::DistanceField;
pub use mass::MassProperties;
pub use repair::{RepairReport, repair};

use std::path::PathBuf;

use glam::{Quat, Vec3};
use splashdown_io::Mesh;

use crate::boundary::KernelPair;
use bvh::Bvh;

/// How a solid is made.
#[derive(Clone, Debug)]
pub struct SolidSettings {
    /// Distance of the grid's nodes in m.
    pub cell_size: f32,
    /// The fluid's support radius in m.
    pub support_radius: f32,
    /// The fluid's kernels.
    pub kernels: KernelPair,
    /// Half the thickness in m of a shell.
    pub half_thickness: f32,
    /// Whether it is a shell; `None`: decided by the mesh.
    pub shell: Option<bool>,
    /// Where solids are kept; `None`: nowhere.
    pub cache: Option<PathBuf>,
}

/// What a mesh is taken for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidKind {
    /// It has an inside.
    Volume,
    /// It is a sheet with a thickness.
    Shell,
}

/// Why no solid could be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolidError {
    /// There is nothing.
    #[error("the mesh has no triangle with an area ({given} were given): export it again, as triangles")]
    Empty {
        /// Triangles given.
        given: usize,
    },
    /// A vertex is NaN or infinite.
    #[error("vertex {index} is {vertex:?}: all coordinates must be finite; export the mesh again")]
    NotFinite {
        /// The first such vertex, from 0.
        index: usize,
        /// What it is.
        vertex: [f32; 3],
    },
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} names a vertex beyond the {vertices} there are: the file is damaged")]
    BadTriangle {
        /// The first such triangle, from 0.
        triangle: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// A dynamic body without a volume.
    #[error(
        "it encloses no volume, so it has no mass to move: close the mesh, give it a half_thickness and shell = true, or make its \
         motion static or scripted"
    )]
    NoVolume,
    /// The grid would be absurd.
    #[error(
        "its grid would have {nodes} nodes of {cell_size} m: it is too large for this particle_spacing; check scale"
    )]
    TooLarge {
        /// How many nodes.
        nodes: u64,
        /// Their distance in m.
        cell_size: f32,
    },
}

/// Most nodes of a grid.
const MAX_NODES: u64 = 1 << 26;

/// A solid in the frame of its mesh.
#[derive(Clone, Debug)]
pub struct Solid {
    /// The mended triangles, in m.
    pub mesh: Mesh,
    /// Solid or sheet.
    pub kind: SolidKind,
    /// What was found in the mesh and done.
    pub report: RepairReport,
    /// Volume, centre and inertia.
    pub mass: MassProperties,
    /// Distances and shares.
    pub field: DistanceField,
}

impl Solid {
    /// Makes a solid of a mesh in m, or finds it on disk. `progress` hears how much more is done, in parts that
    /// add up to 1.
    ///
    /// # Errors
    /// [`SolidError`] of a mesh that cannot be used.
    pub fn build(
        mesh: &Mesh,
        settings: &SolidSettings,
        progress: &(dyn Fn(f32) + Sync),
    ) -> Result<Self, SolidError> {
        #[cfg(test)]
        crate::work::count("solid built");
        check(mesh)?;
        let path = settings.cache.as_deref().map(|folder| cache::file(folder, mesh, settings));
        let known = path.as_deref().and_then(cache::load);
        let found = known.is_some();
        let (mesh, report, field) = match known {
            Some(known) => known,
            None => make(mesh, settings, progress)?,
        };
        if let (Some(path), false) = (&path, found) {
            cache::save(path, &mesh, report, &field);
        }
        let kind = if report.shell { SolidKind::Shell } else { SolidKind::Volume };
        let half = report.shell.then_some(settings.half_thickness);
        let closed = report.boundary_edges == 0 && report.non_manifold_edges == 0;
        let mass = mass::properties(&mesh, closed, &field, half);
        Ok(Self { mesh, kind, report, mass, field })
    }

    /// Refuses what a dynamic body cannot be.
    ///
    /// # Errors
    /// [`SolidError::NoVolume`].
    pub fn require_volume(&self) -> Result<(), SolidError> {
        // A thousandth of a particle weighs nothing.
        let least = 1e-3 * self.field.cell_size.powi(3);
        let finite = self.mass.inertia.inverse().is_finite();
        if self.mass.volume > least && finite { Ok(()) } else { Err(SolidError::NoVolume) }
    }

    /// Whether a point of the mesh's frame (m) is inside.
    pub fn contains(&self, x: Vec3) -> bool {
        self.field.distance(x) < 0.0
    }

    /// Points scattered over the surface, about `spacing` from each other and `depth` inside, in m (Akinci et
    /// al. 2012).
    pub fn sample_surface(&self, spacing: f32, depth: f32) -> Vec<Vec3> {
        sample::surface(&self.mesh, &self.field, spacing, depth)
    }

    /// The points `origin` + whole spacings that lie at least `clearance` (m) inside the solid at `position`
    /// with `rotation`, in the world, x fastest.
    pub fn fill(
        &self,
        position: Vec3,
        rotation: Quat,
        spacing: f32,
        origin: Vec3,
        clearance: f32,
    ) -> Vec<[f32; 3]> {
        sample::fill(&self.field, bounds(&self.mesh), (position, rotation), spacing, origin, clearance)
    }
}

fn make(
    mesh: &Mesh,
    settings: &SolidSettings,
    progress: &(dyn Fn(f32) + Sync),
) -> Result<(Mesh, RepairReport, DistanceField), SolidError> {
    let given = mesh.triangles.len();
    let (mesh, report) = repair(mesh, settings.shell);
    if mesh.triangles.is_empty() {
        return Err(SolidError::Empty { given });
    }
    let bounds = bounds(&mesh);
    let cells = (bounds.1 - bounds.0 + 2.0 * settings.support_radius) / settings.cell_size + 5.0;
    let nodes = cells.as_dvec3().element_product() as u64;
    if nodes > MAX_NODES {
        return Err(SolidError::TooLarge { nodes, cell_size: settings.cell_size });
    }
    let triangles = mesh.triangles.iter().map(|t| t.map(|v| Vec3::from(mesh.vertices[v as usize]))).collect();
    let bvh = Bvh::new(triangles);
    let half = report.shell.then_some(settings.half_thickness);
    let mut field =
        DistanceField::new(&bvh, bounds, settings.cell_size, settings.support_radius, half, progress);
    field.fill_effective(settings.support_radius, settings.kernels, progress);
    Ok((mesh, report, field))
}

fn check(mesh: &Mesh) -> Result<(), SolidError> {
    if mesh.triangles.is_empty() {
        return Err(SolidError::Empty { given: 0 });
    }
    if let Some(index) = mesh.vertices.iter().position(|&v| !Vec3::from(v).is_finite()) {
        return Err(SolidError::NotFinite { index, vertex: mesh.vertices[index] });
    }
    let vertices = mesh.vertices.len();
    match mesh.triangles.iter().position(|t| t.iter().any(|&v| v as usize >= vertices)) {
        Some(triangle) => Err(SolidError::BadTriangle { triangle, vertices }),
        None => Ok(()),
    }
}

/// How many times triangles wind round a point: 1 inside a mesh that faces outwards, 0 outside (Jacobson et al. 2013).
pub(crate) fn winding(triangles: &[[Vec3; 3]], x: Vec3) -> f64 {
    let angle: f64 = triangles.iter().map(|t| f64::from(bvh::solid_angle(x, t))).sum();
    angle / (4.0 * std::f64::consts::PI)
}

/// Lower and upper corner of a mesh, in m.
pub(crate) fn bounds(mesh: &Mesh) -> (Vec3, Vec3) {
    mesh.vertices.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &v| {
        (low.min(Vec3::from(v)), high.max(Vec3::from(v)))
    })
}
