//! Attributes of particles, interpolated to the vertices of their surface.

use std::path::Path;

use splashdown::surface::{SurfaceError, SurfaceParams, interpolate};
use splashdown_io::{Attribute, Format, Mesh, Particles};

use crate::exit::{Exit, Failure};

/// The name that selects all attributes.
const ALL: &str = "all";

/// Checks that the format of a mesh supports attributes before anything is computed.
///
/// # Errors
/// [`Exit::Usage`]; the message lists the formats with attributes.
pub fn check_format(wanted: &[String], out: &Path) -> Result<(), Failure> {
    if wanted.is_empty() || Format::of(out).is_some_and(Format::has_attributes) {
        return Ok(());
    }
    let message = format!(
        "--attribute: the format of `{}` has no attributes; use one of {}",
        out.display(),
        Format::endings(Format::has_attributes).join(", ")
    );
    Err(Failure::new(Exit::Usage, message))
}

/// The selected attributes of a file, each once. `all` excludes ids, whose interpolation is meaningless, and
/// velocities, which are always interpolated.
///
/// # Errors
/// [`Exit::Usage`] for an unknown name; the message lists the attributes of the file.
pub fn selected<'a>(
    particles: &'a Particles,
    wanted: &[String],
    file: &Path,
) -> Result<Vec<&'a Attribute>, Failure> {
    let all = &particles.attributes;
    for name in wanted.iter().filter(|name| *name != ALL) {
        if !all.iter().any(|attribute| attribute.name == *name) {
            let names: Vec<&str> = all.iter().map(|attribute| attribute.name.as_str()).collect();
            let existing = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            let message = format!(
                "--attribute: `{}` has no attribute `{name}` with one or three numbers per particle; it has {existing}",
                file.display()
            );
            return Err(Failure::new(Exit::Usage, message));
        }
    }
    let everything = wanted.iter().any(|name| name == ALL);
    let is_selected = |attribute: &&Attribute| {
        !attribute.is_velocity() && (everything && !attribute.is_id() || wanted.contains(&attribute.name))
    };
    Ok(all.iter().filter(is_selected).collect())
}

/// Interpolates the attributes to the vertices and adds them to the mesh.
///
/// # Errors
/// Those of [`interpolate`].
pub fn add_interpolated(
    surface: &mut Mesh,
    attributes: &[&Attribute],
    positions: &[[f32; 3]],
    params: &SurfaceParams,
) -> Result<(), SurfaceError> {
    for attribute in attributes {
        let (values, vertices) = (&attribute.values, &surface.vertices);
        let values = match attribute.components {
            3 => interpolate(vertices, positions, values.as_chunks::<3>().0, params)?.into_flattened(),
            _ => interpolate(vertices, positions, values.as_chunks::<1>().0, params)?.into_flattened(),
        };
        let (name, components) = (attribute.name.clone(), attribute.components);
        surface.attributes.push(Attribute { name, components, values });
    }
    Ok(())
}
