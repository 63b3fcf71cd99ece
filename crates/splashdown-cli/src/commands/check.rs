//! `splashdown check`: validates a scene and prints derived quantities.

use serde::Serialize;
use splashdown::check::{BodyWidths, Interpretation, Resolution, interpretations, resolution};
use splashdown::run::ProgressFn;
use splashdown::sample::Inventory;
use splashdown::scene::{DensityMode, Derived, Method, Scene, SceneWarning, Solver};
use splashdown::{Packing, SimulationError, check_particles, memory_forecast_of, neighbour_search_forecast};

use crate::args::CheckArguments;
use crate::console::Verbosity;
use crate::exit::{Exit, Failure};
use crate::forecast::{Forecast, Trial, forecast};
use crate::lines::Line;
use crate::progress::Bar;
use crate::{console, human, scene_file};

/// The JSON output.
#[derive(Debug, Serialize)]
struct Report<'a> {
    event: &'static str,
    valid: bool,
    scene: &'a str,
    particle_spacing: f32,
    duration: f32,
    #[serde(flatten)]
    derived: &'a Derived,
    /// Particles removed because they are inside bodies.
    removed: u64,
    /// The density at the start; absent for a single lattice without bodies.
    #[serde(skip_serializing_if = "Option::is_none")]
    initial_packing: Option<&'a Packing>,
    memory_forecast: u64,
    speed: Speed<'a>,
    /// How the meshes of bodies and fluid are interpreted.
    meshes: &'a [Interpretation],
    /// Lengths of the scene in particle spacings, and the nearest validated cases.
    resolution: &'a Resolution,
    warnings: &'a [SceneWarning],
}

/// The expected wall time on this machine.
#[derive(Debug, Serialize)]
struct Speed<'a> {
    device: &'a str,
    particle_steps_per_second: f64,
    expected_steps: u64,
    expected_seconds: f64,
    /// The trial with a wider spacing; absent if the scene allows none.
    #[serde(skip_serializing_if = "Option::is_none")]
    trial: Option<&'a Trial>,
}

impl<'a> From<&'a Forecast> for Speed<'a> {
    fn from(forecast: &'a Forecast) -> Self {
        Self {
            device: &forecast.device,
            particle_steps_per_second: forecast.rate,
            expected_steps: forecast.steps,
            expected_seconds: forecast.seconds,
            trial: forecast.trial.as_ref(),
        }
    }
}

/// Checks a scene and prints the result.
pub fn run(arguments: &CheckArguments) -> Result<(), Failure> {
    let outcome = execute(arguments);
    if let (Err(failure), true) = (&outcome, arguments.json) {
        console::print_json(&Line::error(failure));
    }
    outcome
}

fn execute(arguments: &CheckArguments) -> Result<(), Failure> {
    let scene = scene_file::load(&arguments.scene)?;
    if !arguments.json {
        // They may say why the scene cannot be prepared.
        scene.warnings.iter().for_each(|warning| console::note(format!("{warning}\n")));
    }
    let bar = Bar::new(Verbosity::Normal, arguments.json);
    let prepared = prepare(&scene, &bar.preparation());
    bar.clear();
    let (inventory, packing) = prepared?;
    let derived = Derived::with_inventory(&scene, &inventory);
    let meshes = interpretations(&scene).map_err(|error| Failure::new(Exit::Scene, error.to_string()))?;
    let resolution = resolution(&scene).map_err(|error| Failure::new(Exit::Scene, error.to_string()))?;
    let memory = memory_forecast_of(&scene, &inventory);
    // A scene too large for the device is still valid: the report is printed before the error.
    let executor = arguments.device.device.executor()?;
    let search = neighbour_search_forecast(
        &scene,
        inventory.particles,
        executor.gpu().map(|gpu| gpu.largest_buffer()),
    );
    let fits = check_particles(inventory.particles, executor.largest_buffer(), &scene);
    drop(executor);
    let forecast = forecast(&scene, &derived, &resolution, &arguments.device.device)?;
    if arguments.json {
        console::print_json(&Report {
            event: "check",
            valid: true,
            scene: &scene.name,
            particle_spacing: scene.fluid.particle_spacing,
            duration: scene.duration,
            derived: &derived,
            removed: inventory.removed,
            initial_packing: packing.as_ref(),
            memory_forecast: memory.saturating_add(search),
            speed: Speed::from(&forecast),
            meshes: &meshes,
            resolution: &resolution,
            warnings: &scene.warnings,
        });
        return Ok(fits?);
    }
    let file = arguments.scene.display();
    console::print(format!(
        "{file}: valid\n{}",
        describe(&scene, &derived, &inventory, [memory, search], &forecast)
    ));
    if let Some(packing) = &packing {
        print_packing(packing);
    }
    print_meshes(&meshes);
    print_resolution(&resolution);
    Ok(fits?)
}

/// The particles of a scene, without those inside bodies as in the simulation, and their packing.
fn prepare(scene: &Scene, progress: &ProgressFn) -> Result<(Inventory, Option<Packing>), SimulationError> {
    let progress = |task: &str, fraction: f32| progress.call(task, fraction);
    Ok((splashdown::inventory(scene, &progress)?, splashdown::initial_packing(scene, &progress)?))
}

/// The memory of the buffers, and of the neighbour search in addition, in bytes.
fn describe_memory(buffers: u64, search: u64) -> String {
    let buffers = format!("about {}", human::bytes(buffers));
    if search == 0 {
        buffers
    } else {
        format!("{buffers}, and {} for the neighbour search", human::bytes(search))
    }
}

fn describe(
    scene: &Scene,
    derived: &Derived,
    inventory: &Inventory,
    [buffers, search]: [u64; 2],
    forecast: &Forecast,
) -> String {
    let fluid = &scene.fluid;
    let size = scene.domain.size();
    let mut rows = vec![
        ("name", scene.name.clone()),
        ("domain", format!("{} x {} x {} m", size.x, size.y, size.z)),
        (
            "material",
            format!(
                "{}, {} kg/m^3, {:.3e} m^2/s",
                fluid.material.name, fluid.material.rest_density, fluid.material.viscosity
            ),
        ),
        ("particles", particles(inventory, fluid.particle_spacing)),
        ("particle mass", format!("{:.4e} kg", derived.particle_mass)),
        ("volume", human::volume(derived.volume.into())),
        ("solver", format!("{}, support radius {} m", scene.solver.method, derived.support_radius)),
        ("suited to", suited_to(&scene.solver).to_owned()),
        (
            "speed",
            format!(
                "about {} m/s expected, more in the jets of impacts",
                human::three_digits(derived.reference_speed.into())
            ),
        ),
        ("sound", format!("{} m/s", human::three_digits(derived.sound_speed.into()))),
        ("time step", format!("about {:.3e} s, limited by {}", derived.dt_estimate, derived.dt_limit)),
        (
            "steps",
            format!(
                "about {} in {}, {} s",
                human::count(forecast.steps),
                human::counted(derived.frames.into(), "frame"),
                scene.duration
            ),
        ),
        ("memory", describe_memory(buffers, search)),
        (
            "expected time",
            format!(
                "about {} on {}, without pictures and files: {}",
                human::duration(forecast.seconds),
                forecast.device,
                basis(forecast),
            ),
        ),
    ];
    let numerical = Derived::capillary_viscosity(scene);
    if numerical > 0.0 {
        rows.insert(
            3,
            (
                "surface tension",
                format!(
                    "{} N/m, contact angle {} degrees, numerical viscosity {numerical:.2e} m^2/s",
                    fluid.material.surface_tension, scene.solver.contact_angle
                ),
            ),
        );
    }
    if scene.solver.method == Method::Dfsph {
        // An implicit pressure has no speed of sound.
        rows.retain(|(name, _)| *name != "sound");
    }
    console::table(&rows)
}

/// What a solver is good for, and the one to choose for other purposes.
fn suited_to(solver: &Solver) -> &'static str {
    match (solver.method, solver.density) {
        (Method::Dfsph, _) => {
            "pictures, films, viscous liquids, large scenes; for pressures at a point, forces, drag, waves and oscillations set \
             accuracy = \"engineering\""
        }
        (Method::Wcsph, DensityMode::Continuity) => {
            "pressures at a point, forces and waves; method = \"dfsph\" takes the least time"
        }
        (Method::Wcsph, DensityMode::Summation) => {
            "comparison; method = \"dfsph\" takes the least time, accuracy = \"engineering\" gives pressures and waves"
        }
        (Method::Mueller2003, _) => {
            "comparison with the thesis of 2012: its pressures mean nothing; method = \"dfsph\" is the usual choice"
        }
    }
}

/// What the expected time is based on.
fn basis(forecast: &Forecast) -> String {
    match &forecast.trial {
        Some(trial) => format!(
            "from a trial of {:.0} % of the scene with {}",
            (100.0 * trial.part).max(1.0),
            human::counted(trial.particles.into(), "particle")
        ),
        None => "from the expected speed, because the scene allows no trial with fewer particles".to_owned(),
    }
}

/// The density of the particles at the start.
fn print_packing(packing: &Packing) {
    let density = packing.density();
    let [x, y, z] = density.place;
    console::print(format!(
        "  initial density: mean {:.1}, at most {:.1} kg/m^3, at ({x:.3}, {y:.3}, {z:.3}) m",
        density.mean, density.max
    ));
    if packing.after.is_some() {
        console::print(format!("  initial packing: {packing}"));
    } else if !packing.is_sound() {
        console::print(
            "  initial packing: the run relaxes so many particles before its first step; not tried here",
        );
    }
    if packing.after.is_some() && !packing.is_sound() {
        console::note(format!(
            "warning: the fluid starts {:.1} % too dense at one place: {}\n",
            100.0 * density.excess,
            packing.advice()
        ));
    }
}

/// One line per mesh, and one per volume that it closes.
fn print_meshes(meshes: &[Interpretation]) {
    for mesh in meshes {
        console::print(format!("  {}: {}", mesh.owner, mesh.report));
        for closing in &mesh.closed_volumes {
            console::print(format!(
                "    closes the volume at {}, which shrinks from {} to {}",
                closing.side,
                human::volume(closing.volume.into()),
                human::volume(closing.least.into())
            ));
        }
    }
}

/// The scene's lengths in spacings, the nearest validated cases, and what is too coarse.
fn print_resolution(resolution: &Resolution) {
    let thinnest = resolution.fluid.iter().min_by(|a, b| a.spacings.total_cmp(&b.spacings));
    let depth = resolution.depth.map(|depth| format!("fluid {depth:.0} spacings deep"));
    let film = thinnest.map(|piece| format!("{} {:.1} across", piece.owner, piece.spacings));
    let wave =
        resolution.wave.map(|wave| format!("waves {:.0} long, shaken by {:.2}", wave.length, wave.amplitude));
    let bodies = resolution.bodies.iter().map(|BodyWidths { owner, thickness, is_shell, gap, .. }| {
        let or_more = |width: &Option<f32>| width.map_or("over 16".to_owned(), |width| format!("{width:.1}"));
        let thick = if *is_shell { "a shell".to_owned() } else { format!("{} thick", or_more(thickness)) };
        format!("{owner} {thick}, gap {}", or_more(gap))
    });
    let parts: Vec<String> = depth.into_iter().chain(film).chain(wave).chain(bodies).collect();
    if !parts.is_empty() {
        console::print(format!("  resolution, in spacings: {}", parts.join("; ")));
    }
    for case in &resolution.validated {
        let here = case.here.map_or(String::new(), |here| format!(" (here {here:.0})"));
        console::print(format!(
            "  validated: {}, {} {} spacings{here}: {}",
            case.case, case.across, case.spacings, case.error
        ));
    }
    for sentence in resolution.too_coarse() {
        console::note(format!("coarse: {sentence}; use a finer particle_spacing if it matters\n"));
    }
}

fn particles(inventory: &Inventory, spacing: f32) -> String {
    let mut words = format!("{}, {spacing} m apart", human::count(inventory.particles));
    if inventory.emitted > 0 {
        words += &format!("; emitters add at most {}", human::count(inventory.emitted));
    }
    if inventory.removed > 0 {
        let all = (inventory.particles + inventory.removed) as f64;
        words += &format!(
            "; {} inside bodies or in narrow gaps are removed, {:.1} % of the fluid",
            human::count(inventory.removed),
            100.0 * inventory.removed as f64 / all
        );
    }
    words
}
