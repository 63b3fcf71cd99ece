//! A steady planar jet on the floor, without gravity. The free-streamline theory (Milne-Thomson, Theoretical Hydrodynamics)
//! gives the speed q U along the floor at a distance x from the axis of a jet of width b,
//! x / b = (2 atan q + ln((1 + q) / (1 - q))) / pi, and the pressure (1 - q^2) rho U^2 / 2.
//!
//! A slab six spacings thick represents two dimensions. Gauges stand half a spacing above the floor.

use splashdown::Simulation;

use super::cases::{Case, Variant};
use super::figures::Series;
use super::{executor, scene};

/// Width of the jet in m, and its speed in m/s.
const WIDTH: f64 = 0.1;
const SPEED: f64 = 1.0;
/// Distance of the gauges over the width of the jet, and their number on each side of the axis.
const STEP: f64 = 0.1;
const GAUGES: i32 = 20;

static CASE: Case = Case {
    name: "planar jet",
    across: "width",
    sizes: &[8, 16, 24],
    variants: &[
        Variant::new("continuity", "density = \"continuity\"\nsound_speed = 10"),
        Variant::new("dfsph", "method = \"dfsph\""),
        Variant::extra("engineering", "accuracy = \"engineering\"\nsound_speed = 10"),
        Variant::extra("summation", "density = \"summation\"\nsound_speed = 10"),
    ],
};
pub const CASES: &[&Case] = &[&CASE];

/// The pressure over rho U^2 / 2 at a distance from the axis, over the width.
fn theory(x: f64) -> f64 {
    let distance = |q: f64| (2.0 * q.atan() + ((1.0 + q) / (1.0 - q)).ln()) / std::f64::consts::PI;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if distance(middle) < x.abs() { low = middle } else { high = middle }
    }
    1.0 - low * low
}

#[test]
fn the_pressure_under_a_jet_is_that_of_a_free_streamline() {
    CASE.run(|variant, across, figures| {
        let spacing = WIDTH / f64::from(across);
        let thick = 6.0 * spacing;
        let gauges: Vec<f64> = (-GAUGES..=GAUGES).map(|n| STEP * f64::from(n)).collect();
        let probes: String = gauges
            .iter()
            .enumerate()
            .map(|(k, x)| {
                let (x, y, z) = (WIDTH * x, 0.5 * spacing, 0.5 * thick);
                format!("[[probe]]\nname = \"g{k}\"\nquantity = \"pressure\"\nposition = [{x}, {y}, {z}]\n")
            })
            .collect();
        let scene = scene(&format!(
            "[scene]\nname = \"jet\"\nduration = 1.2\ngravity = [0, 0, 0]\n[domain]\nmin = [-0.5, 0, 0]\n\
             max = [0.5, 0.4, {thick}]\nopen = [\"x_min\", \"x_max\", \"y_max\"]\n[fluid]\nparticle_spacing = {spacing}\n\
             [[emitter]]\nname = \"nozzle\"\nshape = \"rectangle\"\nsize = [{WIDTH}, {thick}]\n\
             position = [0, 0.3, {}]\ndirection = [0, -1, 0]\nspeed = {SPEED}\n[solver]\n{}\n{probes}",
            0.5 * thick,
            variant.keys,
        ));
        let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
        let mut sums = vec![(0.0, 0.0); gauges.len()];
        for frame in 1..=60 {
            let stats = simulation.advance(0.02).unwrap();
            assert_eq!(stats.non_finite, 0, "{stats:?}");
            let rows = simulation.take_probe_rows();
            // The jet meets the floor at 0.3 s and is steady three widths over U later.
            if f64::from(frame) * 0.02 > 0.6 {
                for (sum, rows) in sums.iter_mut().zip(&rows) {
                    sum.0 += rows.iter().map(|row| row[1]).sum::<f64>();
                    sum.1 += rows.len() as f64;
                }
            }
        }
        let means: Vec<f64> = sums.iter().map(|sum| sum.0 / sum.1 / (500.0 * SPEED.powi(2))).collect();
        let exact: Vec<f64> = gauges.iter().map(|x| theory(*x)).collect();
        let rms = |a: &[f64], scale: f64| {
            let sum: f64 = a.iter().zip(&exact).map(|(a, b)| (scale * a - b).powi(2)).sum();
            (sum / a.len() as f64).sqrt()
        };
        figures.error("rms error of the profile over rho U^2 / 2", rms(&means, 1.0));
        figures.measure("the same for 1.3 times the pressure", rms(&means, 1.3));
        let load = means.iter().sum::<f64>() / exact.iter().sum::<f64>();
        figures.error("load by the gauges over theory, minus one", load - 1.0);
        figures.measure("pressure on the axis over rho U^2 / 2", means[GAUGES as usize]);
        // The mean over a support radius of two spacings on both sides.
        let reach = (2.0 / f64::from(across) / STEP).round() as usize;
        let around = &means[GAUGES as usize - reach..=GAUGES as usize + reach];
        let around_exact = &exact[GAUGES as usize - reach..=GAUGES as usize + reach];
        let gauge = means[GAUGES as usize] / around.iter().sum::<f64>() * around_exact.iter().sum::<f64>();
        figures.error("gauge on the axis over the mean around it, minus one", gauge - 1.0);
        let points = |values: &[f64]| -> Series { gauges.iter().copied().zip(values.iter().copied()).collect() };
        let title = "Pressure along the floor over rho U^2 / 2 (dots: theory)";
        figures.plot(title, ["distance from the axis over the width", "pressure"], &points(&exact), &points(&means));
    });
}
