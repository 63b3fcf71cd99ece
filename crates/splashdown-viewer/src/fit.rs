//! Whether a scene fits the device on which the page would simulate it.

use splashdown::scene::{Derived, Scene};
use splashdown::{check_particles, memory_forecast, neighbour_search_forecast};

/// The memory in bytes that the page may take if the browser does not tell that of the device.
const UNKNOWN: u64 = 4_000_000_000;

/// Checks that a scene fits a device. `largest_buffer` is the size of its largest buffer in bytes, and `memory` that of its
/// memory; 0: unknown. The page takes at most half of the memory, because the browser and the system need the rest.
///
/// # Errors
/// A message with the amounts and the spacing that fits.
pub(crate) fn check(scene: &Scene, largest_buffer: u64, memory: u64) -> Result<(), String> {
    let particles = Derived::new(scene).particles;
    let allowed = if memory == 0 { UNKNOWN } else { memory / 2 };
    let needed = forecast(scene, largest_buffer);
    if needed > allowed {
        let advice = fitting_spacing(scene, largest_buffer, allowed).map_or_else(
            || "Use a larger fluid.particle_spacing or a smaller domain".to_owned(),
            |spacing| format!("Use a fluid.particle_spacing of {spacing} m or more"),
        );
        return Err(format!(
            "The scene {:?} does not fit this device: its {particles} particles with a fluid.particle_spacing of {} m need {}, and the \
             page may take {} here. {advice}, or run the scene with the command line on a machine with more memory.",
            scene.name,
            scene.fluid.particle_spacing,
            size(needed),
            size(allowed),
        ));
    }
    check_particles(particles, largest_buffer, scene).map_err(|error| error.to_string())
}

/// The memory of its simulation in bytes.
fn forecast(scene: &Scene, largest_buffer: u64) -> u64 {
    let search = neighbour_search_forecast(scene, Derived::new(scene).particles, Some(largest_buffer));
    memory_forecast(scene).saturating_add(search)
}

/// A spacing in m, with two digits, at which the memory suffices. `None` if the grid of the domain alone does not fit.
fn fitting_spacing(scene: &Scene, largest_buffer: u64, allowed: u64) -> Option<f32> {
    let mut coarser = scene.clone();
    for _ in 0..16 {
        let needed = forecast(&coarser, largest_buffer);
        if needed <= allowed {
            return Some(coarser.fluid.particle_spacing);
        }
        let factor = (needed as f64 / allowed.max(1) as f64).cbrt().max(1.02);
        let spacing = rounded_up(f64::from(coarser.fluid.particle_spacing) * factor);
        coarser.surface.cell_size *= spacing / coarser.fluid.particle_spacing;
        coarser.fluid.particle_spacing = spacing;
    }
    None
}

/// The next number with two significant digits.
fn rounded_up(length: f64) -> f32 {
    let digits = 1 - length.log10().floor() as i32;
    let scale = 10f64.powi(digits);
    ((length * scale).ceil() / scale) as f32
}

fn size(bytes: u64) -> String {
    match bytes {
        0..1_000_000_000 => format!("{:.0} MB", bytes as f64 / 1e6),
        _ => format!("{:.1} GB", bytes as f64 / 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(spacing: f64) -> Scene {
        let text = format!(
            "[scene]\nname = \"block\"\nduration = 1.0\n[domain]\nmin = [0, 0, 0]\nmax = [2, 1, 1]\n\
             [fluid]\nparticle_spacing = {spacing}\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, 1, 1]\n"
        );
        Scene::parse(&text, "block").unwrap()
    }

    #[test]
    fn the_reported_spacing_fits_and_a_smaller_one_does_not() {
        let (buffer, memory) = (1 << 30, 1 << 30);
        assert_eq!(check(&block(0.05), buffer, memory), Ok(()));
        let message = check(&block(0.005), buffer, memory).unwrap_err();
        assert!(message.contains("8000000 particles") && message.contains("537 MB"), "{message}");
        let (_, rest) =
            message.split_once("particle_spacing of ").unwrap().1.split_once("particle_spacing of ").unwrap();
        let reported: f64 = rest.split(' ').next().unwrap().parse().unwrap();
        assert_eq!(check(&block(reported), buffer, memory), Ok(()), "{message}");
        assert!(check(&block(0.9 * reported), buffer, memory).is_err(), "{message}");
    }

    #[test]
    fn the_largest_buffer_counts_as_well() {
        let scene = block(0.02);
        assert_eq!(check(&scene, 128 << 20, 0), Ok(()));
        let message = check(&scene, 1 << 20, 0).unwrap_err();
        assert!(message.contains("buffer"), "{message}");
    }

    #[test]
    fn spacings_are_rounded_up_to_two_digits() {
        for (length, rounded) in [(0.0123, 0.013), (0.0999, 0.1), (1.01, 1.1)] {
            assert!((rounded_up(length) - rounded).abs() < 1e-6, "{length}");
        }
    }
}
