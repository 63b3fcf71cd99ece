//! The section `[solver]`.

use super::Part;
use crate::scene::reader::Section;
use crate::scene::solver::{Accuracy, DensityMode, Method, Solver, SurfaceTension};

pub(super) fn read_solver(section: &Section<'_>) -> Part<Solver> {
    let method = section.choice("method");
    let accuracy = section.choice("accuracy");
    let kernel = section.choice("kernel");
    let support_ratio = section.number("support_ratio");
    let density = section.choice("density");
    let negative_pressure = section.choice("negative_pressure");
    let sound_speed = section.number("sound_speed");
    let stiffness = section.number("stiffness");
    let exponent = section.number("exponent");
    let artificial_viscosity = section.number("artificial_viscosity");
    let density_diffusion = section.number("density_diffusion");
    let surface_tension = section.choice("surface_tension");
    let contact_angle = section.number("contact_angle");
    let wall_friction = section.number("wall_friction");
    let cfl_factor = section.number("cfl_factor");
    let max_dt = section.number("max_dt");
    let min_dt = section.number("min_dt");
    let sort = section.choice("sort");
    let tolerance = section.number("tolerance");
    let max_iterations = section.integer("max_iterations");
    let accuracy = accuracy?.unwrap_or(Accuracy::Standard);
    let method = method?.unwrap_or_else(|| fitting_method(section, accuracy));
    let density = density?.unwrap_or(match accuracy {
        Accuracy::Standard => DensityMode::Summation,
        Accuracy::Engineering => DensityMode::Continuity,
    });
    let standard = Solver::with(method, density);
    let surface_tension = surface_tension?.unwrap_or(standard.surface_tension);
    let has_tension_force = surface_tension == SurfaceTension::Csf;
    let support_ratio = support_ratio?.unwrap_or(match accuracy {
        Accuracy::Standard if !has_tension_force => standard.support_ratio,
        _ => Solver::WIDE_SUPPORT,
    });
    let solver = Solver {
        kernel: kernel?.unwrap_or(Solver::usual_kernel(method, support_ratio)),
        support_ratio,
        negative_pressure: negative_pressure?.unwrap_or(standard.negative_pressure),
        sound_speed: sound_speed?,
        stiffness: stiffness?,
        exponent: exponent?.unwrap_or(standard.exponent),
        artificial_viscosity: artificial_viscosity?.unwrap_or(standard.artificial_viscosity),
        density_diffusion: density_diffusion?.unwrap_or(standard.density_diffusion),
        surface_tension,
        contact_angle: contact_angle?.unwrap_or(standard.contact_angle),
        wall_friction: wall_friction?.unwrap_or(standard.wall_friction),
        cfl_factor: cfl_factor?.unwrap_or(standard.cfl_factor),
        max_dt: max_dt?.unwrap_or(standard.max_dt),
        min_dt: min_dt?.unwrap_or(standard.min_dt),
        sort: sort?.unwrap_or(standard.sort),
        tolerance: tolerance?.unwrap_or(Solver::usual_tolerance(method, surface_tension)),
        max_iterations: max_iterations?,
        ..standard
    };
    let accurate = check_accuracy(section, accuracy, method, density);
    check_solver(section, &solver).and(accurate).map(|()| solver)
}

/// The method of a scene that names none: the default, or `wcsph` for keys that have no effect with the default.
fn fitting_method(section: &Section<'_>, accuracy: Accuracy) -> Method {
    let is_explicit = Solver::NOT_IMPLICIT.into_iter().any(|name| section.has(name));
    if is_explicit || accuracy == Accuracy::Engineering { Method::Wcsph } else { Solver::default().method }
}

/// Reports choices that are not accurate although accuracy is asked for.
fn check_accuracy(
    section: &Section<'_>,
    accuracy: Accuracy,
    method: Method,
    density: DensityMode,
) -> Part<()> {
    if accuracy == Accuracy::Standard {
        return Ok(());
    }
    let advice = "leave one of the two keys out";
    if method != Method::Wcsph {
        let message = format!("solver.method = \"{method}\" does not work with accuracy = \"{accuracy}\"");
        return Err(section.complain("method", message, "\"wcsph\"", advice));
    }
    if density != DensityMode::Continuity {
        let message = format!("solver.density = \"{density}\" does not work with accuracy = \"{accuracy}\"");
        return Err(section.complain("density", message, "\"continuity\"", advice));
    }
    Ok(())
}

/// Reports values that contradict each other or have no effect.
fn check_solver(section: &Section<'_>, solver: &Solver) -> Part<()> {
    let mut result = Ok(());
    if solver.min_dt > solver.max_dt {
        let message =
            format!("solver.min_dt = {} s is above solver.max_dt = {} s", solver.min_dt, solver.max_dt);
        result = Err(section.complain("min_dt", message, &format!("at most {} s", solver.max_dt), ""));
    }
    if section.has("sound_speed") && section.has("stiffness") {
        let message = "solver.sound_speed and solver.stiffness define the same quantity".to_owned();
        result = Err(section.complain("stiffness", message, "", "keep one of them"));
    }
    match (solver.method, solver.surface_tension) {
        (Method::Mueller2003, SurfaceTension::Akinci2013 | SurfaceTension::Csf)
        | (Method::Wcsph | Method::Dfsph, SurfaceTension::ColourField) => {
            let (method, tension) = (solver.method, solver.surface_tension);
            let message =
                format!("solver.surface_tension = \"{tension}\" does not work with method = \"{method}\"");
            let allowed = match method {
                Method::Wcsph | Method::Dfsph => "\"none\", \"akinci2013\", \"csf\"",
                Method::Mueller2003 => "\"none\", \"mueller2003\"",
            };
            result = Err(section.complain("surface_tension", message, allowed, ""));
        }
        _ => {}
    }
    if solver.surface_tension == SurfaceTension::Csf && solver.support_ratio < Solver::WIDE_SUPPORT {
        let message = format!(
            "solver.surface_tension = \"csf\" does not work with support_ratio = {}: it cannot resolve the curvature",
            solver.support_ratio
        );
        let allowed = format!("at least {}", Solver::WIDE_SUPPORT);
        result = Err(section.complain("support_ratio", message, &allowed, "leave it out"));
    }
    if solver.surface_tension != SurfaceTension::Csf && section.has("contact_angle") {
        let message = format!(
            "solver.contact_angle has no effect with surface_tension = \"{}\"",
            solver.surface_tension
        );
        let advice = "leave it out, or use surface_tension = \"csf\"";
        result = Err(section.complain("contact_angle", message, "", advice));
    }
    if solver.method == Method::Dfsph {
        for name in Solver::NOT_IMPLICIT.into_iter().filter(|name| section.has(name)) {
            let message = format!("solver.{name} has no effect with method = \"dfsph\"");
            result = Err(section.complain(name, message, "", "leave it out, or use method = \"wcsph\""));
        }
        return result;
    }
    for name in ["tolerance", "max_iterations"].into_iter().filter(|name| section.has(name)) {
        let message = format!("solver.{name} has no effect with method = \"{}\"", solver.method);
        result = Err(section.complain(name, message, "", "leave it out, or use method = \"dfsph\""));
    }
    if solver.method == Method::Mueller2003 {
        if solver.density == DensityMode::Continuity {
            let message =
                "solver.density = \"continuity\" does not work with method = \"mueller2003\"".to_owned();
            result = Err(section.complain("density", message, "\"summation\"", ""));
        }
        for name in ["kernel", "artificial_viscosity", "density_diffusion"]
            .into_iter()
            .filter(|name| section.has(name))
        {
            let message = format!("solver.{name} has no effect with method = \"mueller2003\"");
            result = Err(section.complain(name, message, "", "leave it out, or use method = \"wcsph\""));
        }
    } else if solver.density == DensityMode::Summation && section.has("density_diffusion") {
        let message = "solver.density_diffusion has no effect with density = \"summation\"".to_owned();
        result = Err(section.complain(
            "density_diffusion",
            message,
            "",
            "leave it out, or use density = \"continuity\"",
        ));
    }
    result
}
