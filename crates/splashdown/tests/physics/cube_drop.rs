//! A cube of a liquid without gravity becomes a ball by surface tension. Its sphericity (Wadell 1935) is the area of a ball of
//! equal volume over its own area; both are those of the surface mesh.
//!
//! The kinematic viscosity is 0.3 sqrt(sigma R / rho), so that the ball is at rest after eight capillary times.

use std::f64::consts::PI;

use glam::DVec3;
use splashdown::surface::{SurfaceParams, reconstruct_with};
use splashdown::{Simulation, sample};
use splashdown_io::{Mesh, Particles};

use super::cases::{CONTROL, Case, Variant};
use super::figures::{Figures, Series};
use super::{executor, scene, vec};

/// Tension in N/m and density in kg/m^3 of water, and the spacing in m.
const TENSION: f64 = 0.0727;
const DENSITY: f64 = 1000.0;
const SPACING: f64 = 0.0005;
/// The Ohnesorge number, nu / sqrt(sigma R / rho).
const OHNESORGE: f64 = 0.3;
/// The duration in capillary times, sqrt(rho R^3 / sigma), and samples per capillary time.
const DURATION: f64 = 8.0;
const SAMPLES: u32 = 5;

static CASE: Case = Case {
    name: "cube becomes a drop",
    across: "edge",
    sizes: &[8, 16, 24],
    variants: &[
        Variant::new("dfsph", "method = \"dfsph\""),
        Variant::extra("engineering", "accuracy = \"engineering\""),
        CONTROL,
    ],
};
pub const CASES: &[&Case] = &[&CASE];

/// A cube, and the radius in m of a ball of the same volume.
fn cube(across: u32, keys: &str) -> (Simulation, f64) {
    let edge = f64::from(across) * SPACING;
    let radius = edge * (0.75 / PI).cbrt();
    let viscosity = OHNESORGE * (TENSION * radius / DENSITY).sqrt();
    let (half, side) = (0.5 * edge, 1.5 * edge);
    let scene = scene(&format!(
        "[scene]\nname = \"cube\"\nduration = 10\ngravity = [0, 0, 0]\n[domain]\nmin = [-{side}, -{side}, -{side}]\n\
         max = [{side}, {side}, {side}]\n[fluid]\nparticle_spacing = {SPACING}\nviscosity = {viscosity}\n\
         surface_tension = {TENSION}\n[[fluid.block]]\nposition = [-{half}, -{half}, -{half}]\n\
         size = [{edge}, {edge}, {edge}]\n[solver]\n{keys}\nsurface_tension = \"csf\"\n"
    ));
    let particles = sample::particles(&scene).unwrap();
    assert_eq!(particles.positions.len(), across.pow(3) as usize);
    (Simulation::with_particles(&scene, executor(), &particles).unwrap(), radius)
}

/// The area of a ball with the volume of the mesh over the area of the mesh, and the volume of the mesh over that of the
/// particles. Cavities count.
fn sphericity(particles: &Particles) -> (f64, f64) {
    let mut params = SurfaceParams::new(SPACING as f32);
    // The particles of the surface are as rough as half a spacing. Smoothing removes that, and rounds edges: the mesh of a
    // cube of 8 spacings has a sphericity of 0.91, an exact cube 0.81.
    params.smoothing_iterations = 20;
    let (mesh, _) = reconstruct_with(&particles.positions, &params, &mut executor()).unwrap();
    let volume = particles.positions.len() as f64 * SPACING.powi(3);
    (PI.cbrt() * (6.0 * mesh.volume()).powf(2.0 / 3.0) / area(&mesh), mesh.volume() / volume)
}

fn area(mesh: &Mesh) -> f64 {
    let corner = |index: u32| vec(mesh.vertices[index as usize]);
    let triangle = |t: &[u32; 3]| {
        let [a, b, c] = t.map(corner);
        0.5 * (b - a).cross(c - a).length()
    };
    mesh.triangles.iter().map(triangle).sum()
}

#[test]
fn a_cube_becomes_a_ball() {
    CASE.run(|variant, across, figures| {
        let (mut simulation, radius) = cube(across, variant.keys);
        let time = (DENSITY * radius.powi(3) / TENSION).sqrt();
        let mut particles = simulation.particles().unwrap();
        let mut curve: Series = vec![(0.0, sphericity(&particles).0)];
        for step in 1..=(DURATION * f64::from(SAMPLES)) as u32 {
            let stats = simulation.advance((time / f64::from(SAMPLES)) as f32).unwrap();
            assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
            particles = simulation.particles().unwrap();
            curve.push((f64::from(step) / f64::from(SAMPLES), sphericity(&particles).0));
        }
        figures.measure("sphericity after 8 capillary times", curve[curve.len() - 1].1);
        figures.report(
            "volume of the surface over that of the particles, minus one",
            sphericity(&particles).1 - 1.0,
        );
        let centre = particles.positions.iter().map(|&x| vec(x)).sum::<DVec3>();
        let drift = centre.length() / particles.positions.len() as f64 / radius;
        figures.measure("motion of the centre over R", drift);
        let side = DVec3::splat(2.0 * radius);
        let nearest = super::disorder::measure(&particles.positions, SPACING, -side, side).nearest;
        figures.measure("disorder: smallest distance, spacings", nearest);
        let line = vec![(0.0, 1.0), (DURATION, 1.0)];
        figures.plot(
            "Sphericity (dots: a ball)",
            ["time over sqrt(rho R^3 / sigma)", "sphericity"],
            &line,
            &curve,
        );
    });
}

#[test]
fn the_cube_itself_is_detected() {
    let (mut simulation, _) = cube(8, CASE.variants[0].keys);
    let mut figures = Figures::new(&CASE, CONTROL.name, 8);
    figures.measure(
        "one minus the sphericity of the cube",
        1.0 - sphericity(&simulation.particles().unwrap()).0,
    );
    figures.close();
}
