//! `splashdown surface`: closed surface meshes from particle files.

mod spacing;

use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::Serialize;
use splashdown::surface::{
    SurfaceError, SurfaceParams, droplets_of, interpolate, isolated, reconstruct_with,
};
use splashdown_gpu::Executor;
use splashdown_io::{
    Format, IoError, Mesh, Particles, Topology, gltf, prepare_folder, read_particles,
    read_particles_with_attributes, write_mesh, write_particles,
};
use splashdown_run::sequence::{self, Step};

use crate::args::{SurfaceArguments, is_mesh_file};
use crate::exit::{Exit, Failure};
use crate::{attributes, console, human, memory};

/// One mesh, as `--json` prints it.
#[derive(Debug, Serialize)]
struct Line<'a> {
    input: &'a Path,
    output: &'a Path,
    particles: usize,
    /// In the unit of the files.
    particle_spacing: f32,
    vertices: usize,
    triangles: usize,
    pieces: usize,
    /// Isolated particles, which are not part of the mesh.
    droplets: usize,
    /// In the unit of the files, cubed.
    volume: f64,
    closed: bool,
    manifold: bool,
    oriented: bool,
    velocities: bool,
    attributes: Vec<String>,
    /// Time of the reconstruction, without reading and writing files.
    surface_seconds: f64,
    /// Total time, including reading and writing.
    seconds: f64,
    /// Resident bytes of this process before reading, and its peak so far, if the system reports them.
    start_memory: Option<u64>,
    peak_memory: Option<u64>,
}

/// The position of a file in the series, and the memory of the process before the first.
#[derive(Clone, Copy, Debug)]
struct Place {
    number: usize,
    all: usize,
    start_memory: Option<u64>,
}

/// Reconstructs the meshes.
pub fn run(arguments: &SurfaceArguments) -> Result<(), Failure> {
    let start_memory = memory::resident();
    let inputs = sequence::expand(&arguments.particles, &Format::endings(Format::reads_particles))?;
    let steps = sequence::steps(inputs, &arguments.out)?;
    let droplet_files = droplet_files(arguments, &steps)?;
    for Step { output, .. } in &steps {
        mesh_format(output, &arguments.out)?;
        attributes::check_format(&arguments.attribute, output)?;
    }
    let first = spacing::first(arguments, &steps)?;
    parameters(arguments, first)?;
    for output in [Some(&steps[0].output), droplet_files.first()].into_iter().flatten() {
        if let Some(folder) = output.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            prepare_folder(folder)?;
        }
    }
    let mut executor = arguments.device.device.executor()?;
    let (mut failures, mut last) = (Vec::new(), None);
    for (number, step) in steps.iter().enumerate() {
        let place = Place { number: number + 1, all: steps.len(), start_memory };
        let droplet_file = droplet_files.get(number).map(PathBuf::as_path);
        let topology = match one((step, droplet_file), arguments, &mut executor, place, first) {
            // The remaining files of a series are still processed.
            Err(failure) if steps.len() > 1 && matches!(failure.exit, Exit::Usage | Exit::Scene) => {
                failures.push(failure.message);
                continue;
            }
            result => result?,
        };
        if !topology.is_watertight() {
            failures.push(format!("`{}` is {topology}", step.output.display()));
        }
        last = Some(topology);
    }
    conclude(arguments, &steps, last, &failures)
}

/// The parameters for particles of this spacing.
///
/// # Errors
/// [`Exit::Usage`] for a parameter that is out of range.
fn parameters(arguments: &SurfaceArguments, particle_spacing: f32) -> Result<SurfaceParams, Failure> {
    let mut params = SurfaceParams::new(particle_spacing);
    params.support_radius = arguments.support_radius.unwrap_or(params.support_radius);
    params.cell_size = arguments.cell_size.unwrap_or(params.cell_size);
    params.kernels = arguments.kernels;
    params.iso_level = arguments.iso_level;
    params.smoothing_iterations = arguments.smoothing;
    params.check().map_err(|error| Failure::new(Exit::Usage, error.to_string()))?;
    Ok(params)
}

/// Reads one file and writes its mesh; returns the mesh's topology. A file without particles, as those of a run before its
/// emitters begin, gives an empty mesh, with the spacing `first` of the series.
fn one(
    (step, droplet_file): (&Step, Option<&Path>),
    arguments: &SurfaceArguments,
    executor: &mut Executor,
    Place { number, all, start_memory }: Place,
    first: f32,
) -> Result<Topology, Failure> {
    let begun = Instant::now();
    let Step { input, output } = step;
    let particles = read(input, arguments)?.unwrap_or_default();
    let is_empty = particles.is_empty();
    let spacing = if is_empty { first } else { spacing::of(arguments, &particles, input)? };
    let params = &parameters(arguments, spacing)?;
    let selected = match is_empty {
        true => Vec::new(),
        false => attributes::selected(&particles, &arguments.attribute, input)?,
    };
    let read = Instant::now();
    let (mut surface, droplets) = match is_empty {
        true => Default::default(),
        false => separated(&particles.positions, params, arguments, executor)
            .map_err(|error| input_failure(error, input))?,
    };
    let surface_seconds = read.elapsed().as_secs_f64();
    if let Some(path) = droplet_file {
        write_droplets(path, &droplets_of(&particles, &droplets, params.particle_spacing))?;
    }
    if !particles.velocities.is_empty() && Format::of(output).is_some_and(Format::has_velocities) {
        let Particles { positions, velocities, .. } = &particles;
        surface.velocities = interpolate(&surface.vertices, positions, velocities, params)?;
    }
    attributes::add_interpolated(&mut surface, &selected, &particles.positions, params)?;
    let topology = surface.topology()?;
    write_mesh(output, &surface)?;
    let line = Line {
        input,
        output,
        particles: particles.len(),
        particle_spacing: params.particle_spacing,
        vertices: surface.vertices.len(),
        triangles: surface.len(),
        pieces: topology.components,
        droplets: droplets.len(),
        volume: surface.volume(),
        closed: topology.is_closed(),
        manifold: topology.is_manifold(),
        oriented: topology.is_oriented(),
        velocities: !surface.velocities.is_empty(),
        attributes: surface.attributes.iter().map(|attribute| attribute.name.clone()).collect(),
        surface_seconds,
        seconds: begun.elapsed().as_secs_f64(),
        start_memory,
        peak_memory: memory::peak(),
    };
    if arguments.json {
        console::print_json(&line);
    }
    if !arguments.quiet {
        console::note(format!("[{number}/{all}] {}", describe(&line, &surface)));
    }
    Ok(topology)
}

/// The mesh without isolated particles, and the indices of these.
fn separated(
    positions: &[[f32; 3]],
    params: &SurfaceParams,
    arguments: &SurfaceArguments,
    executor: &mut Executor,
) -> Result<(Mesh, Vec<u32>), SurfaceError> {
    let mut limits = *params;
    (limits.min_blob, limits.min_neighbours) = (arguments.min_blob, arguments.min_neighbours);
    let droplets = isolated(positions, &limits)?;
    let (mesh, _) = if droplets.is_empty() {
        reconstruct_with(positions, params, executor)?
    } else {
        let mut apart = droplets.iter().copied().peekable();
        let kept = (0..).zip(positions).filter(|(i, _)| apart.next_if_eq(i).is_none());
        let kept: Vec<[f32; 3]> = kept.map(|(_, &x)| x).collect();
        reconstruct_with(&kept, params, executor)?
    };
    Ok((mesh, droplets))
}

/// The files of the isolated particles, if they are to be written.
///
/// # Errors
/// [`Exit::Usage`] for a name without a format of points; as [`sequence::steps`].
fn droplet_files(arguments: &SurfaceArguments, steps: &[Step]) -> Result<Vec<PathBuf>, Failure> {
    let Some(given) = &arguments.droplets else { return Ok(Vec::new()) };
    if !Format::of(given).is_some_and(is_point_file) {
        let error = IoError::UnknownFormat { path: given.clone(), allowed: Format::endings(is_point_file) };
        return Err(Failure::new(Exit::Usage, error.to_string()));
    }
    let inputs = steps.iter().map(|step| step.input.clone()).collect();
    let files: Vec<PathBuf> = sequence::steps(inputs, given)?.into_iter().map(|step| step.output).collect();
    if let Some(file) = files.iter().find(|file| steps.iter().any(|step| step.output == **file)) {
        let message = format!(
            "`{}` would be the mesh and the droplets: give another name for --droplets",
            file.display()
        );
        return Err(Failure::new(Exit::Usage, message));
    }
    Ok(files)
}

/// Formats of points with one file per frame.
fn is_point_file(format: &Format) -> bool {
    format.ending == ".glb" || (format.writes_particles() && !format.is_series())
}

fn write_droplets(path: &Path, droplets: &Particles) -> Result<(), IoError> {
    match Format::of(path) {
        Some(format) if format.ending == ".glb" => gltf::write_points(path, droplets)?,
        _ => write_particles(path, droplets)?,
    };
    Ok(())
}

/// One line for people.
fn describe(line: &Line<'_>, surface: &Mesh) -> String {
    let (particles, triangles) =
        (human::counted(line.particles as u64, "particle"), human::count(surface.len() as u64));
    let left_out = match line.droplets {
        0 => String::new(),
        count => format!(", {} left out", human::counted(count as u64, "isolated particle")),
    };
    let velocities = line.velocities.then_some("velocities");
    let attributes: Vec<&str> =
        velocities.into_iter().chain(line.attributes.iter().map(String::as_str)).collect();
    let attributes =
        if attributes.is_empty() { String::new() } else { format!(", with {}", attributes.join(", ")) };
    format!(
        "{}: {particles} -> {}: {triangles} triangles{attributes}, volume {}{left_out} ({})",
        line.input.display(),
        line.output.display(),
        human::three_digits(line.volume),
        human::duration(line.seconds),
    )
}

/// Prints a summary of all meshes.
///
/// # Errors
/// [`Exit::Failed`] if any of them is not watertight.
fn conclude(
    arguments: &SurfaceArguments,
    steps: &[Step],
    last: Option<Topology>,
    failures: &[String],
) -> Result<(), Failure> {
    if !failures.is_empty() {
        let message = format!("{} of {} meshes failed: {}", failures.len(), steps.len(), failures.join("; "));
        return Err(Failure::new(Exit::Failed, message));
    }
    if !arguments.quiet && !arguments.json {
        match (steps, last) {
            ([step], Some(topology)) => console::print(format!("{}: {topology}", step.output.display())),
            _ => console::print(format!(
                "{} meshes, {} to {}: all are watertight (closed, manifold, oriented)",
                steps.len(),
                steps[0].output.display(),
                steps[steps.len() - 1].output.display()
            )),
        }
    }
    Ok(())
}

/// Reads a particle file; `None` if it contains no particles. An unreadable input file has a different exit code from an
/// unwritable output file.
fn read(path: &Path, arguments: &SurfaceArguments) -> Result<Option<Particles>, Failure> {
    let particles = match arguments.attribute[..] {
        [] => read_particles(path),
        _ => read_particles_with_attributes(path),
    };
    match particles {
        Err(IoError::NoParticles { .. }) => Ok(None),
        result => result.map(Some).map_err(|error| Failure::new(Exit::Scene, error.to_string())),
    }
}

/// Adds the name of the input file to an error, and chooses the exit code by whether the arguments or the file cause
/// it.
fn input_failure(error: SurfaceError, input: &Path) -> Failure {
    let exit = match &error {
        SurfaceError::NoSurface { .. } | SurfaceError::Parameter { .. } => Exit::Usage,
        SurfaceError::TooLarge { .. } | SurfaceError::TooFar { .. } | SurfaceError::GridTooFine { .. } => {
            Exit::Scene
        }
        _ => return error.into(),
    };
    Failure::new(exit, format!("`{}`: {error}", input.display()))
}

/// Checks that the name of a mesh has a known format before anything is computed.
fn mesh_format(output: &Path, given: &Path) -> Result<(), Failure> {
    if Format::of(output).is_some_and(is_mesh_file) {
        return Ok(());
    }
    let error = IoError::UnknownFormat { path: given.to_owned(), allowed: Format::endings(is_mesh_file) };
    Err(Failure::new(Exit::Usage, error.to_string()))
}
