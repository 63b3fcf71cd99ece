//! Converts a triangle mesh into a solid: a distance field, mass properties and surface samples.
//!
//! *How it works.* The mesh is repaired first; [`RepairReport`] lists the changes. The distance to the
//! nearest triangle is then computed on the nodes of a grid with a bounding volume hierarchy. The sign comes
//! from the generalised winding number (Jacobson et al. 2013), which tolerates holes, duplicate faces and
//! open seams. A mesh whose holes are too large becomes a shell: a sheet with a thickness; open fins of a solid
//! become sheets, too (`openness`). Finally each node
//! gets the effective wall distance, which describes the fraction of the kernel that the solid fills
//! ([`DistanceField`]). For a solid that does not move, closed sides and other solids limit this fraction to its share of
//! their union ([`Surroundings`]). The result is cached on disk under a hash of its inputs.
//!
//! *Why not* use the mesh itself in the simulation: a lookup in a grid costs the same for twelve triangles
//! and for a million.

mod bvh;
mod cache;
mod field;
mod mass;
mod openness;
mod repair;
mod sample;
pub(crate) mod spline;
mod surroundings;
mod widths;

pub(crate) use bvh::Bvh;
pub use bvh::ray_distance;
pub use cache::default_cache_folder;
pub use field::DistanceField;
pub use mass::MassProperties;
pub use repair::{RepairReport, repair};
pub use surroundings::{Placed, Surroundings};
pub(crate) use widths::{Triangles, widths};

use std::path::PathBuf;

use glam::{Quat, Vec3};
use splashdown_io::Mesh;

use crate::boundary::PlaneFraction;

/// Parameters for building a solid.
#[derive(Clone, Debug)]
pub struct SolidSettings {
    /// Distance between the grid's nodes in m.
    pub cell_size: f32,
    /// The fluid's support radius in m.
    pub support_radius: f32,
    /// The part of the kernel that a plane fills.
    pub fraction: PlaneFraction,
    /// Half the thickness of a shell in m.
    pub half_thickness: f32,
    /// Whether the mesh is a shell; `None` decides by the size of its holes.
    pub shell: Option<bool>,
    /// The corners of the box, in the mesh's frame, in which distances are needed; `None`: around the whole mesh.
    pub region: Option<(Vec3, Vec3)>,
    /// The folder in which solids are cached; `None` disables the cache.
    pub cache: Option<PathBuf>,
}

/// How a mesh is interpreted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidKind {
    /// The mesh encloses a volume.
    Volume,
    /// The mesh is a sheet with a thickness.
    Shell,
}

/// Why a solid could not be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolidError {
    /// The mesh has no usable triangle.
    #[error(
        "the mesh has no triangle with an area (of {given} triangles in the file): export it again, as triangles"
    )]
    Empty {
        /// Number of triangles given.
        given: usize,
    },
    /// A vertex is NaN or infinite.
    #[error("vertex {index} is {vertex:?}: all coordinates must be finite; export the mesh again")]
    NotFinite {
        /// Index of the first such vertex.
        index: usize,
        /// Its coordinates.
        vertex: [f32; 3],
    },
    /// A triangle refers to a vertex that does not exist.
    #[error(
        "triangle {triangle} refers to a vertex that does not exist (there are {vertices}): the file is damaged"
    )]
    BadTriangle {
        /// Index of the first such triangle.
        triangle: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// A dynamic body encloses no volume.
    #[error(
        "it encloses no volume and therefore has no mass: close the mesh, give it a half_thickness and shell = true, or make its \
         motion static or scripted"
    )]
    NoVolume,
    /// It is so small that its volume is rounding error.
    #[error(
        "it is {extent} m long, which is too small for this particle_spacing: check scale, or refine particle_spacing"
    )]
    TooSmall {
        /// Its longest edge in m.
        extent: f32,
    },
    /// The grid of the distance field would be too large.
    #[error(
        "its distance field would have {nodes} nodes, {cell_size} m apart: it is too large for this particle_spacing; check scale"
    )]
    TooLarge {
        /// Number of nodes.
        nodes: u64,
        /// Their distance in m.
        cell_size: f32,
    },
}

/// Maximum number of nodes of a grid.
const MAX_NODES: u64 = 1 << 26;

/// A solid in the frame of its mesh.
#[derive(Clone, Debug)]
pub struct Solid {
    /// The repaired mesh, in m.
    pub mesh: Mesh,
    /// Whether it is a volume or a shell.
    pub kind: SolidKind,
    /// Problems found in the mesh and repairs.
    pub report: RepairReport,
    /// Volume, centre and inertia.
    pub mass: MassProperties,
    /// Signed distances and effective wall distances.
    pub field: DistanceField,
}

impl Solid {
    /// Builds a solid from a mesh in m, or loads it from the cache. `progress` is called with increments that
    /// add up to 1.
    ///
    /// # Errors
    /// [`SolidError`] if the mesh cannot be used.
    pub fn build(
        mesh: &Mesh,
        settings: &SolidSettings,
        progress: &(dyn Fn(f32) + Sync),
    ) -> Result<Self, SolidError> {
        Self::build_within(mesh, settings, None, progress)
    }

    /// As [`build`](Self::build), for a solid that does not move: its effective distances describe its share of the union
    /// of all solids and their images behind closed sides.
    ///
    /// # Errors
    /// [`SolidError`] if the mesh cannot be used.
    pub fn build_within(
        mesh: &Mesh,
        settings: &SolidSettings,
        surroundings: Option<&Surroundings<'_>>,
        progress: &(dyn Fn(f32) + Sync),
    ) -> Result<Self, SolidError> {
        #[cfg(test)]
        crate::work::count("solid built");
        check(mesh)?;
        let path = settings.cache.as_deref().map(|folder| cache::file(folder, mesh, settings, surroundings));
        let cached = path.as_deref().and_then(cache::load);
        let found = cached.is_some();
        let (mesh, report, field) = match cached {
            Some(cached) => cached,
            None => make(mesh, settings, surroundings, progress)?,
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

    /// Checks that the solid has a volume and an invertible inertia, as a dynamic body needs.
    ///
    /// # Errors
    /// [`SolidError::NoVolume`] and [`SolidError::TooSmall`] if it does not.
    pub fn require_volume(&self) -> Result<(), SolidError> {
        // Below a thousandth of a cell the volume is rounding error.
        let least = 1e-3 * self.field.cell_size.powi(3);
        let volume = self.mass.volume;
        let (low, high) = bounds(&self.mesh);
        let extent = (high - low).max_element();
        if volume > least && self.mass.inverse_inertia().is_finite() {
            Ok(())
        } else if volume > 0.0 && self.report.boundary_edges == 0 && extent < 4.0 * self.field.cell_size {
            Err(SolidError::TooSmall { extent })
        } else {
            Err(SolidError::NoVolume)
        }
    }

    /// Whether a point of the mesh's frame (m) is inside.
    pub fn contains(&self, x: Vec3) -> bool {
        self.field.distance(x) < 0.0
    }

    /// Points distributed over the surface, about `spacing` apart and `depth` below it, in m (Akinci et al.
    /// 2012).
    pub fn sample_surface(&self, spacing: f32, depth: f32) -> Vec<Vec3> {
        sample::surface(&self.mesh, &self.field, spacing, depth)
    }

    /// The points of the lattice through `origin` that lie at least `clearance` (m) inside the solid at
    /// `position` with `rotation`, in world coordinates, x fastest.
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
    surroundings: Option<&Surroundings<'_>>,
    progress: &(dyn Fn(f32) + Sync),
) -> Result<(Mesh, RepairReport, DistanceField), SolidError> {
    let given = mesh.triangles.len();
    let (mesh, report) = repair(mesh, settings.shell);
    if mesh.triangles.is_empty() {
        return Err(SolidError::Empty { given });
    }
    let mut bounds = within(bounds(&mesh), settings.region);
    let cells = (bounds.1 - bounds.0 + 2.0 * settings.support_radius) / settings.cell_size + 5.0;
    let nodes = cells.as_dvec3().element_product() as u64;
    if nodes > MAX_NODES {
        return Err(SolidError::TooLarge { nodes, cell_size: settings.cell_size });
    }
    let corners = |triangles: &[[u32; 3]]| -> Vec<[Vec3; 3]> {
        triangles.iter().map(|t| t.map(|v| Vec3::from(mesh.vertices[v as usize]))).collect()
    };
    let (walls, fins) = mesh.triangles.split_at(mesh.triangles.len() - report.sheet_triangles as usize);
    if !fins.is_empty() {
        bounds = (bounds.0 - settings.half_thickness, bounds.1 + settings.half_thickness);
    }
    let bvh = Bvh::new(corners(walls));
    let half = report.shell.then_some(settings.half_thickness);
    let mut field =
        DistanceField::new(&bvh, bounds, settings.cell_size, settings.support_radius, half, progress);
    if !fins.is_empty() {
        field.add_sheets(&Bvh::new(corners(fins)), settings.half_thickness);
    }
    field.fill_effective(settings.support_radius, settings.fraction, surroundings, progress);
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

/// Lower and upper corners of a mesh's bounding box, in m.
pub(crate) fn bounds(mesh: &Mesh) -> (Vec3, Vec3) {
    mesh.vertices.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &v| {
        (low.min(Vec3::from(v)), high.max(Vec3::from(v)))
    })
}

/// The part of a box in a region; a box outside of the region becomes its nearest side.
pub(crate) fn within((low, high): (Vec3, Vec3), region: Option<(Vec3, Vec3)>) -> (Vec3, Vec3) {
    match region {
        Some((min, max)) => (low.clamp(min, max), high.clamp(min, max)),
        None => (low, high),
    }
}
