//! Closed meshes, which must enclose a volume: fluid shapes, outlets and sinks.

use splashdown_io::Mesh;

use super::load::{BodyError, cell_size, check_scale, mesh_of};
use crate::boundary::{KernelPair, PlaneFraction};
use crate::scene::{Domain, MeshSource};
use crate::solid::{self, Solid, SolidKind, SolidSettings};

/// The solid of a mesh in the mesh's frame, with distances but without kernel fractions. `owner` names the purpose
/// of the mesh in messages.
///
/// # Errors
/// [`BodyError`] of the file, the size or the shape; [`BodyError::Open`] if the mesh encloses no volume.
pub(crate) fn closed_solid(
    owner: &str,
    source: &MeshSource,
    domain: &Domain,
    spacing: f32,
) -> Result<Solid, BodyError> {
    solid_of(owner, source, &mesh_of(owner, source)?, domain, spacing, None)
}

/// As [`closed_solid`], for a mesh read by [`mesh_of`]. `shell` is false for a mesh that is a solid in spite of its holes.
///
/// # Errors
/// As [`closed_solid`].
pub(crate) fn solid_of(
    owner: &str,
    source: &MeshSource,
    mesh: &Mesh,
    domain: &Domain,
    spacing: f32,
    shell: Option<bool>,
) -> Result<Solid, BodyError> {
    check_scale(owner, source, mesh, domain)?;
    let settings = SolidSettings {
        cell_size: cell_size(solid::bounds(mesh), spacing, 0.0, 0.0),
        // The solid exerts no force, so its nodes need no kernel fractions.
        support_radius: 0.0,
        fraction: PlaneFraction::of(KernelPair::WendlandC2),
        half_thickness: 0.5 * spacing,
        shell,
        region: None,
        cache: solid::default_cache_folder(),
    };
    let solid_error = |source| BodyError::Solid { owner: owner.into(), source };
    let solid = Solid::build(mesh, &settings, &|_| {}).map_err(solid_error)?;
    if solid.kind == SolidKind::Shell {
        return Err(BodyError::Open { owner: owner.into(), open_edges: solid.report.boundary_edges });
    }
    solid.require_volume().map_err(solid_error)?;
    Ok(solid)
}
