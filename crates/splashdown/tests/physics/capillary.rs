//! A standing capillary wave without gravity: omega^2 = sigma k^3 tanh(k d) / rho (Lamb 1932, art. 266).
//!
//! As the [gravity wave](super::waves), it starts as a level surface with the velocities of the potential. A tank of
//! half a wave length in a slab six spacings thick contains the first mode, which shifts the centre of mass along the tank.
//! The pressure under a trough is negative, so that `dfsph`, which has none, cannot show such a wave: the water opens voids,
//! whose films contract and throw drops against the lid.

use std::f64::consts::TAU;

use splashdown::{Simulation, sample};

use super::cases::{CONTROL, Case, Variant};
use super::figures::{Figures, Series};
use super::{executor, scene};

/// Tension in N/m and density in kg/m^3 of water, and the spacing in m.
const TENSION: f64 = 0.0727;
const DENSITY: f64 = 1000.0;
const SPACING: f64 = 0.0005;
/// The amplitude over the wave length without damping.
const STEEPNESS: f64 = 0.04;
/// The duration in periods.
const DURATION: f64 = 2.2;

const ENGINEERING: &str = "accuracy = \"engineering\"";

static CASE: Case = Case {
    name: "capillary wave",
    across: "wave length",
    sizes: &[20, 40, 80],
    variants: &[
        Variant::new("engineering", ENGINEERING),
        Variant::extra("dfsph", "method = \"dfsph\""),
        CONTROL,
    ],
};
pub const CASES: &[&Case] = &[&CASE];

struct Wave {
    /// The centre of mass along the tank, from its middle.
    curve: Series,
    /// The period of the theory in s for `TENSION`.
    period: f64,
}

impl Wave {
    /// Spacings per wave length, keys of the solver, and the tension in N/m.
    fn run(across: u32, keys: &str, tension: f64) -> Self {
        let length = f64::from(across) * SPACING;
        let (wide, depth, thick) = (0.5 * length, 0.5 * length, 6.0 * SPACING);
        let k = TAU / length;
        let omega = (TENSION * k.powi(3) * (k * depth).tanh() / DENSITY).sqrt();
        let scene = scene(&format!(
            "[scene]\nname = \"ripple\"\nduration = 10\ngravity = [0, 0, 0]\n[domain]\nmin = [0, 0, 0]\n\
             max = [{wide}, {}, {thick}]\n[fluid]\nparticle_spacing = {SPACING}\nviscosity = 1e-6\n\
             surface_tension = {tension}\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [{wide}, {depth}, {thick}]\n\
             [solver]\n{keys}\nsurface_tension = \"csf\"\n",
            2.0 * depth
        ));
        let mut particles = sample::particles(&scene).unwrap();
        let amplitude = STEEPNESS * length * omega / (k * depth).sinh();
        for (x, v) in particles.positions.iter().zip(&mut particles.velocities) {
            let (x, y) = (f64::from(x[0]), f64::from(x[1]));
            *v = [
                (-amplitude * (k * y).cosh() * (k * x).sin()) as f32,
                (amplitude * (k * y).sinh() * (k * x).cos()) as f32,
                0.0,
            ];
        }
        let mut simulation = Simulation::with_particles(&scene, executor(), &particles).unwrap();
        let (period, samples) = (TAU / omega, 60.0);
        let mut curve = vec![(0.0, 0.0)];
        for _ in 0..(DURATION * samples) as u32 {
            let stats = simulation.advance((period / samples) as f32).unwrap();
            assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
            let particles = simulation.particles().unwrap();
            let sum: f64 = particles.positions.iter().map(|x| f64::from(x[0])).sum();
            curve.push((stats.time, sum / particles.positions.len() as f64 - 0.5 * wide));
        }
        Self { curve, period }
    }

    /// The period over that of the theory, minus one, by the zeros after the start. A wave that does not come back has a
    /// period of at least twice the duration.
    fn error(&self) -> f64 {
        let zeros: Vec<f64> = self
            .curve
            .windows(2)
            .skip(1)
            .filter(|pair| pair[0].1 * pair[1].1 < 0.0)
            .map(|pair| pair[0].0 + (pair[1].0 - pair[0].0) * pair[0].1 / (pair[0].1 - pair[1].1))
            .collect();
        let half = zeros.last().map_or(DURATION * self.period, |last| last / zeros.len() as f64);
        2.0 * half / self.period - 1.0
    }

    /// The height lost per period, by the first two extremes.
    fn loss(&self) -> f64 {
        let highest = |from: f64, to: f64| {
            let part = self.curve.iter().filter(|(t, _)| (from..to).contains(&(t / self.period)));
            part.map(|(_, x)| x.abs()).fold(0.0, f64::max)
        };
        1.0 - (highest(0.5, 1.0) / highest(0.0, 0.5)).powi(2)
    }
}

#[test]
fn a_capillary_wave_has_the_period_of_theory() {
    CASE.run(|variant, across, figures| {
        let wave = Wave::run(across, variant.keys, TENSION);
        figures.error("relative error of the period", wave.error());
        figures.report("loss of height per period", wave.loss());
        let first = wave.curve[15].1;
        let theory = |t: f64| (t, first * (TAU * t / wave.period).sin());
        let exact: Series = wave.curve.iter().map(|&(t, _)| theory(t)).collect();
        let title = "Centre of mass (dots: theory, undamped)";
        figures.plot(title, ["time, s", "x, m"], &exact, &wave.curve);
    });
}

#[test]
fn another_tension_of_a_wave_is_detected() {
    let mut figures = Figures::new(&CASE, CONTROL.name, 20);
    let error = Wave::run(20, ENGINEERING, 0.7 * TENSION).error();
    figures.measure("error of the period for 0.7 of the tension", error.abs());
    figures.close();
}
