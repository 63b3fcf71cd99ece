//! Water in a tank that is shaken sideways, against linear theory and two experiments.
//!
//! *Linear theory* (Faltinsen, J. Ship Res. 22 (1978) 224-241). The tank is at A cos(omega t) and the water is at rest at
//! t = 0. In its frame the water feels A omega^2 cos(omega t). Every odd mode n is a forced oscillator with omega_n^2 =
//! g k_n tanh(k_n h), so that the centre of mass is at
//! x(t) = sum 8 A omega^2 omega_n^2 L^2 / (g h n^4 pi^4 (omega_n^2 - omega^2)) (cos(omega t) - cos(omega_n t)).
//!
//! *Finite depth.* O. Faltinsen, O. Rognebakke, I. Lukovsky and A. Timokha, J. Fluid Mech. 407 (2000) 201-234: a tank of
//! 1.73 m with 0.6 m of water, shaken with 32 mm and a period of 1.3 s. The gauge is 0.05 m from the wall at small x. Linear
//! theory shows that the record starts with the tank at its largest displacement: with this phase it agrees best, and with
//! others not at all. The domain therefore rests for a quarter of a period, and is then shaken as A sin(omega t).
//!
//! *Shallow water.* B. Bouscasse, M. Antuono, A. Colagrossi and C. Lugni, Int. J. Nonlinear Sci. Numer. Simul. 14 (2013)
//! 123-138, series 5: 0.03 m of water in a tank of 1 m, shaken with 70 mm at 1.231 times the first natural frequency. A bore
//! travels between the walls. The record begins after 8.5 periods.
//!
//! The records are those of PySPH and are not part of the repository. The elevation at a gauge is a mean with a triangular
//! weight three spacings to each side, and with the reflected triangle at the wall; on a lattice it is exact. A slab six
//! spacings thick represents two dimensions.

use std::f64::consts::{PI, TAU};
use std::path::PathBuf;

use splashdown::{Simulation, sample};

use super::cases::{CONTROL, Case, Variant, is_validation};
use super::figures::{Figures, Series};
use super::{executor, scene};

const GRAVITY: f64 = 9.81;
/// Distance of the gauges from the wall in m.
const GAUGE: f64 = 0.05;

/// A tank, its water and its motion.
#[derive(Clone, Copy)]
struct Tank {
    length: f64,
    depth: f64,
    amplitude: f64,
    period: f64,
}

const FALTINSEN: Tank = Tank { length: 1.73, depth: 0.6, amplitude: 0.032, period: 1.3 };
/// The same tank with so small a motion that linear theory holds.
const SMALL: Tank = Tank { amplitude: 0.002, ..FALTINSEN };

const ENGINEERING: &str = "engineering";

static LINEAR: Case = Case {
    name: "sloshing, linear",
    across: "length",
    sizes: &[29, 49, 75],
    variants: &[
        Variant::new(ENGINEERING, "accuracy = \"engineering\""),
        Variant::extra("continuity", "density = \"continuity\""),
        Variant::extra("dfsph", "method = \"dfsph\""),
        Variant::extra("dfsph, support 3", "method = \"dfsph\"\nsupport_ratio = 3"),
    ],
};
static FINITE: Case = Case {
    name: "sloshing, finite depth",
    across: "length",
    sizes: &[49, 75, 101],
    variants: &[
        Variant::new("dfsph", "method = \"dfsph\""),
        Variant::extra("dfsph, support 3", "method = \"dfsph\"\nsupport_ratio = 3"),
        Variant::extra("engineering", "accuracy = \"engineering\""),
        CONTROL,
    ],
};
static SHALLOW: Case = Case {
    name: "sloshing, shallow water",
    across: "depth",
    sizes: &[4, 6, 8],
    variants: &[
        Variant::extra("dfsph", "method = \"dfsph\""),
        Variant::extra("dfsph, support 3", "method = \"dfsph\"\nsupport_ratio = 3"),
    ],
};
pub const CASES: &[&Case] = &[&LINEAR, &FINITE, &SHALLOW];

/// The elevation at the gauge and the centre of mass relative to the middle of the tank, in m.
struct Motion {
    elevation: Series,
    center: Series,
}

impl Tank {
    fn wave_number(&self, mode: f64) -> f64 {
        mode * PI / self.length
    }

    fn natural(&self, mode: f64) -> f64 {
        let k = self.wave_number(mode);
        (GRAVITY * k * (k * self.depth).tanh()).sqrt()
    }

    fn frequency(&self) -> f64 {
        TAU / self.period
    }

    /// The centre of mass by linear theory, at a time after the start at the largest displacement.
    fn center(&self, time: f64) -> f64 {
        let omega = self.frequency();
        let mode = |n: f64| {
            let own = self.natural(n);
            let factor = 8.0 * self.amplitude * (omega * own * self.length).powi(2)
                / (GRAVITY * self.depth * (n * PI).powi(4) * (own.powi(2) - omega.powi(2)));
            factor * ((omega * time).cos() - (own * time).cos())
        };
        (0..20).map(|k| mode(f64::from(2 * k + 1))).sum()
    }

    /// Shakes the tank for some seconds, from the largest displacement or from the middle, where the water does not move at
    /// first while the tank does.
    fn shake(&self, spacing: f64, solver: &str, from_middle: bool, seconds: f64) -> Motion {
        let (length, thick) = (self.length, 6.0 * spacing);
        // Whole layers; the depths of the cases differ from them by 0.6 % at most.
        let depth = (self.depth / spacing).round() * spacing;
        let mut scene = scene(&format!(
            "[scene]\nname = \"sloshing\"\nduration = 60\n[domain]\nmin = [0, 0, 0]\nmax = [{length}, {}, {thick}]\n\
             open = [\"y_max\"]\noscillation = {{ amplitude = [{}, 0, 0], period = {} }}\n[fluid]\n\
             particle_spacing = {spacing}\nviscosity = 1e-6\n[[fluid.block]]\nposition = [0, 0, 0]\n\
             size = [{length}, {depth}, {thick}]\n[solver]\n{solver}\n",
            depth + 0.3 * length,
            self.amplitude,
            self.period,
        ));
        let shaken = scene.clone();
        if !from_middle {
            scene.domain.oscillation = None;
        }
        let mut particles = sample::particles(&scene).unwrap();
        sample::start_at_rest(&scene, &mut particles, &[]);
        if from_middle {
            particles.velocities.fill([-(self.amplitude * self.frequency()) as f32, 0.0, 0.0]);
        }
        let mut simulation = Simulation::with_particles(&scene, executor(), &particles).unwrap();
        let mut start = 0.0;
        if !from_middle {
            start = simulation.advance((0.25 * self.period) as f32).unwrap().time;
            assert!(simulation.update_parameters(&shaken).unwrap());
        }
        let gauge = |simulation: &mut Simulation| {
            let particles = simulation.particles().unwrap();
            let x = || particles.positions.iter().map(|x| f64::from(x[0]));
            let reach = 3.0 * spacing;
            let triangle = |distance: f64| (1.0 - distance.abs() / reach).max(0.0) / reach;
            let weights: f64 = x().map(|x| triangle(x - GAUGE) + triangle(x + GAUGE)).sum();
            let center = x().sum::<f64>() / particles.positions.len() as f64 - 0.5 * length;
            (weights * spacing.powi(3) / thick, center)
        };
        let (level, middle) = gauge(&mut simulation);
        let mut motion = Motion { elevation: vec![(0.0, 0.0)], center: vec![(0.0, 0.0)] };
        let step = self.period / 65.0;
        for _ in 0..(seconds / step).ceil() as u32 {
            let stats = simulation.advance(step as f32).unwrap();
            assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
            let (height, center) = gauge(&mut simulation);
            motion.elevation.push((stats.time - start, height - level));
            motion.center.push((stats.time - start, center - middle));
        }
        motion
    }
}

fn at(series: &Series, t: f64) -> f64 {
    let k = series.partition_point(|&(time, _)| time < t).clamp(1, series.len() - 1);
    let ((t0, v0), (t1, v1)) = (series[k - 1], series[k]);
    v0 + (v1 - v0) * (t - t0) / (t1 - t0)
}

/// The root mean square of a curve's error at the times of a record, if the record is late by some time.
fn error(simulated: &Series, record: &Series, late: f64) -> f64 {
    let squares = record.iter().map(|&(t, z)| (at(simulated, t - late) - z).powi(2));
    (squares.sum::<f64>() / record.len() as f64).sqrt()
}

/// The highest value between two times.
fn crest(series: &Series, from: f64, to: f64) -> f64 {
    series.iter().filter(|p| (from..to).contains(&p.0)).map(|p| p.1).fold(f64::NEG_INFINITY, f64::max)
}

/// A record of an experiment up to a time; none, with a message, if the file does not exist.
fn record(name: &str, until: f64) -> Option<Series> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/experiments/sloshing");
    let Ok(text) = std::fs::read_to_string(folder.join(name)) else {
        eprintln!("SKIPPED: {name} does not exist");
        return None;
    };
    let row = |line: &str| -> (f64, f64) {
        let (time, elevation) = line.split_once(',').unwrap();
        (time.parse().unwrap(), elevation.parse().unwrap())
    };
    let rows: Series = text.lines().filter(|line| !line.starts_with('#')).map(row).collect();
    assert!(rows.len() > 60, "{name}: {}", rows.len());
    Some(rows.into_iter().filter(|p| p.0 < until).collect())
}

/// The error over the largest measured elevation, that over the standard deviation of the record, and the best time shift.
fn compare(figures: &mut Figures, simulated: &Series, record: &Series, period: f64) {
    let largest = crest(record, 0.0, f64::INFINITY);
    let count = record.len() as f64;
    let mean = record.iter().map(|p| p.1).sum::<f64>() / count;
    let spread = (record.iter().map(|p| (p.1 - mean).powi(2)).sum::<f64>() / count).sqrt();
    let rms = error(simulated, record, 0.0);
    figures.error("rms error over the highest crest", rms / largest);
    figures.report("rms error over the standard deviation", rms / spread);
    let shifts = (-60..=60).map(|k| f64::from(k) / 400.0);
    let best = shifts.map(|shift| (error(simulated, record, -shift * period), shift));
    let (rest, shift) = best.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    figures.error("best time shift over the period", shift);
    figures.report("rms error over the highest crest, shifted", rest / largest);
}

#[test]
fn a_weakly_shaken_tank_follows_linear_theory() {
    LINEAR.run(|variant, across, figures| {
        let motion = SMALL.shake(SMALL.length / f64::from(across), variant.keys, false, 4.0);
        let theory = |tank: Tank| motion.center.iter().map(|&(t, _)| (t, tank.center(t))).collect::<Series>();
        let deviation = |exact: &Series| {
            let square = |series: &Series| series.iter().map(|p| p.1.powi(2)).sum::<f64>();
            let wrong = motion.center.iter().zip(exact).map(|(a, b)| (a.1 - b.1).powi(2)).sum::<f64>();
            (wrong / square(exact)).sqrt()
        };
        let exact = theory(SMALL);
        figures.error("deviation of the centre of mass", deviation(&exact));
        let highest = |series: &Series| crest(series, 0.0, f64::INFINITY);
        figures
            .error("highest crest over theory, minus one", highest(&motion.center) / highest(&exact) - 1.0);
        // Control: a period that is wrong by a twentieth. The other variants deviate by more with the right one.
        if variant.name == ENGINEERING {
            let wrong = deviation(&theory(Tank { period: 1.05 * SMALL.period, ..SMALL }));
            figures.measure("deviation for 1.05 times the period", wrong);
        }
        let axes = ["time, s", "x, m"];
        figures.plot("Centre of mass (dots: linear theory)", axes, &exact, &motion.center);
    });
}

/// How much of the record of finite depth is compared, in s.
fn compared() -> f64 {
    if is_validation() { 9.9 } else { 5.2 }
}

#[test]
fn water_of_finite_depth_sloshes_as_in_the_experiment() {
    let Some(record) = record("sloshing_faltinsen.csv", compared()) else { return };
    FINITE.run(|variant, across, figures| {
        let spacing = FALTINSEN.length / f64::from(across);
        let motion = FALTINSEN.shake(spacing, variant.keys, false, compared() + 0.2);
        let simulated = &motion.elevation;
        compare(figures, simulated, &record, FALTINSEN.period);
        for (name, from, to) in [("first", 0.6, 1.6), ("second", 2.2, 3.0)] {
            let ratio = crest(simulated, from, to) / crest(&record, from, to);
            figures.measure(format!("{name} crest over the measured one"), ratio);
        }
        let axes = ["time, s", "elevation, m"];
        figures.plot("Elevation 0.05 m from the wall (dots: measured)", axes, &record, simulated);
    });
}

#[test]
fn another_period_is_detected() {
    if !is_validation() {
        eprintln!("SKIPPED: the control of the sloshing tank takes a minute; run `cargo xtask validate`");
        return;
    }
    let Some(record) = record("sloshing_faltinsen.csv", 5.2) else { return };
    let mut figures = Figures::new(&FINITE, CONTROL.name, 49);
    let tank = Tank { period: 1.1 * FALTINSEN.period, ..FALTINSEN };
    let solver = "method = \"dfsph\"\nsupport_ratio = 3";
    let motion = tank.shake(FALTINSEN.length / 49.0, solver, false, 5.4);
    let largest = crest(&record, 0.0, 5.2);
    figures.measure("rms error for 1.1 times the period", error(&motion.elevation, &record, 0.0) / largest);
    figures.close();
}

#[test]
fn a_bore_in_shallow_water_travels_as_in_the_experiment() {
    if !is_validation() {
        eprintln!("SKIPPED: a bore needs eleven periods of three seconds; run `cargo xtask validate`");
        return;
    }
    let Some(record) = record("sloshing_bouscasse_5.csv", f64::INFINITY) else { return };
    let mut tank = Tank { length: 1.0, depth: 0.03, amplitude: 0.07, period: 0.0 };
    tank.period = TAU / (1.231 * tank.natural(1.0));
    SHALLOW.run(|variant, across, figures| {
        let spacing = tank.depth / f64::from(across);
        let motion = tank.shake(spacing, variant.keys, true, 11.2 * tank.period);
        let simulated: Series = motion.elevation.iter().map(|&(t, z)| (t / tank.period, z)).collect();
        compare(figures, &simulated, &record, 1.0);
        let late = crest(&simulated, 8.5, 11.0) / crest(&record, 8.5, 11.0);
        figures.measure("highest crest over the measured one", late);
        let seen: Series = simulated.into_iter().filter(|p| p.0 > 8.4).collect();
        let axes = ["time over the period", "elevation, m"];
        figures.plot("Elevation 0.05 m from the wall (dots: measured)", axes, &record, &seen);
    });
}
