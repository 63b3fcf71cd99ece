//! The particle spacing of the files: given by the option, or contained in each file.

use std::path::Path;

use splashdown::sample::typical_spacing;
use splashdown_io::Particles;
use splashdown_run::sequence::Step;

use crate::args::SurfaceArguments;
use crate::exit::{Exit, Failure};
use crate::human;

/// The largest accepted ratio between the given spacing and the one estimated from the particles. A larger ratio is
/// a mistake: a radius instead of a diameter, or another unit.
const MAX_GIVEN_RATIO: f32 = 1.8;

/// The same for a spacing that a file contains. The distance of scattered drops is many spacings; a ratio beyond this
/// means that the number is wrong, or that the positions were scaled.
const MAX_CONTAINED_RATIO: f32 = 100.0;

/// The spacing for the first file with particles, which a given spacing has to fit.
///
/// # Errors
/// [`Exit::Usage`] if it does not fit, or if none is known; [`Exit::Scene`] if a file cannot be read, or none has particles.
pub fn first(arguments: &SurfaceArguments, steps: &[Step]) -> Result<f32, Failure> {
    let given = arguments.particle_spacing;
    if let (Some(given), true) = (given, arguments.force) {
        return Ok(given);
    }
    for Step { input, .. } in steps {
        if let Some(particles) = super::read(input, arguments)? {
            return match given {
                Some(given) => fitting(given, &particles, input),
                None => contained(&particles, arguments.force, input),
            };
        }
    }
    let name = steps.first().map(|step| step.input.display().to_string()).unwrap_or_default();
    let message = match steps.len() {
        0 | 1 => format!("`{name}` contains no particles"),
        count => format!("none of the {count} files contains particles, beginning with `{name}`"),
    };
    Err(Failure::new(Exit::Scene, message))
}

/// The spacing for one of the files.
///
/// # Errors
/// [`Exit::Usage`] if none is given, and the file has none or one that does not fit.
pub fn of(arguments: &SurfaceArguments, particles: &Particles, path: &Path) -> Result<f32, Failure> {
    arguments.particle_spacing.map_or_else(|| contained(particles, arguments.force, path), Ok)
}

/// A given spacing, if it fits the particles.
fn fitting(given: f32, particles: &Particles, path: &Path) -> Result<f32, Failure> {
    separate(particles, path)?;
    let found = estimated(particles).filter(|&found| !is_near(given, found, MAX_GIVEN_RATIO));
    let Some(found) = found else { return Ok(given) };
    let hint = if (given * 2.0 / found - 1.0).abs() < 0.15 { " (is it the particle radius?)" } else { "" };
    let (name, digits) = (path.display(), human::three_digits(f64::from(found)));
    Err(usage(format!(
        "a particle spacing of {given} does not fit the particles of `{name}`{hint}: their distance is about \
         {digits}. Give --particle-spacing {digits}, or --force to use {given}"
    )))
}

/// The spacing that a file contains.
fn contained(particles: &Particles, force: bool, path: &Path) -> Result<f32, Failure> {
    if !force {
        separate(particles, path)?;
    }
    let (name, found) = (path.display(), estimated(particles));
    let digits = found.map(|found| human::three_digits(f64::from(found))).unwrap_or_default();
    match (particles.info.particle_spacing, found) {
        (Some(spacing), Some(found)) if !force && !is_near(spacing, found, MAX_CONTAINED_RATIO) => {
            Err(usage(format!(
                "`{name}` contains a particle spacing of {spacing}, which does not fit its particles: their distance is \
                 about {digits}. Give --particle-spacing {digits}, or --force to use {spacing}"
            )))
        }
        (Some(spacing), _) => Ok(spacing),
        (None, Some(_)) => Err(usage(format!(
            "--particle-spacing is missing, and `{name}` does not contain it: give the initial distance of the \
             particles. Their distance is about {digits}"
        ))),
        (None, None) => Err(usage(format!(
            "--particle-spacing is missing, and `{name}` has too few particles to estimate it"
        ))),
    }
}

/// Refuses particles of which most are at the same place as others.
fn separate(particles: &Particles, path: &Path) -> Result<(), Failure> {
    if typical_spacing(&particles.positions) != Some(0.0) {
        return Ok(());
    }
    Err(Failure::new(
        Exit::Scene,
        format!(
            "most particles of `{}` are at the same place as others: write the file again, or give --particle-spacing and --force to use it",
            path.display()
        ),
    ))
}

fn estimated(particles: &Particles) -> Option<f32> {
    typical_spacing(&particles.positions).filter(|&found| found > 0.0)
}

fn is_near(spacing: f32, found: f32, ratio: f32) -> bool {
    (found / ratio..=found * ratio).contains(&spacing)
}

fn usage(message: String) -> Failure {
    Failure::new(Exit::Usage, message)
}
