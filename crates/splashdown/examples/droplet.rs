//! Measures the effective surface tension of a drop without gravity, at rest and while it oscillates.
//!
//! Laplace: the pressure inside is 2 sigma / R. Rayleigh (1879): omega^2 = 8 sigma / (rho R^3) for the second mode, so
//! sigma follows from the period of <x^2> - <y^2>.
//!
//! `cargo run --release -p splashdown --example droplet -- [RADIUS IN SPACINGS] [SOLVER KEYS]...`

use std::f64::consts::{PI, TAU};

use splashdown::scene::Scene;
use splashdown::{Device, Simulation};
use splashdown_io::Particles;

const SPACING: f64 = 0.0005;
/// Rate of the initial stretching times the expected period.
const PUSH: f64 = 0.12;

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let radius = SPACING * arguments.next().map_or(Ok(8.0), |text| text.parse::<f64>())?;
    let mut keys: Vec<String> = arguments.collect();
    if keys.is_empty() {
        keys = ["accuracy = \"engineering\"", "surface_tension = \"csf\""].map(str::to_owned).to_vec();
    }
    let half = 2.0 * radius;
    let text = format!(
        "[scene]\nname = \"droplet\"\nduration = 1.0\ngravity = [0, 0, 0]\n\
         [domain]\nmin = [-{half}, -{half}, -{half}]\nmax = [{half}, {half}, {half}]\n\
         [fluid]\nparticle_spacing = {SPACING}\nmaterial = \"water\"\n\
         [[fluid.block]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = {radius}\n\
         [solver]\n{}\n",
        keys.join("\n")
    );
    let scene = Scene::parse(&text, "droplet").map_err(|errors| errors.to_string())?;
    let particles = splashdown::sample::particles(&scene)?;
    // The radius follows from the number of particles of the sampled ball.
    let count = particles.positions.len() as f64;
    let radius = (count * SPACING.powi(3) * 0.75 / PI).cbrt();
    let sigma = f64::from(scene.fluid.material.surface_tension);
    let expected = TAU / (8.0 * sigma / (1000.0 * radius.powi(3))).sqrt();
    println!("{count} particles, R = {radius:.5} m, sigma = {sigma:.5} N/m, expected period {expected:.4} s");

    let mut simulation = Simulation::with_particles(&scene, Device::Cpu.executor()?, &particles)?;
    // The lattice relaxes to a liquid first; then the drop gets a velocity that stretches it.
    for _ in 0..20 {
        simulation.advance((0.1 * expected) as f32)?;
    }
    let mut particles = simulation.particles()?;
    let scale = radius / expected;
    let Rest { centre, pressure, speed, roundness } = rest(&particles, radius);
    println!(
        "at rest: pressure {:.3} of 2 sigma / R, rms speed {:.4} of R / period, centre moved {:.1e} R, roundness {roundness:.3}",
        pressure * radius / (2.0 * sigma),
        speed / scale,
        centre / radius
    );
    let push = (PUSH / expected) as f32 * TAU as f32;
    for (v, [x, y, z]) in particles.velocities.iter_mut().zip(&particles.positions) {
        *v = [push * x, -0.5 * push * y, -0.5 * push * z];
    }
    let mut simulation = Simulation::with_particles(&scene, Device::Cpu.executor()?, &particles)?;
    let frame = (expected / 60.0) as f32;
    let (mut crossings, mut highest) = (Vec::new(), Vec::new());
    let mut before = elongation(&particles);
    let mut extreme = 0.0_f64;
    for _ in 0..200 {
        let stats = simulation.advance(frame)?;
        let now = elongation(&simulation.particles()?);
        extreme = extreme.max(now.abs());
        if before.signum() != now.signum() {
            crossings.push(stats.time - f64::from(frame) * now / (now - before));
            highest.push((extreme * 1000.0).round() / 1000.0);
            extreme = 0.0;
        }
        before = now;
    }
    let stats = simulation.stats();
    println!(
        "extremes of the elongation {highest:?}, density error {:.4}, {} steps",
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

/// A drop at rest: the distance of its centre from the origin in m, the mean pressure within half of its radius in Pa,
/// the rms speed in m/s, and the smallest over the largest of its principal second moments' roots.
struct Rest {
    centre: f64,
    pressure: f64,
    speed: f64,
    roundness: f64,
}

fn rest(particles: &Particles, radius: f64) -> Rest {
    let n = particles.positions.len() as f64;
    let mut centre = [0.0; 3];
    for p in &particles.positions {
        (0..3).for_each(|axis| centre[axis] += f64::from(p[axis]) / n);
    }
    let from_centre =
        |p: &[f32; 3]| std::array::from_fn::<f64, 3, _>(|axis| f64::from(p[axis]) - centre[axis]);
    let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let inner: Vec<f64> = particles
        .positions
        .iter()
        .zip(&particles.pressures)
        .filter(|(p, _)| length(from_centre(p)) < 0.5 * radius)
        .map(|(_, &pressure)| f64::from(pressure))
        .collect();
    let squares: f64 = particles.velocities.iter().map(|v| length(v.map(f64::from)).powi(2)).sum();
    let mut moments = [0.0; 3];
    for p in &particles.positions {
        let d = from_centre(p);
        (0..3).for_each(|axis| moments[axis] += d[axis] * d[axis]);
    }
    let [low, high] = [f64::min, f64::max].map(|f| moments.iter().copied().reduce(f).unwrap_or(0.0).sqrt());
    Rest {
        centre: length(centre),
        pressure: inner.iter().sum::<f64>() / inner.len() as f64,
        speed: (squares / n).sqrt(),
        roundness: low / high,
    }
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
