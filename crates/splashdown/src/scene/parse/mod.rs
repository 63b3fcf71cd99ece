//! Reads the text of a scene file into a [`Scene`]. Each section is read separately, so that one mistake does
//! not hide another.

mod camera;
mod flow;
mod fluid;
mod picture;
mod probes;
mod solver;
mod things;
mod view;

use std::path::Path;

use glam::Vec3;
use toml::de::DeTable;

pub(crate) use flow::outlet_outside;

use super::errors::{SceneErrors, SceneProblem};
use super::geometry;
use super::keys::{ROOT, Side};
use super::reader::{Read, Reader, Reported, Section};
use super::slot::BuiltSlot;
use super::source::Source;
use super::types::{Domain, Fluid, InitialPressure, Oscillation, Scene};

/// Maximum number of frames of a run.
const MAX_FRAMES: f64 = 100_000.0;

/// A section's value, or a problem that has already been reported.
type Part<T> = Result<T, Reported>;

/// A check of a scene against its files, its meshes and its particles. It reports problems with their lines.
pub(crate) type Check = fn(&Scene, &Section<'_>) -> Result<(), Reported>;

/// Reads a scene, and calls `check` if all values could be read. File names are relative to `folder`, and the
/// files must exist. Without a folder, file names stay as written.
pub(crate) fn parse(
    text: &str,
    file: &str,
    folder: Option<&Path>,
    check: Check,
) -> Result<Scene, SceneErrors> {
    if text.trim().is_empty() {
        let message = "the scene file is empty";
        return Err(SceneErrors::one(SceneProblem::of_file(
            file,
            message,
            "`splashdown scenes` lists scenes to start from",
        )));
    }
    let reader = Reader::new(Source::new(file, text), folder);
    let (table, mistakes) = DeTable::parse_recoverable(text);
    let scene = report_syntax(&reader, &mistakes)
        .and_then(|()| read(&Section::root(&reader, table.get_ref(), &ROOT), check));
    let (errors, warnings) = reader.finish();
    match scene {
        Ok(scene) if errors.is_empty() => Ok(Scene { warnings, text: text.into(), ..scene }),
        _ => Err(SceneErrors { file: file.to_owned(), errors }),
    }
}

/// Reports syntax errors. The tree of a text with syntax errors is incomplete, so further messages would be misleading.
fn report_syntax(reader: &Reader<'_>, mistakes: &[toml::de::Error]) -> Part<()> {
    for mistake in mistakes {
        let span = mistake.span().unwrap_or(0..0);
        let message = format!("not valid TOML: {}", mistake.message().trim());
        reader.report(reader.source.problem(span, String::new(), message));
    }
    if mistakes.is_empty() { Ok(()) } else { Err(Reported) }
}

fn read(root: &Section<'_>, check: Check) -> Part<Scene> {
    let header = root.section("scene").and_then(|section| read_header(&section));
    let domain_section = root.section("domain");
    let fluid_section = root.section("fluid");
    let solver_section = root.section("solver");
    let domain = domain_section.as_ref().map_err(|r| *r).and_then(read_domain);
    let fluid = fluid_section.as_ref().map_err(|r| *r).and_then(|section| {
        let spacing = section.number("particle_spacing");
        let blocks = section
            .sections_if_any("block")
            .map(|list| list.into_iter().map(|s| (fluid::read_block(&s), s)).collect());
        let meshes = read_all(section, "mesh", fluid::read_fluid_mesh);
        let files = read_all(section, "file", fluid::read_fluid_file);
        let material = fluid::read_material(section);
        let initial_pressure = section.choice("initial_pressure");
        // The geometry is checked even if other values are invalid, so that a wrong viscosity does not hide a
        // block outside the domain.
        let geometry_result =
            geometry::check(&domain_section, domain.as_ref().ok(), section, spacing, &blocks);
        let blocks: Vec<geometry::ReadBlock<'_>> = blocks?;
        let blocks = blocks.into_iter().map(|(block, _)| block).collect::<Part<Vec<_>>>()?;
        let fluid = Fluid {
            particle_spacing: spacing?.ok_or(Reported)?,
            material: material?,
            blocks,
            meshes: meshes?,
            files: files?,
            initial_pressure: initial_pressure?.unwrap_or(InitialPressure::Hydrostatic),
        };
        geometry_result.map(|()| fluid)
    });
    let emitters = all_of(root.sections_if_any("emitter"), |sections| {
        flow::read_emitters(sections, domain.as_ref().ok())
    });
    let sinks = all_of(root.sections_if_any("sink"), flow::read_sinks);
    if let (Ok(section), Ok(fluid), Ok([])) = (&fluid_section, &fluid, emitters.as_deref())
        && fluid.blocks.is_empty()
        && fluid.meshes.is_empty()
        && fluid.files.is_empty()
    {
        let message =
            "there is no fluid: no [[fluid.block]], [[fluid.mesh]], [[fluid.file]] or [[emitter]]".to_owned();
        let hint = "a scene needs at least one, for example [[fluid.block]] with position = [0, 0, 0] and size = [0.2, 0.2, 0.2]";
        section.complain("block", message, "1 to 256 sections", hint);
    }
    let duration = header.as_ref().map(|header| header.duration).ok();
    let bodies = all_of(root.sections_if_any("body"), |sections| things::read_bodies(sections, duration));
    let probes = root.sections_if_any("probe").and_then(|sections| {
        let context = probes::Context { domain: domain.as_ref().ok(), bodies: bodies.as_deref().ok() };
        probes::read_probes(&sections, &context)
    });
    let solver = solver_section.as_ref().map_err(|r| *r).and_then(solver::read_solver);
    let surface =
        root.section("surface").and_then(|section| view::read_surface(&section, fluid.as_ref().ok()));
    let foam = root.section("foam").and_then(|section| view::read_foam(&section));
    let output =
        root.section("output").and_then(|section| view::read_output(&section, surface.as_ref().ok()));
    let picture = root.section("picture").and_then(|section| picture::read_picture(&section));
    let camera = root.section("camera").and_then(|section| {
        let picture = output.as_ref().map_or([16, 9], |output| output.picture_size);
        let duration = header.as_ref().map_or(0.0, |header| header.duration);
        camera::read_camera(&section, domain.as_ref().ok(), picture, duration)
    });
    let header = header?;
    let (camera, camera_path) = camera?;
    let probes = probes::check_intervals(root, probes?, 1.0 / header.frame_rate)?;
    let scene = Scene {
        name: header.name,
        duration: header.duration,
        frame_rate: header.frame_rate,
        gravity: header.gravity,
        domain: domain?,
        fluid: fluid?,
        bodies: bodies?,
        emitters: emitters?,
        sinks: sinks?,
        probes,
        solver: solver?,
        surface: surface?,
        foam: foam?,
        camera,
        camera_path,
        picture: picture?,
        output: output?,
        warnings: Vec::new(),
        source: None,
        text: "".into(),
        built: BuiltSlot::default(),
    };
    check(&scene, root)?;
    Ok(scene)
}

/// The values of all sections of a list, or a problem that has already been reported.
fn all_of<T>(
    sections: Part<Vec<Section<'_>>>,
    read: impl Fn(&[Section<'_>]) -> Vec<Part<T>>,
) -> Part<Vec<T>> {
    read(&sections?).into_iter().collect()
}

/// Reads every section of a list that may be absent.
fn read_all<T>(section: &Section<'_>, name: &str, read: fn(&Section<'_>) -> Part<T>) -> Part<Vec<T>> {
    // All sections are read before the first error is returned, so that all problems are reported.
    let all: Vec<Part<T>> = section.sections_if_any(name)?.iter().map(read).collect();
    all.into_iter().collect()
}

struct Header {
    name: String,
    duration: f32,
    frame_rate: f32,
    gravity: Vec3,
}

fn read_header(section: &Section<'_>) -> Part<Header> {
    let name = section.name("name");
    let duration = section.number("duration");
    let frame_rate = section.number("frame_rate");
    let gravity = section.numbers("gravity");
    let header = Header {
        name: needed(name)?,
        duration: needed(duration)?,
        frame_rate: frame_rate?.unwrap_or(50.0),
        gravity: gravity?.map_or(Vec3::new(0.0, -9.81, 0.0), Vec3::from),
    };
    let frames = f64::from(header.duration) * f64::from(header.frame_rate);
    if frames > MAX_FRAMES {
        let message = format!(
            "{} s at {} frames per second are {frames:.0} frames",
            header.duration, header.frame_rate
        );
        return Err(section.complain(
            "duration",
            message,
            &format!("{MAX_FRAMES} frames"),
            "lower duration or frame_rate",
        ));
    }
    Ok(header)
}

fn read_domain(section: &Section<'_>) -> Part<Domain> {
    let min = section.numbers("min");
    let max = section.numbers("max");
    let open = section.choices::<Side>("open");
    let oscillation = section.section("oscillation").and_then(|oscillation| {
        if oscillation.exists() { read_oscillation(&oscillation).map(Some) } else { Ok(None) }
    });
    let (min, max): (Vec3, Vec3) = (needed(min)?.into(), needed(max)?.into());
    let mut closed = [[true; 2]; 3];
    for (axis, side) in open?.unwrap_or_default().into_iter().map(Side::place) {
        closed[axis][side] = false;
    }
    if let Some(axis) = (0..3).find(|axis| max[*axis] <= min[*axis]) {
        let axis_name = ["x", "y", "z"][axis];
        let message =
            format!("domain.max is not above domain.min along {axis_name}: {} <= {}", max[axis], min[axis]);
        return Err(section.complain(
            "max",
            message,
            &format!("{axis_name} above {}", min[axis]),
            "max is a corner, not a size",
        ));
    }
    Ok(Domain { min, max, closed, oscillation: oscillation? })
}

fn read_oscillation(section: &Section<'_>) -> Part<Oscillation> {
    let amplitude = section.numbers("amplitude");
    let period = section.number("period");
    Ok(Oscillation { amplitude: needed(amplitude)?.into(), period: needed(period)? })
}

/// The value of a key that `what` requires; reports it if it is missing.
fn given<T>(section: &Section<'_>, name: &str, value: Option<T>, what: &str) -> Part<T> {
    value.ok_or_else(|| {
        let message = format!("{} is missing: a {what} needs it", section.key_path(name));
        section.complain(name, message, "", "")
    })
}

/// The value of a required key. Its absence has been reported with the section.
fn needed<T>(value: Read<T>) -> Part<T> {
    value?.ok_or(Reported)
}
