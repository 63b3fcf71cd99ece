//! Legal, but probably not what was meant.

use std::f32::consts::PI;

use crate::scene::{
    DensityMode, Derived, Method, Outlet, Quantity, Reported, Scene, Section, Shape, SinkRegion, outlet,
};

/// More steps than this take days.
const MANY_STEPS: u64 = 10_000_000;
/// Below this many times the reference speed a weakly compressible fluid visibly loses volume (4 per cent).
const SLOWEST_SOUND: f32 = 5.0;

/// Notes values of a whole scene that are legal but probably not meant.
pub(super) fn check(scene: &Scene, root: &Section<'_>, derived: &Derived) -> Result<(), Reported> {
    let (fluid, solver) = (&root.section("fluid")?, &root.section("solver")?);
    check_flow(scene, root);
    if derived.dt_estimate < scene.solver.min_dt {
        let message = format!(
            "the scene needs a time step of about {:.1e} s, but solver.min_dt is {:.1e} s",
            derived.dt_estimate, scene.solver.min_dt
        );
        solver.warn(
            "min_dt",
            message,
            "lower solver.min_dt, or use a coarser particle_spacing or a lower sound_speed",
        );
    }
    if derived.steps_estimate > MANY_STEPS {
        let message = format!(
            "the scene needs about {} steps of {:.1e} s, limited by {}",
            derived.steps_estimate, derived.dt_estimate, derived.dt_limit
        );
        solver.warn(
            "cfl_factor",
            message,
            "use a coarser particle_spacing, a shorter duration or a lower sound_speed",
        );
    }
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
            &format!("the density may vary by about {percent:.0} %; ten times keeps it within 1 %"),
        );
    }
    let gauge = scene.probes.iter().find(|probe| matches!(probe.quantity, Quantity::Pressure(_)));
    if let Some(gauge) = gauge
        && scene.solver.density == DensityMode::Summation
    {
        // A tenth too low at a floor at rest, and a fifth of an impact's (docs/validation.md): the walls'
        // damping does the rest.
        let message = format!(
            "probe {:?} measures a pressure, but where densities are summed the pressure beside walls is too low",
            gauge.name
        );
        solver.warn("density", message, "write density = \"continuity\" under [solver] to measure pressures");
    }
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let width = scene.domain.size()[axis];
        // Rounding of a domain that is just two supports wide is no fault.
        if scene.domain.closed[axis] == [true; 2] && width < 1.999 * derived.support_radius {
            let message = format!(
                "the domain is {width} m wide along {name}, less than two support radii of {} m: \
                 particles feel only the nearer of two closed sides",
                derived.support_radius
            );
            fluid.warn("particle_spacing", message, "use a finer particle_spacing, or open one of the sides");
        }
    }
    let spacing = f64::from(scene.fluid.particle_spacing);
    for (index, block) in scene.fluid.blocks.iter().enumerate() {
        let Shape::Box { size, .. } = block.shape else { continue };
        let lengths = size.to_array().map(|length| f64::from(length) / spacing);
        let off = |length: &f64| (length - length.round()).abs() > 0.1;
        if let Some(axis) = lengths.iter().position(|length| off(length) && *length < 50.0) {
            let message = format!(
                "fluid.block[{index}] is {:.2} spacings long along {}: its {} layers of particles hold {:.1} % {} water",
                lengths[axis],
                ["x", "y", "z"][axis],
                lengths[axis].round(),
                (lengths[axis].round() / lengths[axis] - 1.0).abs() * 100.0,
                if lengths[axis].round() > lengths[axis] { "more" } else { "less" }
            );
            fluid.warn("particle_spacing", message, "sizes of whole spacings keep the volume exact");
        }
    }
    Ok(())
}

/// What emitters, sinks and probes cannot do as they are.
fn check_flow(scene: &Scene, root: &Section<'_>) {
    let spacing = scene.fluid.particle_spacing;
    for emitter in &scene.emitters {
        let name = &emitter.name;
        let (area, layer) = match &emitter.outlet {
            Outlet::Disc { radius } => (PI * radius * radius, outlet::disc_layer(*radius, spacing)),
            Outlet::Rectangle { size } => (size[0] * size[1], outlet::rectangle_layer(*size, spacing)),
            Outlet::Mesh(_) => continue,
        };
        let share = layer.len() as f32 * spacing * spacing / area;
        if !(0.8..1.25).contains(&share) {
            let message = format!(
                "emitter {name:?} is so narrow that its {} particles across bring {:.3e} m^3/s instead of {:.3e}",
                layer.len(),
                share * area * emitter.speed,
                area * emitter.speed
            );
            root.warn("emitter", message, "use a finer particle_spacing, or an outlet of several spacings");
        }
        if emitter.start >= scene.duration {
            let message = format!(
                "emitter {name:?} begins at {} s, when the scene has ended at {} s",
                emitter.start, scene.duration
            );
            root.warn("emitter", message, "begin earlier, or make the scene longer");
        }
    }
    for sink in &scene.sinks {
        if let SinkRegion::Box { min, max } = sink.region
            && (min.cmpgt(scene.domain.max).any() || max.cmplt(scene.domain.min).any())
        {
            let message = format!("sink {:?} lies wholly outside the domain", sink.name);
            root.warn("sink", message, "nothing can get there: check min and max");
        }
    }
    for probe in &scene.probes {
        if probe.interval.is_some_and(|interval| interval > scene.duration) {
            let message =
                format!("probe {:?} has a longer interval than the scene, and will write no row", probe.name);
            root.warn("probe", message, "make interval shorter than duration");
        }
    }
}
