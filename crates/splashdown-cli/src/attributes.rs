//! What the particles carry, for the vertices of their surface: which of it is wanted, and its means.

use std::path::Path;

use splashdown::surface::{SurfaceError, SurfaceParams, interpolate};
use splashdown_io::{Attribute, Mesh, Particles, mesh};

use crate::exit::{Exit, Failure};

/// The word for all of them.
const ALL: &str = "all";

/// Tells before anything is computed that a mesh cannot hold what is wanted.
///
/// # Errors
/// [`Exit::Usage`], with the formats that can.
pub fn check_format(wanted: &[String], out: &Path, ending: &str) -> Result<(), Failure> {
    if wanted.is_empty() || mesh::WITH_ATTRIBUTES.contains(&ending) {
        return Ok(());
    }
    let message = format!(
        "--attribute: `{}` cannot hold attributes; {} files can",
        out.display(),
        mesh::WITH_ATTRIBUTES.join(" and ")
    );
    Err(Failure::new(Exit::Usage, message))
}

/// The attributes of a file that are wanted, each once. `all` leaves out ids, whose means say nothing, and
/// velocities, which vertices have anyway.
///
/// # Errors
/// [`Exit::Usage`] names what the file has instead.
pub fn chosen<'a>(
    particles: &'a Particles,
    wanted: &[String],
    file: &Path,
) -> Result<Vec<&'a Attribute>, Failure> {
    let all = &particles.attributes;
    for name in wanted.iter().filter(|name| *name != ALL) {
        if !all.iter().any(|attribute| attribute.name == *name) {
            let names: Vec<&str> = all.iter().map(|attribute| attribute.name.as_str()).collect();
            let there = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            let message = format!(
                "--attribute: `{}` has no attribute `{name}` of one number or three for each particle; it has {there}",
                file.display()
            );
            return Err(Failure::new(Exit::Usage, message));
        }
    }
    let everything = wanted.iter().any(|name| name == ALL);
    let is_chosen = |attribute: &&Attribute| {
        !attribute.is_velocity() && (everything && !attribute.is_id() || wanted.contains(&attribute.name))
    };
    Ok(all.iter().filter(is_chosen).collect())
}

/// Puts their means at the vertices into a mesh.
///
/// # Errors
/// Those of [`interpolate`].
pub fn put(
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
