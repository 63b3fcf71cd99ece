//! Measures the effective surface tension of a drop: a weightless drop is stretched by an initial velocity and
//! oscillates.
//!
//! Rayleigh (1879): omega^2 = 8 sigma / (rho R^3) for the second mode, so sigma follows from the period of
//! <x^2> - <y^2>. `cargo run --release -p splashdown --example droplet -- [RADIUS IN SPACINGS] [SPACING IN M]`

use splashdown::scene::Scene;
use splashdown::{Device, Simulation};
use splashdown_io::Particles;

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<f64>());
    let radius_in_spacings = arguments.next().unwrap_or(Ok(8.0))?;
    let spacing = arguments.next().unwrap_or(Ok(0.0005))?;
    let radius = radius_in_spacings * spacing;
    let half = 2.0 * radius;
    let text = format!(
        "[scene]\nname = \"droplet\"\nduration = 1.0\ngravity = [0, 0, 0]\n\
         [domain]\nmin = [{0}, {0}, {0}]\nmax = [{half}, {half}, {half}]\n\
         [fluid]\nparticle_spacing = {spacing}\nmaterial = \"water\"\n\
         [[fluid.block]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = {radius}\n\
         [solver]\nmethod = \"wcsph\"\nsurface_tension = \"akinci2013\"\nartificial_viscosity = 0.05\n",
        -half
    );
    let scene = Scene::parse(&text, "droplet").map_err(|errors| errors.to_string())?;
    let particles = splashdown::sample::particles(&scene)?;
    // The radius follows from the number of particles of the sampled ball.
    let count = particles.positions.len() as f64;
    let radius = (count * spacing.powi(3) * 0.75 / std::f64::consts::PI).cbrt();
    let sigma = f64::from(scene.fluid.material.surface_tension);
    let expected = std::f64::consts::TAU / (8.0 * sigma / (1000.0 * radius.powi(3))).sqrt();
    println!("{count} particles, R = {radius:.5} m, sigma = {sigma} N/m, expected period {expected:.4} s");

    let mut simulation = Simulation::with_particles(&scene, Device::Cpu.executor()?, &particles)?;
    // The lattice relaxes to a liquid first; then the drop gets a velocity that stretches it.
    simulation.advance(expected as f32)?;
    let mut particles = simulation.particles()?;
    let push = (0.3 * std::f64::consts::TAU / expected) as f32;
    for (v, [x, y, z]) in particles.velocities.iter_mut().zip(&particles.positions) {
        *v = [push * x, -0.5 * push * y, -0.5 * push * z];
    }
    let mut simulation = Simulation::with_particles(&scene, Device::Cpu.executor()?, &particles)?;
    let frame = (expected / 60.0) as f32;
    let mut crossings = Vec::new();
    let mut highest = 0.0_f64;
    let mut before = elongation(&particles);
    for _ in 0..180 {
        let stats = simulation.advance(frame)?;
        let now = elongation(&simulation.particles()?);
        if before.signum() != now.signum() {
            crossings.push(stats.time - f64::from(frame) * now / (now - before));
        }
        before = now;
        highest = highest.max(now);
    }
    let stats = simulation.stats();
    println!(
        "elongation {highest:.4} at most, {before:.4} at the end, density error {:.4}, {} steps",
        stats.density_error, stats.steps
    );
    match (crossings.get(1), crossings.last()) {
        (Some(first), Some(last)) if crossings.len() > 3 => {
            let period = 2.0 * (last - first) / (crossings.len() - 2) as f64;
            println!(
                "period {period:.4} s from {} zero crossings: sigma is {:.3} of the material's",
                crossings.len(),
                (expected / period).powi(2)
            );
        }
        _ => println!("too few oscillations: {crossings:?}"),
    }
    Ok(())
}

/// (<x^2> - <y^2>) / (<x^2> + <y^2>) about the centre.
fn elongation(particles: &Particles) -> f64 {
    let n = particles.positions.len() as f64;
    let moment = |axis: usize| {
        let mean = particles.positions.iter().map(|p| f64::from(p[axis])).sum::<f64>() / n;
        particles.positions.iter().map(|p| (f64::from(p[axis]) - mean).powi(2)).sum::<f64>() / n
    };
    let (x, y) = (moment(0), moment(1));
    (x - y) / (x + y)
}
