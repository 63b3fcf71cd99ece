//! Warnings about values that are valid but probably unintended.

use std::f32::consts::PI;

use super::Built;
use crate::sample;
use crate::scene::lattice::Sampler;
use crate::scene::{
    DensityMode, Derived, InitialPressure, Method, Outlet, Quantity, Reported, Scene, Section, SinkRegion,
    SurfaceTension, outlet,
};

/// A scene with more steps than this takes days and gives a warning.
const MANY_STEPS: u64 = 10_000_000;
/// Smallest ratio of the speed of sound to the reference speed that gives no warning. At this ratio the
/// density of a weakly compressible fluid varies by about 4 %.
const SLOWEST_SOUND: f32 = 5.0;

/// Warns of values that are valid but probably unintended, and refuses steps that are too long.
pub(super) fn check(scene: &Scene, root: &Section<'_>, derived: &Derived) -> Result<(), Reported> {
    let (fluid, solver) = (&root.section("fluid")?, &root.section("solver")?);
    check_flow(scene, root);
    refuse_long_steps(scene, solver, derived)?;
    check_viscosity(scene, solver, derived);
    check_negative_pressure(scene, solver);
    check_room(scene, root);
    check_support(scene, root);
    check_frames(scene, &root.section("scene")?);
    check_surface_tension(scene, fluid, solver, derived);
    check_steps(scene, solver, derived);
    check_sound(scene, solver, derived);
    check_initial_pressure(scene, fluid);
    check_gauges(scene, solver);
    check_volume(scene, fluid);
    Ok(())
}

/// Refuses steps that are too long for the forces.
fn refuse_long_steps(scene: &Scene, solver: &Section<'_>, derived: &Derived) -> Result<(), Reported> {
    if scene.solver.method == Method::Dfsph {
        let limit = Derived::body_force_dt(scene);
        for (name, given) in [("max_dt", scene.solver.max_dt), ("min_dt", scene.solver.min_dt)] {
            if solver.has(name) && given > limit {
                let message = format!(
                    "solver.{name} = {given} s is longer than the stable time step of this scene, {limit:.3e} s"
                );
                let hint = "body forces move a particle by a small part of a spacing per step: leave the key out, or use a coarser \
                            particle_spacing";
                return Err(solver.complain(name, message, &format!("at most {limit:.3e} s"), hint));
            }
        }
    }
    // An explicit step is never longer than this estimate, whose limits leave out the speeds that occur.
    let is_explicit = scene.solver.method != Method::Dfsph;
    if is_explicit && solver.has("min_dt") && scene.solver.min_dt > derived.dt_estimate {
        let limit = derived.dt_estimate;
        let message = format!(
            "solver.min_dt = {} s is longer than the stable time step of this scene, {limit:.3e} s, which is limited by {}",
            scene.solver.min_dt, derived.dt_limit
        );
        let hint = "leave the key out, or use a coarser particle_spacing or a lower sound_speed";
        return Err(solver.complain("min_dt", message, &format!("at most {limit:.3e} s"), hint));
    }
    Ok(())
}

/// Warns of what surface tension cannot do, and of a contact angle without a wall.
fn check_surface_tension(scene: &Scene, fluid: &Section<'_>, solver: &Section<'_>, derived: &Derived) {
    let is_given = fluid.has("surface_tension") && scene.fluid.material.surface_tension > 0.0;
    if scene.solver.surface_tension == SurfaceTension::None && is_given {
        let message =
            "fluid.surface_tension has no effect: the solver has no model of surface tension".to_owned();
        let hint = match scene.solver.method {
            Method::Mueller2003 => "set solver.surface_tension = \"mueller2003\"",
            _ => "set solver.surface_tension = \"csf\"",
        };
        fluid.warn("surface_tension", message, hint);
    }
    if scene.solver.surface_tension == SurfaceTension::Csf && scene.solver.method == Method::Dfsph {
        let message = "the pressure of dfsph is never negative: with surface_tension = \"csf\" drops hold \
                       together, and water under a trough or in a neck tears"
            .to_owned();
        let hint = "for capillary waves, bridges and thin threads set accuracy = \"engineering\"";
        solver.warn("surface_tension", message, hint);
        check_capillary_length(scene, solver, derived);
    }
    let is_summed = scene.solver.method == Method::Wcsph && scene.solver.density == DensityMode::Summation;
    if scene.solver.surface_tension == SurfaceTension::Csf && is_summed {
        let message = "with the summed density of wcsph, surface_tension = \"csf\" draws particles together in pairs: a drop \
                       becomes about 15 % too dense"
            .to_owned();
        solver.warn("surface_tension", message, "set accuracy = \"engineering\", or method = \"dfsph\"");
    }
    if scene.solver.surface_tension == SurfaceTension::Csf && !scene.bodies.is_empty() {
        let message =
            "with surface_tension = \"csf\" bodies are not wetted: the contact angle is 180 degrees"
                .to_owned();
        let sides = format!("at the closed sides of the domain it is {} degrees", scene.solver.contact_angle);
        solver.warn("surface_tension", message, &sides);
    }
    if solver.has("contact_angle") && !scene.domain.closed.as_flattened().contains(&true) {
        let message = "solver.contact_angle has no effect: all sides of the domain are open".to_owned();
        solver.warn("contact_angle", message, "close a side, or leave it out");
    }
}

/// The height of fluid over its capillary length below which surface tension dominates.
const CAPILLARY_LENGTHS: f32 = 3.0;
/// Below this acceleration in m/s^2 drops are not held by a vessel.
const WEAKEST_GRAVITY: f32 = 0.1;

/// Warns of small vessels, where the surface tension of `dfsph` creates energy.
fn check_capillary_length(scene: &Scene, solver: &Section<'_>, derived: &Derived) {
    let material = &scene.fluid.material;
    let length = (material.surface_tension / (material.rest_density * scene.gravity.length())).sqrt();
    let is_small = derived.head > 0.0 && derived.head < CAPILLARY_LENGTHS * length;
    if is_small && scene.gravity.length() > WEAKEST_GRAVITY {
        let message = format!(
            "the fluid is at most {:.1e} m high, {:.1} capillary lengths: dfsph with surface_tension = \"csf\" creates energy \
             there, and the fluid can boil",
            derived.head,
            derived.head / length
        );
        solver.warn("surface_tension", message, "set accuracy = \"engineering\"");
    }
}

/// Warns of steps that are too short or too many.
fn check_steps(scene: &Scene, solver: &Section<'_>, derived: &Derived) {
    if derived.dt_estimate < scene.solver.min_dt {
        let message = format!(
            "the scene needs a time step of about {:.1e} s, but solver.min_dt is {:.1e} s",
            derived.dt_estimate, scene.solver.min_dt
        );
        let hint = match scene.solver.method {
            Method::Dfsph => "lower solver.min_dt, or use a coarser particle_spacing",
            _ => "lower solver.min_dt, or use a coarser particle_spacing or a lower sound_speed",
        };
        solver.warn("min_dt", message, hint);
    }
    if derived.steps_estimate > MANY_STEPS {
        let message = format!(
            "the scene needs about {} steps of {:.1e} s, limited by {}",
            derived.steps_estimate, derived.dt_estimate, derived.dt_limit
        );
        let hint = match scene.solver.method {
            Method::Dfsph => "use a coarser particle_spacing or a shorter duration",
            _ => {
                "use a coarser particle_spacing, a shorter duration, a lower sound_speed or method = \"dfsph\""
            }
        };
        solver.warn("cfl_factor", message, hint);
    }
}

/// Warns of a speed of sound that is too low.
fn check_sound(scene: &Scene, solver: &Section<'_>, derived: &Derived) {
    if scene.solver.method == Method::Wcsph && derived.sound_speed < SLOWEST_SOUND * derived.reference_speed {
        let ratio = derived.sound_speed / derived.reference_speed;
        let name = if solver.has("stiffness") { "stiffness" } else { "sound_speed" };
        let message = format!(
            "the speed of sound, {:.3} m/s, is only {ratio:.1} times the largest speed to expect, {:.3} m/s",
            derived.sound_speed, derived.reference_speed
        );
        let percent = 100.0 / (ratio * ratio);
        solver.warn(
            name,
            message,
            &format!("the density may vary by about {percent:.0} %; a ratio of ten keeps it within 1 %"),
        );
    }
}

/// Warns of an initial pressure that no fluid has.
fn check_initial_pressure(scene: &Scene, fluid: &Section<'_>) {
    if fluid.has("initial_pressure")
        && scene.fluid.initial_pressure == InitialPressure::Hydrostatic
        && !sample::can_start_at_rest(scene)
    {
        let message = "fluid.initial_pressure has no effect: all fluid starts without pressure".to_owned();
        let hint = "it needs a box at rest on a closed side and gravity along an axis";
        fluid.warn("initial_pressure", message, hint);
    }
}

/// Warns of gauges near bodies whose pressure is wrong.
fn check_gauges(scene: &Scene, solver: &Section<'_>) {
    let gauge = scene.probes.iter().find(|probe| matches!(probe.quantity, Quantity::Pressure(_)));
    if let Some(gauge) = gauge
        && scene.solver.method != Method::Dfsph
        && scene.solver.density == DensityMode::Summation
        && !scene.bodies.is_empty()
    {
        // In an impact it is a fifth of the correct one, because the approach to bodies is damped (docs/validation.md).
        let message = format!(
            "probe {:?} measures pressure, but with density = \"summation\" the pressure near bodies is too low",
            gauge.name
        );
        solver.warn("density", message, "to measure pressure set accuracy = \"engineering\" under [solver], or for impacts on bodies method = \"dfsph\"");
    }
}

/// Warns of blocks whose particles have another volume.
fn check_volume(scene: &Scene, fluid: &Section<'_>) {
    for (index, sampler) in Sampler::all(&scene.domain, &scene.fluid).iter().enumerate() {
        let [x, y, z] = sampler.layers();
        let excess = sampler.volume_ratio().map_or(0.0, |ratio| ratio - 1.0);
        if excess.abs() > INEXACT_VOLUME {
            let message = format!(
                "the {x} x {y} x {z} particles of fluid.block[{index}] have {:.1} % {} volume than the block",
                100.0 * excess.abs(),
                if excess > 0.0 { "more" } else { "less" }
            );
            let hint = "the volume is exact if sizes are multiples of the spacing";
            fluid.warn("particle_spacing", message, hint);
        }
    }
}

/// Warns of a surface that is pulled together.
fn check_negative_pressure(scene: &Scene, solver: &Section<'_>) {
    if scene.solver.pulls_surfaces_together() && !scene.is_full() {
        let message = "with density = \"summation\" negative pressures pull a free surface together: the sum of a particle there \
                       lacks neighbours"
            .to_owned();
        let hint = match scene.solver.method {
            Method::Mueller2003 => "use \"clamp\", unless the fluid fills the domain",
            _ => "use \"clamp\" or density = \"continuity\", unless the fluid fills the domain",
        };
        solver.warn("negative_pressure", message, hint);
    }
}

/// The relative error of the volume of a block above which there is a warning.
const INEXACT_VOLUME: f64 = 0.02;

/// A viscosity that shortens the time step by more than this factor gives a warning with an explicit solver.
const MUCH_SHORTER: f32 = 10.0;

/// Warns of a viscosity that makes an explicit solver take many more steps than an implicit one.
fn check_viscosity(scene: &Scene, solver: &Section<'_>, derived: &Derived) {
    let by_body_force = Derived::body_force_dt(scene).min(scene.solver.max_dt);
    if scene.solver.method != Method::Wcsph
        || derived.dt_limit != "viscosity"
        || derived.dt_estimate * MUCH_SHORTER > by_body_force
    {
        return;
    }
    let message = format!(
        "the viscosity of {} m^2/s limits the time step to {:.1e} s",
        scene.fluid.material.viscosity, derived.dt_estimate
    );
    solver.warn("method", message, "method = \"dfsph\" integrates the viscosity implicitly, in longer steps");
}

/// A run that is longer than its scene by more than this part gives a warning.
const LONGER: f32 = 0.05;

/// Warns of frames that do not fit into the duration.
fn check_frames(scene: &Scene, section: &Section<'_>) {
    let simulated = scene.frame_count() as f32 * scene.frame_duration();
    if simulated > (1.0 + LONGER) * scene.duration {
        let message = format!(
            "the run simulates {simulated} s instead of {} s: {} whole frames of {} s",
            scene.duration,
            scene.frame_count(),
            scene.frame_duration()
        );
        section.warn(
            "frame_rate",
            message,
            "raise frame_rate, or set duration to a multiple of 1 / frame_rate",
        );
    }
}

/// Warns of fluid that gravity takes out of the domain: all sides to which it points are open.
fn check_support(scene: &Scene, root: &Section<'_>) {
    let side_of = |axis: usize| usize::from(scene.gravity[axis] > 0.0);
    let mut below = (0..3).filter(|&axis| scene.gravity[axis] != 0.0).peekable();
    let is_held = below.peek().is_none() || !scene.bodies.is_empty() || !scene.emitters.is_empty();
    if is_held || below.any(|axis| scene.domain.closed[axis][side_of(axis)]) {
        return;
    }
    let axis = scene.gravity.abs().max_position();
    let [x, y, z] = scene.gravity.to_array();
    let side = format!("{}_{}", ["x", "y", "z"][axis], ["min", "max"][side_of(axis)]);
    let message = format!(
        "gravity [{x}, {y}, {z}] points at the open side {side}, and no closed side or body is below the fluid"
    );
    root.warn("domain", message, &format!("close {side}, or check the sign of scene.gravity"));
}

/// Warns of emitters that overfill a closed domain.
fn check_room(scene: &Scene, root: &Section<'_>) {
    if !scene.is_closed() || !scene.sinks.is_empty() {
        return;
    }
    let particle = f64::from(scene.fluid.particle_spacing).powi(3);
    let [initial, room] = scene.filling();
    // Without a folder no file is opened.
    let opens_files = scene.emitters.iter().any(|emitter| matches!(emitter.outlet, Outlet::Mesh(_)));
    let is_known = root.has_folder() || !opens_files;
    let emitted = if is_known { Built::of(scene).emitted(scene).unwrap_or_default().0 as f64 } else { 0.0 };
    if emitted > 0.0 && initial + emitted > room {
        let message = format!(
            "the emitters add {:.3e} m^3 to a closed domain in which {:.3e} m^3 are free",
            emitted * particle,
            (room - initial).max(0.0) * particle
        );
        root.warn("emitter", message, "open a side, add a sink, or set end or max_particles");
    }
}

/// Warns of emitters, sinks and probes that have no effect or an inexact one.
fn check_flow(scene: &Scene, root: &Section<'_>) {
    let spacing = scene.fluid.particle_spacing;
    for emitter in &scene.emitters {
        let name = &emitter.name;
        let (area, layer) = match &emitter.outlet {
            Outlet::Disc { radius } => (PI * radius * radius, outlet::disc_layer(*radius, spacing)),
            Outlet::Rectangle { size } => (size[0] * size[1], outlet::rectangle_layer(*size, spacing)),
            Outlet::Mesh(_) => continue,
        };
        let share = layer.share_of(area, spacing);
        if (share - 1.0).abs() > 0.01 {
            let message = format!(
                "the outlet of emitter {name:?} is too narrow for the spacing: its {} particles per layer emit {:.3e} m^3/s instead of {:.3e}",
                layer.points.len(),
                share * area * emitter.speed,
                area * emitter.speed
            );
            root.warn("emitter", message, "use a finer particle_spacing, or an outlet of several spacings");
        }
        let per_step = scene.solver.cfl_factor * spacing;
        if scene.solver.method == Method::Dfsph && per_step > layer.interval {
            let message = format!(
                "emitter {name:?} adds at most one layer per step: with a cfl_factor of {} a step may be longer than the time \
                 between layers, so that it emits too little",
                scene.solver.cfl_factor
            );
            let hint = format!("use a cfl_factor of at most {:.2}", layer.interval / spacing - 0.005);
            root.warn("emitter", message, &hint);
        }
        if emitter.start >= scene.duration {
            let message = format!(
                "emitter {name:?} starts at {} s, after the scene ends at {} s",
                emitter.start, scene.duration
            );
            root.warn("emitter", message, "start earlier, or make the scene longer");
        }
    }
    for sink in &scene.sinks {
        if let SinkRegion::Box { min, max } = sink.region
            && (min.cmpgt(scene.domain.max).any() || max.cmplt(scene.domain.min).any())
        {
            let message = format!("sink {:?} lies entirely outside the domain", sink.name);
            root.warn("sink", message, "it removes no particles: check min and max");
        }
    }
    for probe in &scene.probes {
        if probe.interval.is_some_and(|interval| interval > scene.duration) {
            let message =
                format!("the interval of probe {:?} is longer than the scene: it writes no rows", probe.name);
            root.warn("probe", message, "make interval shorter than duration");
        }
    }
}
