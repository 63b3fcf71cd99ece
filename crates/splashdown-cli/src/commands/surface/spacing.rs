//! The particle spacing of the files: given by the option, or contained in each file.

use std::path::Path;

use splashdown::sample::typical_spacing;
use splashdown_io::Particles;

use crate::args::SurfaceArguments;
use crate::exit::{Exit, Failure};
use crate::human;

/// The largest accepted ratio between the given spacing and the one estimated from the particles. A larger ratio is
/// a mistake: a radius instead of a diameter, or another unit.
const MAX_GIVEN_RATIO: f32 = 1.8;

/// The same for a spacing that a file contains. The distance of scattered drops is many spacings; a ratio beyond this
/// means that the number is wrong, or that the positions were scaled.
const MAX_CONTAINED_RATIO: f32 = 100.0;

/// The spacing for the first file, whose particles a given spacing has to fit.
///
/// # Errors
/// [`Exit::Usage`] if it does not fit, or if none is known; [`Exit::Scene`] if the file cannot be read.
pub fn first(arguments: &SurfaceArguments, path: &Path) -> Result<f32, Failure> {
    match arguments.particle_spacing {
        Some(given) if arguments.force => Ok(given),
        Some(given) => fitting(given, &super::read(path, arguments)?, path),
        None => contained(&super::read(path, arguments)?, arguments.force, path),
    }
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

fn estimated(particles: &Particles) -> Option<f32> {
    typical_spacing(&particles.positions).filter(|&found| found > 0.0)
}

fn is_near(spacing: f32, found: f32, ratio: f32) -> bool {
    (found / ratio..=found * ratio).contains(&spacing)
}

fn usage(message: String) -> Failure {
    Failure::new(Exit::Usage, message)
}
