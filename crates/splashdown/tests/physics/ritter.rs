//! A dam breaks over a dry bed without friction (Ritter 1892). In shallow water theory the depth at the dam is 4/9 of the
//! depth H before, and the speed there 2/3 sqrt(g H), until the wave returns from the back wall. Shallow water theory is
//! an approximation: the vertical acceleration of the first moments is gone after about three times sqrt(H / g).
//!
//! A slab six spacings thick represents two dimensions.

use splashdown::Simulation;

use super::cases::{Case, Variant};
use super::figures::Series;
use super::{executor, scene, vec};

const GRAVITY: f64 = 9.81;
/// Depth of the reservoir in m; its length is six depths.
const DEPTH: f64 = 0.2;

static CASE: Case = Case {
    name: "Ritter's dam break",
    across: "depth",
    sizes: &[10, 20, 40],
    variants: &[
        Variant::new("continuity", "density = \"continuity\""),
        Variant::extra("engineering", "accuracy = \"engineering\""),
        Variant::extra("summation", "density = \"summation\""),
        Variant::extra("dfsph", "method = \"dfsph\""),
    ],
};
pub const CASES: &[&Case] = &[&CASE];

#[test]
fn the_depth_at_a_broken_dam_is_that_of_ritter() {
    CASE.run(|variant, across, figures| {
        let spacing = DEPTH / f64::from(across);
        let (length, thick) = (6.0 * DEPTH, 6.0 * spacing);
        let scene = scene(&format!(
            "[scene]\nname = \"ritter\"\nduration = 10\n[domain]\nmin = [0, 0, 0]\nmax = [{}, {}, {thick}]\n\
             open = [\"y_max\"]\n[fluid]\nparticle_spacing = {spacing}\n[[fluid.block]]\nposition = [0, 0, 0]\n\
             size = [{length}, {DEPTH}, {thick}]\n[solver]\n{}\n",
            16.0 * DEPTH,
            1.5 * DEPTH,
            variant.keys
        ));
        let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
        let (unit, wave) = ((DEPTH / GRAVITY).sqrt(), (GRAVITY * DEPTH).sqrt());
        let (mut depths, mut speeds) = (Series::new(), Series::new());
        // The volume over the bed, two spacings to both sides of the dam.
        let width = 4.0 * spacing;
        for _ in 0..80 {
            let stats = simulation.advance((0.05 * unit) as f32).unwrap();
            assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
            let particles = simulation.particles().unwrap();
            let all = particles.positions.iter().zip(&particles.velocities);
            let near: Vec<f64> = all
                .filter(|(x, _)| (vec(**x).x - length).abs() < 0.5 * width)
                .map(|(_, &v)| vec(v).x)
                .collect();
            let volume = near.len() as f64 * spacing.powi(3);
            depths.push((stats.time / unit, volume / (width * thick) / DEPTH));
            speeds.push((stats.time / unit, near.iter().sum::<f64>() / near.len() as f64 / wave));
        }
        let late = |series: &Series| {
            let late: Vec<f64> = series.iter().filter(|p| p.0 > 3.0).map(|p| p.1).collect();
            late.iter().sum::<f64>() / late.len() as f64
        };
        let ratio = late(&depths) / (4.0 / 9.0);
        figures.error("depth at the dam over 4/9 H, minus one", ratio - 1.0);
        // Control: the depth of a reservoir that is a fifth deeper.
        figures.measure("the same for 1.2 H, difference", (ratio / 1.2 - 1.0).abs());
        figures.error("speed at the dam over 2/3 sqrt(g H), minus one", late(&speeds) / (2.0 / 3.0) - 1.0);
        let line = vec![(0.0, 4.0 / 9.0), (4.0, 4.0 / 9.0)];
        let axes = ["t sqrt(g / H)", "depth over H"];
        figures.plot("Depth at the dam (dots: 4/9)", axes, &line, &depths);
    });
}
