//! A steady square jet on a plate, without gravity. The theorem of momentum gives the force, rho A U^2, if the plate turns
//! the jet by a right angle; Bernoulli gives the pressure rho U^2 / 2 at the stagnation point. The impulse
//! on the plate equals the momentum of the emitted particles that the fluid has lost.
//!
//! The plate is so large that the water has not reached its edge at the end: `continuity` with negative pressures follows the
//! edge downwards, and the force decreases by a tenth.
//!
//! The nozzle is a square, whose layers fill its area. A disc of eight spacings emits 37 particles per layer, which is 26 %
//! less than its area, because no particle extends beyond the edge.

use splashdown::Simulation;

use super::cases::{Case, Variant};
use super::figures::Series;
use super::{executor, scene, velocity_sum};

/// Edge of the jet in m, and its speed in m/s.
const EDGE: f64 = 0.1;
const SPEED: f64 = 1.0;

static CASE: Case = Case {
    name: "jet on a plate",
    across: "edge",
    sizes: &[8, 12, 16],
    variants: &[
        Variant::new("continuity", "density = \"continuity\"\nsound_speed = 10"),
        Variant::extra("engineering", "accuracy = \"engineering\"\nsound_speed = 10"),
        Variant::new("summation", "density = \"summation\"\nsound_speed = 10"),
        Variant::extra("dfsph", "method = \"dfsph\""),
    ],
};
pub const CASES: &[&Case] = &[&CASE];

#[test]
fn a_jet_pushes_a_plate_by_its_momentum() {
    CASE.run(|variant, across, figures| {
        let spacing = EDGE / f64::from(across);
        let scene = scene(&format!(
            "[scene]\nname = \"jet\"\nduration = 1\ngravity = [0, 0, 0]\n[domain]\nmin = [-0.6, -0.2, -0.6]\n\
             max = [0.6, 0.5, 0.6]\nopen = [\"x_min\", \"x_max\", \"y_min\", \"y_max\", \"z_min\", \"z_max\"]\n\
             [fluid]\nparticle_spacing = {spacing}\n[[emitter]]\nname = \"nozzle\"\nshape = \"rectangle\"\nsize = [{}, {}]\n\
             position = [0, 0.2, 0]\ndirection = [0, -1, 0]\nspeed = {SPEED}\n[solver]\n{}\n\
             [[body]]\nname = \"plate\"\nmesh = \"cube\"\nscale = [1.1, 0.05, 1.1]\nposition = [0, -0.025, 0]\n\
             [[probe]]\nname = \"plate\"\nquantity = \"force\"\nbody = \"plate\"\n\
             [[probe]]\nname = \"centre\"\nquantity = \"pressure\"\nposition = [0, {}, 0]\n",
            EDGE,
            EDGE,
            variant.keys,
            0.5 * spacing,
        ));
        let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
        let mass = f64::from(simulation.params().particle_mass);
        let (mut forces, mut pressures) = (Series::new(), Series::new());
        let (mut impulse, mut last) = (0.0, 0.0);
        for _ in 0..32 {
            let stats = simulation.advance(0.02).unwrap();
            assert_eq!(stats.non_finite, 0, "{stats:?}");
            let rows = simulation.take_probe_rows();
            for row in &rows[0] {
                // Rows are means since the previous row. The force on the plate points downwards.
                impulse -= row[2] * (row[0] - last);
                last = row[0];
                forces.push((row[0], -row[2]));
            }
            pressures.extend(rows[1].iter().map(|row| (row[0], row[1])));
        }
        // The jet is steady two edges over U after its impact.
        let late = |series: &Series| {
            let late: Vec<f64> = series.iter().filter(|p| p.0 > 0.44).map(|p| p.1).collect();
            late.iter().sum::<f64>() / late.len() as f64
        };
        let exact = 1000.0 * EDGE.powi(2) * SPEED.powi(2);
        let ratio = late(&forces) / exact;
        figures.error("force over rho A U^2, minus one", ratio - 1.0);
        figures.measure("the same for 1.2 times the area, difference", (ratio / 1.2 - 1.0).abs());
        let particles = simulation.particles().unwrap();
        // The first splash is faster than the jet; the particles of it that leave the domain move along the plate.
        let stats = simulation.stats();
        let emitted = stats.emitted as f64;
        let lost = mass * (emitted * SPEED + velocity_sum(&particles).y);
        figures.report("particles that left the domain over emitted ones", stats.escaped as f64 / emitted);
        figures.error("impulse over the momentum lost, minus one", impulse / lost - 1.0);
        let stagnation = late(&pressures) / (500.0 * SPEED.powi(2));
        figures.measure("pressure at the centre over rho U^2 / 2", stagnation);
        let line = vec![(0.0, exact), (0.64, exact)];
        figures.plot("Force on the plate (dots: rho A U^2)", ["time, s", "force, N"], &line, &forces);
    });
}
