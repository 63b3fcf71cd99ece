//! Tanks whose motion changes at once, in the frame of the tank: accelerated upwards, where p = rho (g + a) depth;
//! accelerated sideways, where the mean level is tilted by a / g; and stopped, where the water continues with the speed of
//! the tank.
//!
//! Linear theory gives the centre of mass x(t). A stop leaves the velocity potential U (x - L / 2) at the surface, where the
//! impulse of the pressure vanishes. Its modes n = 1, 3, 5 ... oscillate with omega_n^2 = g k_n tanh(k_n h), so that
//! x(t) = sum 8 U L^2 omega_n sin(omega_n t) / (n^4 pi^4 h g). A sudden acceleration -a of the tank is the integral of many
//! small stops: x(t) = sum 8 a L^2 (1 - cos(omega_n t)) / (n^4 pi^4 h g), whose mean is a L^2 / (12 h g).
//!
//! A slab six spacings thick represents two dimensions.

use std::f64::consts::{PI, TAU};

use splashdown::{Simulation, sample};

use super::cases::{Case, Variant};
use super::figures::Series;
use super::{executor, scene, vec};

const GRAVITY: f64 = 9.81;
/// Length and depth of the water in m.
const LENGTH: f64 = 1.0;
const DEPTH: f64 = 0.5;
/// The accelerations in m/s^2, and the speed in m/s of the tank that stops.
const UPWARDS: f64 = 0.5 * GRAVITY;
const SIDEWAYS: f64 = 0.05 * GRAVITY;
const STOPPED: f64 = 0.1;

const VARIANTS: &[Variant] = &[
    Variant::new("continuity", "density = \"continuity\""),
    Variant::new("engineering", "accuracy = \"engineering\""),
    Variant::extra("summation", "density = \"summation\""),
    Variant::extra("dfsph", "method = \"dfsph\""),
];
static UP: Case =
    Case { name: "tank accelerated upwards", across: "depth", sizes: &[10, 20, 40], variants: VARIANTS };
static ASIDE: Case =
    Case { name: "tank accelerated sideways", across: "depth", sizes: &[10, 20, 40], variants: VARIANTS };
static STOP: Case =
    Case { name: "tank stopped suddenly", across: "depth", sizes: &[10, 20, 40], variants: VARIANTS };
pub const CASES: &[&Case] = &[&UP, &ASIDE, &STOP];

/// Water at rest in a tank, whose speed changed by `speed` and which is accelerated from the start on: upwards by `up` and
/// to the left by `left`.
fn tank(across: u32, solver: &str, speed: f64, up: f64, left: f64) -> Simulation {
    let spacing = DEPTH / f64::from(across);
    let thick = 6.0 * spacing;
    let mut scene = scene(&format!(
        "[scene]\nname = \"accelerated\"\nduration = 10\n[domain]\nmin = [0, 0, 0]\nmax = [{LENGTH}, {}, {thick}]\n\
         open = [\"y_max\"]\n[fluid]\nparticle_spacing = {spacing}\nviscosity = 1e-6\n[[fluid.block]]\n\
         position = [0, 0, 0]\nsize = [{LENGTH}, {DEPTH}, {thick}]\n[solver]\n{solver}\n",
        1.4 * DEPTH
    ));
    let mut particles = sample::particles(&scene).unwrap();
    sample::start_at_rest(&scene, &mut particles, &[]);
    particles.velocities.fill([speed as f32, 0.0, 0.0]);
    let mut simulation = Simulation::with_particles(&scene, executor(), &particles).unwrap();
    scene.gravity.x = left as f32;
    scene.gravity.y = -(GRAVITY + up) as f32;
    assert!(simulation.update_parameters(&scene).unwrap());
    simulation
}

fn frequency(mode: f64) -> f64 {
    let k = mode * PI / LENGTH;
    (GRAVITY * k * (k * DEPTH).tanh()).sqrt()
}

/// The centre of mass, relative to the middle of the tank, of a sum of modes; `motion` depends on the frequency.
fn theory(motion: impl Fn(f64) -> f64) -> f64 {
    let mode =
        |n: f64| 8.0 * LENGTH.powi(2) / (n.powi(4) * PI.powi(4) * DEPTH * GRAVITY) * motion(frequency(n));
    (0..20).map(|k| mode(f64::from(2 * k + 1))).sum()
}

/// The centre of mass over two periods of the first mode.
fn follow(simulation: &mut Simulation) -> Series {
    let step = TAU / frequency(1.0) / 60.0;
    let mut curve = vec![(0.0, 0.0)];
    for _ in 0..120 {
        let stats = simulation.advance(step as f32).unwrap();
        assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
        let positions = simulation.particles().unwrap().positions;
        let mean = positions.iter().map(|&x| vec(x).x).sum::<f64>() / positions.len() as f64;
        curve.push((stats.time, mean - 0.5 * LENGTH));
    }
    curve
}

/// The root of the sum of the squared differences over that of the theory.
fn deviation(curve: &Series, theory: &Series) -> f64 {
    let square = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>();
    let wrong = square(&mut curve.iter().zip(theory).map(|(a, b)| a.1 - b.1));
    (wrong / square(&mut theory.iter().map(|p| p.1))).sqrt()
}

#[test]
fn pressure_follows_an_upward_acceleration() {
    UP.run(|variant, across, figures| {
        let mut simulation = tank(across, variant.keys, 0.0, UPWARDS, 0.0);
        // The step of the acceleration causes sound waves, which are averaged over many of their periods.
        simulation.advance(0.5).unwrap();
        let spacing = DEPTH / f64::from(across);
        let (mut floor, samples) = (0.0, 50);
        for _ in 0..samples {
            simulation.advance(0.01).unwrap();
            let particles = simulation.particles().unwrap();
            let low =
                particles.positions.iter().zip(&particles.pressures).filter(|(x, _)| vec(**x).y < spacing);
            let ratios: Vec<f64> = low.map(|(x, &p)| f64::from(p) / (1000.0 * (DEPTH - vec(*x).y))).collect();
            floor += ratios.iter().sum::<f64>() / ratios.len() as f64 / f64::from(samples);
        }
        figures.error(
            "pressure at the floor over rho (g + a) depth, minus one",
            floor / (GRAVITY + UPWARDS) - 1.0,
        );
        // Control: the pressure of a smaller acceleration.
        figures
            .measure("the same for g + a / 2, difference", (floor / (GRAVITY + 0.5 * UPWARDS) - 1.0).abs());
    });
}

#[test]
fn the_level_follows_a_sideways_acceleration() {
    ASIDE.run(|variant, across, figures| {
        let curve = follow(&mut tank(across, variant.keys, 0.0, 0.0, SIDEWAYS));
        let exact: Series =
            curve.iter().map(|&(t, _)| (t, SIDEWAYS * theory(|omega| 1.0 - (omega * t).cos()))).collect();
        let mean = |series: &Series| series.iter().map(|p| p.1).sum::<f64>() / series.len() as f64;
        let ratio = mean(&curve) / mean(&exact);
        figures.error("mean tilt over a / g, minus one", ratio - 1.0);
        figures.measure("the same for 1.2 a, difference", (ratio / 1.2 - 1.0).abs());
        figures.error("deviation of the centre of mass", deviation(&curve, &exact));
        figures.plot("Centre of mass (dots: linear theory)", ["time, s", "x, m"], &exact, &curve);
    });
}

#[test]
fn water_sloshes_in_a_tank_that_stops() {
    STOP.run(|variant, across, figures| {
        let curve = follow(&mut tank(across, variant.keys, STOPPED, 0.0, 0.0));
        let exact: Series =
            curve.iter().map(|&(t, _)| (t, STOPPED * theory(|omega| omega * (omega * t).sin()))).collect();
        let highest = |series: &Series| series[..60].iter().map(|p| p.1).fold(0.0, f64::max);
        let ratio = highest(&curve) / highest(&exact);
        figures.error("first maximum of the centre of mass over theory, minus one", ratio - 1.0);
        figures.measure("the same for 1.2 times the speed, difference", (ratio / 1.2 - 1.0).abs());
        figures.error("deviation of the centre of mass", deviation(&curve, &exact));
        figures.plot("Centre of mass (dots: linear theory)", ["time, s", "x, m"], &exact, &curve);
    });
}
