//! The volume of water that sloshes for eight seconds, against that of its particles.
//!
//! A block of 0.5 x 0.4 x 0.5 m collapses in a tank of 0.6 m. The mean height of the particles is half the depth of the water,
//! and waves raise it by the ratio of their energy to that of the water, at most 1 % in the last two seconds. The continuity
//! equation does not know the positions: disorder compacts the particles, and shifting dilates them (Jandaghian, Krimi &
//! Shakibaeinia 2021).

use splashdown::Simulation;
use splashdown_io::Particles;

use super::cases::{Case, Variant};
use super::figures::Series;
use super::{executor, scene};

/// Initial length and depth of the water, length of the tank, and width of both, in m.
const BLOCK: [f64; 2] = [0.5, 0.4];
const LENGTH: f64 = 0.6;
const WIDTH: f64 = 0.5;
/// Duration, and the time from which the figures are means, in s.
const DURATION: f64 = 8.0;
const LATE: f64 = 6.0;

static CASE: Case = Case {
    name: "volume in a sloshing tank",
    across: "depth",
    sizes: &[8, 16],
    variants: &[
        Variant::new("continuity", "density = \"continuity\""),
        Variant::new("dfsph", "method = \"dfsph\""),
        Variant::new("engineering", "accuracy = \"engineering\""),
        Variant::extra("summation", "density = \"summation\""),
    ],
};
pub const CASES: &[&Case] = &[&CASE];

/// The depth in m of still water with this distribution of particles.
fn depth(particles: &Particles) -> f64 {
    let heights = particles.positions.iter().map(|x| f64::from(x[1]));
    2.0 * heights.sum::<f64>() / particles.positions.len() as f64
}

#[test]
fn sloshing_water_keeps_its_volume() {
    CASE.run(|variant, across, figures| {
        let spacing = BLOCK[1] / f64::from(across);
        let scene = scene(&format!(
            "[scene]\nname = \"volume\"\nduration = {DURATION}\n[domain]\nmin = [0, 0, 0]\nmax = [{LENGTH}, 4, {WIDTH}]\n\
             open = [\"y_max\"]\n[fluid]\nparticle_spacing = {spacing}\n[[fluid.block]]\nposition = [0, 0, 0]\n\
             size = [{}, {}, {WIDTH}]\n[solver]\n{}\n",
            BLOCK[0], BLOCK[1], variant.keys,
        ));
        let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
        let exact = BLOCK[0] * BLOCK[1] / LENGTH;
        let mut depths = Series::new();
        let frames = 80;
        for frame in 1..=frames {
            let stats = simulation.advance((DURATION / f64::from(frames)) as f32).unwrap();
            assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
            let time = DURATION * f64::from(frame) / f64::from(frames);
            depths.push((time, depth(&simulation.particles().unwrap())));
        }
        let late: Vec<f64> = depths.iter().filter(|point| point.0 > LATE).map(|point| point.1).collect();
        let mean = late.iter().sum::<f64>() / late.len() as f64;
        figures.error("volume over that of the particles, minus one", mean / exact - 1.0);
        figures.measure("the same for 1.2 times the volume, difference", (mean / (1.2 * exact) - 1.0).abs());
        let line = vec![(0.0, exact), (DURATION, exact)];
        figures.plot("Twice the mean height (dots: still water)", ["time, s", "depth, m"], &line, &depths);
    });
}
