//! A sessile drop without gravity, with contact angles of 90 and 120 degrees: it starts as half a ball on a side of the
//! domain and relaxes into a spherical cap. The angle of the cap follows from its volume and the height of its centre of
//! mass, and from its height and the area of its lowest layer.
//!
//! The kinematic viscosity is half of sqrt(sigma R / rho). The angle at rest does not depend on it. With that of water the drop
//! oscillates longer than the case lasts.

use std::f64::consts::PI;

use glam::DVec3;
use splashdown::Simulation;
use splashdown_io::Particles;

use super::cases::{CONTROL, Case, Variant};
use super::figures::{Figures, Series};
use super::{executor, rms_speed, scene, vec};

/// Tension in N/m and density in kg/m^3 of water, and the spacing in m.
const TENSION: f64 = 0.0727;
const DENSITY: f64 = 1000.0;
const SPACING: f64 = 0.0005;
/// The duration, and the part at its end whose mean counts, in capillary times.
const DURATION: f64 = 8.0;
const MEAN: f64 = 2.0;
/// The Ohnesorge number, nu / sqrt(sigma R / rho).
const OHNESORGE: f64 = 0.5;
/// Samples per capillary time.
const SAMPLES: u32 = 10;

const ENGINEERING: &str = "accuracy = \"engineering\"";

static CASE: Case = Case {
    name: "sessile drop",
    across: "radius",
    sizes: &[6, 10, 15],
    variants: &[
        Variant::new("engineering", ENGINEERING),
        Variant::extra("dfsph", "method = \"dfsph\""),
        CONTROL,
    ],
};
pub const CASES: &[&Case] = &[&CASE];

struct Measured {
    /// The angle in degrees by volume and centre of mass, and by height and base.
    by_centre: f64,
    by_base: f64,
    /// Motion of the centre along the wall over the radius, per capillary time.
    drift: f64,
    /// Speed at the end times the capillary time over the radius.
    speed: f64,
    /// The angle by volume and centre of mass over the time in capillary times.
    curve: Series,
}

/// Lets half a ball of this radius in spacings relax.
fn relax(across: u32, keys: &str, angle: f64) -> Measured {
    let radius = f64::from(across) * SPACING;
    let (half, high) = (2.0 * radius, 2.5 * radius);
    let viscosity = OHNESORGE * (TENSION * radius / DENSITY).sqrt();
    // The ball of the scene is replaced by its upper half, on the floor.
    let scene = scene(&format!(
        "[scene]\nname = \"sessile\"\nduration = 10\ngravity = [0, 0, 0]\n[domain]\nmin = [-{half}, 0, -{half}]\n\
         max = [{half}, {high}, {half}]\n[fluid]\nparticle_spacing = {SPACING}\nviscosity = {viscosity}\n\
         surface_tension = {TENSION}\n[[fluid.block]]\nshape = \"sphere\"\ncenter = [0, {radius}, 0]\nradius = {radius}\n\
         [solver]\n{keys}\nsurface_tension = \"csf\"\ncontact_angle = {angle}\n"
    ));
    let particles = Particles::from_positions(half_ball(across));
    let volume = particles.positions.len() as f64 * SPACING.powi(3);
    let time = (DENSITY * radius.powi(3) / TENSION).sqrt();
    let mut simulation = Simulation::with_particles(&scene, executor(), &particles).unwrap();
    let (mut by_centre, mut by_base, mut curve) = (Vec::new(), Vec::new(), Series::new());
    let first = centre(&particles);
    let mut last = particles;
    for step in 1..=(DURATION * f64::from(SAMPLES)) as u32 {
        let stats = simulation.advance((time / f64::from(SAMPLES)) as f32).unwrap();
        assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
        last = simulation.particles().unwrap();
        let now = f64::from(step) / f64::from(SAMPLES);
        let found = angle_of_centre(centre(&last).y / volume.cbrt());
        curve.push((now, found));
        if now > DURATION - MEAN {
            by_centre.push(found);
            by_base.push(angle_of_base(&last));
        }
    }
    let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
    Measured {
        by_centre: mean(&by_centre),
        by_base: mean(&by_base),
        drift: (centre(&last) - first).with_y(0.0).length() / radius / DURATION,
        speed: rms_speed(&last) * time / radius,
        curve,
    }
}

/// The upper half of a ball on a lattice.
fn half_ball(across: u32) -> Vec<[f32; 3]> {
    let n = across as i32;
    let at = |k: i32| f64::from(k) + 0.5;
    let columns = (-n..n).flat_map(|x| (-n..n).map(move |z| (x, z)));
    let points = columns.flat_map(|(x, z)| (0..n).map(move |y| DVec3::new(at(x), at(y), at(z))));
    points
        .filter(|point| point.length() < f64::from(across))
        .map(|point| (SPACING * point).as_vec3().to_array())
        .collect()
}

fn centre(particles: &Particles) -> DVec3 {
    particles.positions.iter().map(|&x| vec(x)).sum::<DVec3>() / particles.positions.len() as f64
}

/// The height of the centre of a cap with this angle in radians over the cube root of its volume.
fn height_of_centre(angle: f64) -> f64 {
    let height = 1.0 - angle.cos();
    let volume = PI * height.powi(2) * (3.0 - height) / 3.0;
    height * (4.0 - height) / (4.0 * (3.0 - height)) / volume.cbrt()
}

/// The angle in degrees of a cap with this height of the centre over the cube root of its volume.
fn angle_of_centre(height: f64) -> f64 {
    let (mut low, mut high) = (0.01, 3.1);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if height_of_centre(middle) < height { low = middle } else { high = middle }
    }
    (0.5 * (low + high)).to_degrees()
}

/// The angle in degrees by the height and the area of the lowest layer: tan(angle / 2) = height / radius of the base.
fn angle_of_base(particles: &Particles) -> f64 {
    let heights = || particles.positions.iter().map(|x| f64::from(x[1]));
    let top = heights().fold(0.0, f64::max) + 0.5 * SPACING;
    let lowest = heights().filter(|y| *y < SPACING).count();
    let base = (lowest as f64 / PI).sqrt() * SPACING;
    2.0 * (top / base).atan().to_degrees()
}

#[test]
fn a_sessile_drop_takes_the_contact_angle() {
    CASE.run(|variant, across, figures| {
        for angle in [90.0, 120.0] {
            let found = relax(across, variant.keys, angle);
            figures.error(
                format!("{angle} degrees, error by volume and centre, degrees"),
                found.by_centre - angle,
            );
            figures
                .error(format!("{angle} degrees, error by height and base, degrees"), found.by_base - angle);
            figures.measure(format!("{angle} degrees, drift over R per capillary time"), found.drift);
            figures.report(format!("{angle} degrees, rms speed times capillary time over R"), found.speed);
            if angle != 90.0 {
                let line = vec![(0.0, angle), (DURATION, angle)];
                let title = format!("Angle of the cap (dots: {angle} degrees)");
                figures.plot(&title, ["time over sqrt(rho R^3 / sigma)", "degrees"], &line, &found.curve);
            }
        }
    });
}

#[test]
fn another_contact_angle_is_detected() {
    let found = relax(6, ENGINEERING, 90.0);
    let mut figures = Figures::new(&CASE, CONTROL.name, 6);
    figures.measure("90 degrees against 120, degrees", (found.by_centre - 120.0).abs());
    figures.close();
}

#[test]
fn the_angle_of_a_cap_follows_from_its_centre() {
    // Half a ball: the centre is at 3/8 R.
    let height = 0.375 / (2.0 * PI / 3.0).cbrt();
    assert!((angle_of_centre(height) - 90.0).abs() < 1e-6);
    // A whole ball.
    assert!((height_of_centre(PI) - 1.0 / (4.0 * PI / 3.0).cbrt()).abs() < 1e-9);
    let half = Particles::from_positions(half_ball(10));
    let volume = half.positions.len() as f64 * SPACING.powi(3);
    assert!((angle_of_centre(centre(&half).y / volume.cbrt()) - 90.0).abs() < 1.0);
    assert!((angle_of_base(&half) - 90.0).abs() < 3.0);
}
