//! Physics: whole runs compared with analytic solutions, conservation laws and measurements.
//!
//! Each case is data ([`cases`]) with its gates in `gates.toml`, which are set before the first run. The tests run the smallest
//! of up to three resolutions. With `SPLASHDOWN_FULL=quick` two of them run, with `SPLASHDOWN_FULL=1` all; with
//! `SPLASHDOWN_FIGURES=DIR` they write their figures there as JSON (`cargo xtask validate` sets both).

mod accelerated;
mod capillary;
mod cases;
mod conservation;
mod cube_drop;
mod dam_break;
mod disorder;
mod drag;
mod drop;
mod figures;
mod floating;
mod floating_shapes;
mod free_fall;
mod gates;
mod hydrostatics;
mod implicit;
mod jet;
#[path = "../meshes/mod.rs"]
mod meshes;
mod patch;
mod planar_jet;
mod progressive;
mod recorded;
mod ritter;
mod roll;
mod sessile;
mod shapes;
mod sloshing;
mod spheric2;
mod step;
mod still_water;
mod stretching;
mod submerged;
mod tilted;
mod torricelli;
mod utube;
mod viscosity;
mod volume;
mod vortex;
mod waves;
mod wedge;

use cases::executor;
use glam::DVec3;
use splashdown::scene::Scene;
use splashdown_io::Particles;

/// All cases, module by module.
const CASES: &[&[&cases::Case]] = &[
    accelerated::CASES,
    capillary::CASES,
    conservation::CASES,
    cube_drop::CASES,
    dam_break::CASES,
    drag::CASES,
    drop::CASES,
    floating::CASES,
    floating_shapes::CASES,
    free_fall::CASES,
    hydrostatics::CASES,
    implicit::CASES,
    jet::CASES,
    patch::CASES,
    planar_jet::CASES,
    progressive::CASES,
    ritter::CASES,
    roll::CASES,
    sessile::CASES,
    sloshing::CASES,
    spheric2::CASES,
    still_water::CASES,
    step::CASES,
    stretching::CASES,
    submerged::CASES,
    tilted::CASES,
    torricelli::CASES,
    utube::CASES,
    viscosity::CASES,
    volume::CASES,
    vortex::CASES,
    waves::CASES,
    wedge::CASES,
];

/// Parses the text of a scene file.
fn scene(text: &str) -> Scene {
    Scene::parse(text, "physics.toml").unwrap_or_else(|errors| panic!("{errors}"))
}

fn vec(v: [f32; 3]) -> DVec3 {
    DVec3::from_array(v.map(f64::from))
}

/// The sum of the velocities: momentum over the mass of a particle.
fn velocity_sum(particles: &Particles) -> DVec3 {
    particles.velocities.iter().map(|&v| vec(v)).sum()
}

/// The sum of x cross v: angular momentum about the origin over the mass of a particle.
fn angular_sum(particles: &Particles) -> DVec3 {
    particles.positions.iter().zip(&particles.velocities).map(|(&x, &v)| vec(x).cross(vec(v))).sum()
}

/// The sum of |v|^2: twice the kinetic energy over the mass of a particle.
fn square_sum(particles: &Particles) -> f64 {
    particles.velocities.iter().map(|&v| vec(v).length_squared()).sum()
}

fn rms_speed(particles: &Particles) -> f64 {
    (square_sum(particles) / particles.velocities.len() as f64).sqrt()
}
