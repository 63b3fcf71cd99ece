//! A standing wave in a tank: linear theory gives its frequency, omega^2 = g k tanh(k h), and Lamb (1932, art. 348) the
//! decay of its height by viscosity, exp(-2 nu k^2 t) without friction at the walls.
//!
//! The wave starts as a level surface with the velocities of the potential, so that the particles form a lattice. A slab
//! six spacings thick represents two dimensions. The first mode shifts the centre of mass along the tank in proportion
//! to its height.

use splashdown::{Simulation, sample};

use super::cases::{CONTROL, Case, Variant, is_validation};
use super::executor;
use super::figures::{Figures, Series};
use super::scene;

const GRAVITY: f64 = 9.81;
/// Length and depth of the water in metres.
const LENGTH: f64 = 1.0;
const DEPTH: f64 = 0.5;
/// Height of the wave over the depth.
const STEEPNESS: f64 = 0.04;

struct Wave {
    /// Spacings across the depth.
    across: u32,
    /// Kinematic viscosity in m^2/s.
    viscosity: f64,
    solver: &'static str,
    periods: f64,
}

/// The period and the loss of height per period, both by the zeros and the extremes of the centre of mass.
struct Measured {
    period: f64,
    loss: f64,
    curve: Series,
}

fn wave_number() -> f64 {
    std::f64::consts::PI / LENGTH
}

fn frequency() -> f64 {
    (GRAVITY * wave_number() * (wave_number() * DEPTH).tanh()).sqrt()
}

impl Wave {
    fn measure(&self) -> Measured {
        let spacing = DEPTH / f64::from(self.across);
        let thick = 6.0 * spacing;
        let scene = scene(&format!(
            r#"
            [scene]
            name = "wave"
            duration = 10
            [domain]
            min = [0, 0, 0]
            max = [{LENGTH}, {}, {thick}]
            open = ["y_max"]
            [fluid]
            particle_spacing = {spacing}
            viscosity = {}
            [[fluid.block]]
            position = [0, 0, 0]
            size = [{LENGTH}, {DEPTH}, {thick}]
            [solver]
            {}
            "#,
            1.3 * DEPTH,
            self.viscosity,
            self.solver
        ));
        let mut particles = sample::particles(&scene).unwrap();
        sample::start_at_rest(&scene, &mut particles, &[]);
        let (k, omega) = (wave_number(), frequency());
        let amplitude = STEEPNESS * DEPTH * omega / (k * DEPTH).sinh();
        for (x, v) in particles.positions.iter().zip(&mut particles.velocities) {
            let (x, y) = (f64::from(x[0]), f64::from(x[1]));
            *v = [
                (-amplitude * (k * y).cosh() * (k * x).sin()) as f32,
                (amplitude * (k * y).sinh() * (k * x).cos()) as f32,
                0.0,
            ];
        }
        let mut simulation = Simulation::with_particles(&scene, executor(), &particles).unwrap();
        let (period, samples) = (std::f64::consts::TAU / omega, 80.0);
        let mut curve = vec![(0.0, 0.0)];
        for _ in 0..(self.periods * samples) as u32 {
            let stats = simulation.advance((period / samples) as f32).unwrap();
            assert_eq!((stats.escaped, stats.non_finite, stats.wall_corrections), (0, 0, 0), "{stats:?}");
            let particles = simulation.particles().unwrap();
            let sum: f64 = particles.positions.iter().map(|x| f64::from(x[0])).sum();
            curve.push((stats.time, sum / particles.positions.len() as f64 - 0.5 * LENGTH));
        }
        analyse(curve)
    }
}

/// The period and the loss per period of a decaying oscillation that starts at zero.
fn analyse(curve: Series) -> Measured {
    let mut zeros = vec![0.0];
    let mut extremes: Vec<f64> = Vec::new();
    let mut largest = 0.0_f64;
    for pair in curve.windows(2).skip(1) {
        let ((t0, a), (t1, b)) = (pair[0], pair[1]);
        largest = largest.max(b.abs());
        if a * b < 0.0 {
            zeros.push(t0 + (t1 - t0) * a / (a - b));
            extremes.push(largest);
            largest = 0.0;
        }
    }
    let halves = (zeros.len() - 1) as f64;
    let period = 2.0 * zeros[zeros.len() - 1] / halves;
    let (first, last) = (extremes[0], extremes[extremes.len() - 1]);
    let loss = 1.0 - (last / first).powf(2.0 / (extremes.len() - 1) as f64);
    Measured { period, loss, curve }
}

/// A wave must not grow either.
static CASE: Case = Case {
    name: "standing wave",
    across: "depth",
    sizes: &[20, 28, 40],
    variants: &[
        Variant::new("continuity", "density = \"continuity\""),
        Variant::extra("engineering", "accuracy = \"engineering\""),
        Variant::extra("summation", "density = \"summation\""),
        Variant::extra("dfsph", "method = \"dfsph\""),
        Variant::extra("dfsph, support 3", "method = \"dfsph\"\nsupport_ratio = 3"),
        CONTROL,
    ],
};
/// The same wave in a liquid for which Lamb's theory predicts a loss of 5 % per period.
static VISCOUS: Case = Case {
    name: "viscous wave",
    across: "depth",
    sizes: &[20, 28, 40],
    variants: &[
        Variant::new("continuity", "density = \"continuity\""),
        Variant::extra("engineering", "accuracy = \"engineering\""),
        Variant::extra("summation", "density = \"summation\""),
        Variant::extra("dfsph", "method = \"dfsph\""),
        Variant::extra("dfsph, support 3", "method = \"dfsph\"\nsupport_ratio = 3"),
    ],
};
pub const CASES: &[&Case] = &[&CASE, &VISCOUS];

/// The loss of height per period in the viscous case.
const LOSS: f64 = 0.05;

impl Measured {
    /// The relative error of the period.
    fn period_error(&self) -> f64 {
        self.period * frequency() / std::f64::consts::TAU - 1.0
    }
}

#[test]
fn a_standing_wave_keeps_its_height_and_its_period() {
    let periods = if is_validation() { 3.1 } else { 1.6 };
    CASE.run(|variant, across, figures| {
        let measured = Wave { across, viscosity: 1e-6, solver: variant.keys, periods }.measure();
        figures.error("loss of height per period", measured.loss);
        figures.error("relative error of the period", measured.period_error());
        let theory = |t: f64| measured.curve[20].1 * (frequency() * t).sin();
        let exact: Series = measured.curve.iter().map(|&(t, _)| (t, theory(t))).collect();
        let title = "Centre of mass (dots: linear theory)";
        figures.plot(title, ["time, s", "x, m"], &exact, &measured.curve);
    });
}

#[test]
fn a_viscous_wave_decays_as_lamb_predicts() {
    let period = std::f64::consts::TAU / frequency();
    let viscosity = -(1.0 - LOSS).ln() / (2.0 * wave_number().powi(2) * period);
    let periods = if is_validation() { 3.1 } else { 1.6 };
    VISCOUS.run(|variant, across, figures| {
        let measured = Wave { across, viscosity, solver: variant.keys, periods }.measure();
        figures.error("loss of height per period over theory, minus one", measured.loss / LOSS - 1.0);
        figures.measure("the same for 1.3 nu, difference", (measured.loss / (1.3 * LOSS) - 1.0).abs());
        figures.error("relative error of the period", measured.period_error());
    });
}

#[test]
fn artificial_viscosity_is_detected() {
    let mut figures = Figures::new(&CASE, "control", 10);
    let solver = "density = \"continuity\"\nartificial_viscosity = 0.1";
    let wave = Wave { across: 10, viscosity: 1e-6, solver, periods: 1.6 };
    figures.measure("loss of height per period, artificial viscosity 0.1", wave.measure().loss);
    figures.close();
}
