//! Checks the meshes and particle files of a scene, and the objects that depend on them.

use glam::Vec3;
use splashdown_io::{Mesh, Particles};

use super::placed::Placed;
use super::{Built, flow, motion, obstacles};
use crate::bodies::{check_scale, mesh_of, owner};
use crate::flow::LoadedFlow;
use crate::sample::{
    self, Added, Filler, SampleError, Sources, file_title, fitted_spacing, mesh_title, typical_spacing,
};
use crate::scene::{Domain, MeshSource, Motion, Reach, Reported, Scene, Section, grouped, place, rounded};
use crate::solid;

/// Largest relative difference between a file's spacing and the scene's that gives no warning: measured inside the
/// fluid, and estimated from the distances of neighbours.
const SPACING_TOLERANCE: [f32; 2] = [0.02, 0.2];
/// Number of poses of a scripted body that are tested against the domain.
const POSES: u32 = 200;

/// Reads all meshes and particle files of a scene and reports each problem with its line. The scene keeps the
/// results for the simulation.
pub(super) fn check(scene: &Scene, root: &Section<'_>) -> Result<(), Reported> {
    let sections = root.sections_if_any("body")?;
    let (bodies, meshes, placed) = check_bodies(scene, &sections);
    if bodies.is_ok() {
        obstacles::warn_of_overlaps(scene, &placed, &sections);
    }
    obstacles::warn_of_gauges(scene, &placed, &root.sections_if_any("probe")?);
    let mut loaded = LoadedFlow::default();
    let emitters = flow::check_emitters(scene, &mut loaded, &root.sections_if_any("emitter")?, &placed);
    let sinks = flow::check_sinks(scene, &mut loaded, &root.sections_if_any("sink")?);
    let fluid = check_fluid(scene, &root.section("fluid")?);
    bodies.and(emitters).and(sinks)?;
    flow::warn_of_conflicts(scene, &loaded, &root.sections_if_any("emitter")?);
    let fluid = fluid?;
    let particles = fluid.as_ref().map(|(particles, _)| particles);
    flow::warn_of_drained_fluid(scene, &loaded, particles, &root.sections_if_any("sink")?);
    Built::of(scene).store(meshes, loaded, fluid);
    Ok(())
}

fn check_bodies<'a>(
    scene: &'a Scene,
    sections: &[Section<'_>],
) -> (Result<(), Reported>, Vec<Mesh>, Vec<Placed<'a>>) {
    let mut result = Ok(());
    let (mut meshes, mut placed) = (Vec::new(), Vec::new());
    for (body, section) in scene.bodies.iter().zip(sections) {
        match read_scaled(section, &owner("body", &body.name, &body.mesh), &body.mesh, &scene.domain) {
            Ok(mesh) => {
                if let Some(half) = body.half_thickness {
                    let (low, high) = solid::bounds(&mesh);
                    let most = 0.5 * (high - low).max_element();
                    if half > most {
                        let message = format!(
                            "half_thickness = {half} m is more than half the length of body {:?}, which is {} m long",
                            body.name,
                            2.0 * most
                        );
                        let allowed = format!("at most {most} m");
                        result = Err(section.complain(
                            "half_thickness",
                            message,
                            &allowed,
                            "half a spacing is the default",
                        ));
                    }
                }
                let body = Placed::new(body, &mesh);
                warn_outside(scene, &body, &mesh, section);
                let reach = mesh.vertices.iter().map(|v| Vec3::from(*v).length()).fold(0.0, f32::max);
                if let Err(reported) = motion::check(scene, body.body, (body.low, body.high), reach, section)
                {
                    result = Err(reported);
                }
                placed.push(body);
                meshes.push(mesh);
            }
            Err(reported) => result = Err(reported),
        }
    }
    (result, meshes, placed)
}

/// Reads a mesh and checks that its size is plausible.
fn read_scaled(
    section: &Section<'_>,
    owner: &str,
    source: &MeshSource,
    domain: &Domain,
) -> Result<Mesh, Reported> {
    let mesh = mesh_of(owner, source).map_err(|error| {
        section.complain("mesh", error.to_string(), "", "export it again, or name another file")
    })?;
    check_scale(owner, source, &mesh, domain)
        .map_err(|error| section.complain("scale", error.to_string(), "", ""))?;
    Ok(mesh)
}

fn warn_outside(scene: &Scene, placed: &Placed<'_>, mesh: &Mesh, section: &Section<'_>) {
    let domain = &scene.domain;
    let apart = |low: Vec3, high: Vec3| low.cmpgt(domain.max).any() || high.cmplt(domain.min).any();
    let body = placed.body;
    let outside = match &body.motion {
        Motion::Scripted(script) => {
            let reach = mesh.vertices.iter().map(|v| Vec3::from(*v).length()).fold(0.0, f32::max);
            (0..=POSES).all(|k| {
                let time = f64::from(scene.duration) * f64::from(k) / f64::from(POSES);
                let at = script.pose(time).position;
                apart(at - reach, at + reach)
            })
        }
        _ => apart(placed.low, placed.high),
    };
    if outside {
        let spans =
            format!("it spans {} to {} m", place(placed.low.to_array()), place(placed.high.to_array()));
        let message = format!("body {:?} lies entirely outside the domain: {spans}", body.name);
        let hint = format!("the domain is {} to {} m: check position and scale", domain.min, domain.max);
        section.warn("position", message, &hint);
    }
}

/// Creates the particles as the simulation does, and warns of particles that are left out. `None` if the
/// fluid has blocks only.
fn check_fluid(scene: &Scene, section: &Section<'_>) -> Result<Option<(Particles, Vec<Reach>)>, Reported> {
    let fluid = &scene.fluid;
    if sample::has_blocks_only(fluid) {
        return Ok(None);
    }
    let refuse = |section: &Section<'_>, key: &str, error: &SampleError| {
        section.complain(key, error.to_string(), "", "")
    };
    let mut filler = Filler::new(&scene.domain, fluid.particle_spacing);
    filler.blocks(fluid).map_err(|error| refuse(section, "block", &error))?;
    let mut result = Ok(());
    let sources = Sources::read(fluid);
    let reaches = sources.reaches(fluid);
    let meshes = fluid.meshes.iter().zip(sources.meshes);
    for (index, ((mesh, read), section)) in meshes.zip(section.sections_if_any("mesh")?).enumerate() {
        let title = mesh_title(index, mesh);
        match read.and_then(|read| filler.mesh(&title, mesh, &read)) {
            Ok(added) => warn_overlap(&section, &title, added),
            Err(error) => result = Err(refuse(&section, "mesh", &error)),
        }
    }
    let files = fluid.files.iter().zip(sources.files);
    for (index, ((file, read), section)) in files.zip(section.sections_if_any("file")?).enumerate() {
        let title = file_title(index, file);
        match read.and_then(|read| filler.file(&title, file, &read)) {
            Ok((added, positions)) => {
                warn_overlap(&section, &title, added);
                warn_outside_particles(&section, &title, added, scene);
                warn_spacing(&section, &title, &positions, fluid.particle_spacing);
            }
            Err(error) => result = Err(refuse(&section, "file", &error)),
        }
    }
    result.map(|()| Some((filler.finish(), reaches)))
}

fn warn_overlap(section: &Section<'_>, title: &str, added: Added) {
    if added.overlapping > 0 {
        let message = format!(
            "{title} overlaps blocks, meshes or files before it: {} of its {} particles are left out",
            grouped(added.overlapping),
            grouped(added.created + added.overlapping + added.outside)
        );
        section.warn("position", message, "only the particles of the earlier section are created there");
    }
}

fn warn_outside_particles(section: &Section<'_>, title: &str, added: Added, scene: &Scene) {
    if added.outside > 0 {
        let message = format!(
            "{} of the {} particles of {title} lie outside the domain and are left out",
            grouped(added.outside),
            grouped(added.created + added.overlapping + added.outside)
        );
        let (min, max) = (scene.domain.min, scene.domain.max);
        let hint = format!("the domain is {min} to {max} m: check position and scale, or enlarge it");
        section.warn("position", message, &hint);
    }
}

fn warn_spacing(section: &Section<'_>, title: &str, positions: &[[f32; 3]], spacing: f32) {
    let typical = typical_spacing(positions);
    // On a lattice the distance of neighbours is exact.
    let on_lattice =
        |fitted: f32| typical.filter(|typical| (*typical / fitted - 1.0).abs() < SPACING_TOLERANCE[0]);
    let fitted = fitted_spacing(positions).map(|fitted| on_lattice(fitted).unwrap_or(fitted));
    let Some(found) = fitted.or(typical) else { return };
    if (found / spacing - 1.0).abs() <= SPACING_TOLERANCE[usize::from(fitted.is_none())] {
        return;
    }
    let mut message = format!(
        "the particles of {title} are about {} m apart, but fluid.particle_spacing is {spacing} m",
        rounded(found)
    );
    if fitted.is_some() {
        let change = (spacing / found).powi(3) - 1.0;
        let how = if change > 0.0 { "grows" } else { "shrinks" };
        message += &format!(": at rest their volume {how} by {:.0} %", 100.0 * change.abs());
    }
    let hint = if found > 0.0 {
        format!(
            "use fluid.particle_spacing = {}, or multiply the file's scale by {}",
            rounded(found),
            rounded(spacing / found)
        )
    } else {
        "most of them are at the same place as others: write the file again".to_owned()
    };
    section.warn("file", message, &hint);
}
