//! A box of rectangular section in a tank, released with a heel: the period of its roll on a hinge at the water level
//! against the experiment of Jung, Chang and Jo, "Viscous effect on the roll motion of a rectangular structure", J. Eng.
//! Mech. 132 (2006) 190-200.
//!
//! The box of the experiment is 0.3 m wide, 0.1 m high and half submerged, with a moment of inertia of 0.236 kg m^2 at a
//! length of 0.9 m. Its natural period of 0.93 s agrees with the hydrostatic stiffness, rho g (B^3 / 12 - B d^2 / 2) per
//! length, and an added inertia of 0.14 kg m. A uniform box on a hinge has the same inertia if its density is 1049 kg/m^3. A
//! slab four spacings thick represents two dimensions; the box leaves a tenth of a spacing free at its sides, for which its
//! density compensates. The tank is so long that reflected waves return after two periods.

use splashdown::scene::Scene;

use super::cases::{CONTROL, Case, Variant, is_validation};
use super::figures::{Figures, Series};
use super::scene;
use super::shapes::at_rest;

/// Breadth, height and draught of the box, and depth and length of the tank, in m.
const BREADTH: f64 = 0.3;
const HEIGHT: f64 = 0.1;
const DRAUGHT: f64 = 0.05;
const DEPTH: f64 = 0.4;
const LENGTH: f64 = 2.0;
/// The period of the experiment in s, and the inertia about the centre per length in kg m.
const PERIOD: f64 = 0.93;
const INERTIA: f64 = 0.236 / 0.9;

const CONTINUITY: &str = "density = \"continuity\"\nartificial_viscosity = 0.05";

static ROLL: Case = Case {
    name: "roll decay of a box",
    across: "draught",
    sizes: &[4, 6, 8],
    variants: &[
        Variant::extra("continuity", CONTINUITY),
        Variant::extra("engineering", "accuracy = \"engineering\""),
        Variant::extra("dfsph", "method = \"dfsph\""),
        CONTROL,
    ],
};
pub const CASES: &[&Case] = &[&ROLL];

/// A box of this density in kg/m^3 with its centre at the level and a heel of 15 degrees; `keys` are further ones of the body.
fn tank(solver: &str, across: u32, density: f64, keys: &str) -> Scene {
    let spacing = DRAUGHT / f64::from(across);
    let thick = 4.0 * spacing;
    let long = thick - 0.2 * spacing;
    scene(&format!(
        "[scene]\nname = \"roll\"\nduration = 4\n[domain]\nmin = [-{0}, 0, 0]\nmax = [{0}, {1}, {thick}]\n\
         open = [\"y_max\"]\n[fluid]\nparticle_spacing = {spacing}\nviscosity = 1e-6\n\
         [[fluid.block]]\nposition = [-{0}, 0, 0]\nsize = [{LENGTH}, {DEPTH}, {thick}]\n\
         [[body]]\nname = \"box\"\nmesh = \"cube\"\nscale = [{BREADTH}, {HEIGHT}, {long}]\n\
         position = [0, {DEPTH}, {2}]\nrotation = [0, 0, 15]\nmotion = \"dynamic\"\ndensity = {3}\n{keys}\n\
         [solver]\n{solver}\n",
        0.5 * LENGTH,
        1.5 * DEPTH,
        0.5 * thick,
        density * thick / long,
    ))
}

/// The heel in degrees over time.
fn heel(scene: &Scene, seconds: f64) -> Series {
    let mut simulation = at_rest(scene, |x| DEPTH as f32 - x.y);
    let mut heel = Series::new();
    for k in 1..=(seconds / 0.01).round() as u32 {
        let stats = simulation.advance(0.01).unwrap();
        assert_eq!((stats.non_finite, stats.escaped), (0, 0), "{stats:?}");
        let q = simulation.body_states().unwrap()[0].orientation;
        heel.push((0.01 * f64::from(k), f64::from(2.0 * q.z.atan2(q.w)).to_degrees()));
    }
    heel
}

/// The period by the zeros of the heel.
fn period(heel: &Series) -> f64 {
    let zeros: Vec<f64> = heel
        .windows(2)
        .filter(|pair| pair[0].1 * pair[1].1 < 0.0)
        .map(|pair| pair[0].0 + 0.01 * pair[0].1 / (pair[0].1 - pair[1].1))
        .collect();
    assert!(zeros.len() >= 3, "the box does not roll: {zeros:?}");
    2.0 * (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64
}

/// The roll on a hinge of a uniform box with this inertia per length in kg m.
fn roll(solver: &str, across: u32, inertia: f64) -> Series {
    let density = 12.0 * inertia / (BREADTH * HEIGHT * (BREADTH.powi(2) + HEIGHT.powi(2)));
    let hinge = format!("hinge = [0, 0, 1]\nhinge_point = [0, {DEPTH}, 0]");
    heel(&tank(solver, across, density, &hinge), 1.7)
}

#[test]
fn a_box_rolls_with_the_period_of_the_experiment() {
    if !is_validation() {
        eprintln!("SKIPPED: the roll of a box takes minutes; run `cargo xtask validate`");
        return;
    }
    ROLL.run(|variant, across, figures| {
        let heel = roll(variant.keys, across, INERTIA);
        figures.error("period over that of the experiment, minus one", period(&heel) / PERIOD - 1.0);
        let lowest = heel.iter().map(|p| p.1).fold(0.0, f64::min);
        figures.report("heel after half a period over the first", -lowest / 15.0);
        figures.plot("A box released at 15 degrees", ["time, s", "heel, degrees"], &Series::new(), &heel);
    });
}

#[test]
fn another_inertia_is_detected() {
    if !is_validation() {
        eprintln!("SKIPPED: the roll of a box takes minutes; run `cargo xtask validate`");
        return;
    }
    let mut figures = Figures::new(&ROLL, CONTROL.name, 4);
    let found = period(&roll(CONTINUITY, 4, 1.6 * INERTIA)) / PERIOD;
    figures.measure("error of the period for 1.6 times the inertia", (found - 1.0).abs());
    figures.close();
}
