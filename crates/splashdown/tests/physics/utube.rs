//! Water that swings in a U-tube. The column, 1.4 m long along its middle, has the period 2 pi sqrt(L / (2 g)) without
//! friction (gate: within 10 %, because the water takes shorter ways through the bends). Walls and water have no friction.
//! The loss of height is that of the bends, which is not known exactly; it is compared between solvers.

use std::f64::consts::TAU;

use glam::Vec3;
use splashdown::Simulation;
use splashdown::scene::Motion;

use super::cases::{Case, Variant};
use super::figures::Series;
use super::meshes::cuboid;
use super::shapes::{body, file};
use super::{executor, scene};

const GRAVITY: f64 = 9.81;
/// Width of the legs, of the wall between them and of the passage below it, in m.
const WIDTH: f32 = 0.2;
/// The levels of the two legs at the start, in m.
const LEVELS: [f32; 2] = [0.7, 0.5];
/// Length of the column along its middle in m.
const LENGTH: f64 = 1.4;
/// Turning points after the start that are compared.
const TURNS: usize = 4;

static CASE: Case = Case {
    name: "U-tube",
    across: "leg",
    sizes: &[8, 12, 16],
    variants: &[
        Variant::extra("engineering", "accuracy = \"engineering\""),
        Variant::new("dfsph", "method = \"dfsph\""),
        Variant::extra("dfsph, support 2.3", "method = \"dfsph\"\nsupport_ratio = 2.3"),
        Variant::extra("dfsph, support 3", "method = \"dfsph\"\nsupport_ratio = 3"),
    ],
};
pub const CASES: &[&Case] = &[&CASE];

/// The period of a column of this length without friction.
fn period(length: f64) -> f64 {
    TAU * (length / (2.0 * GRAVITY)).sqrt()
}

/// The difference of the two levels over time, a little longer than until the last turning point that is compared.
fn swing(across: u32, solver: &str) -> Series {
    let spacing = WIDTH / across as f32;
    let folder = tempfile::tempdir().unwrap();
    let [left, right] = LEVELS;
    let mut scene = scene(&format!(
        "[scene]\nname = \"u-tube\"\nduration = 5\nframe_rate = 50\n\
         [domain]\nmin = [0, 0, 0]\nmax = [0.6, 1, {WIDTH}]\nopen = [\"y_max\"]\n\
         [fluid]\nparticle_spacing = {spacing}\nviscosity = 0\n\
         [[fluid.block]]\nposition = [0, 0, 0]\nsize = [{WIDTH}, {left}, {WIDTH}]\n\
         [[fluid.block]]\nposition = [{WIDTH}, 0, 0]\nsize = [{WIDTH}, {WIDTH}, {WIDTH}]\n\
         [[fluid.block]]\nposition = [{}, 0, 0]\nsize = [{WIDTH}, {right}, {WIDTH}]\n\
         [solver]\n{solver}\n\
         [[probe]]\nname = \"left\"\nquantity = \"height\"\nposition = [0.1, 0, 0.1]\n\
         [[probe]]\nname = \"right\"\nquantity = \"height\"\nposition = [0.5, 0, 0.1]\n",
        2.0 * WIDTH,
    ));
    // The wall extends beyond the sides and the top of the domain.
    let wall = cuboid(Vec3::new(WIDTH, WIDTH, -0.1), Vec3::new(2.0 * WIDTH, 1.1, WIDTH + 0.1));
    scene.bodies.push(body("wall", file(folder.path(), "wall.obj", &wall), 1.0, Vec3::ZERO, Motion::Static));
    let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
    let mut difference = Series::new();
    while difference.last().is_none_or(|p| p.0 < 0.55 * TURNS as f64 * period(LENGTH)) {
        let stats = simulation.advance(0.02).unwrap();
        assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
        let rows = simulation.take_probe_rows();
        difference.extend(rows[0].iter().zip(&rows[1]).map(|(a, b)| (a[0], a[1] - b[1])));
    }
    difference
}

/// The times at which the difference changes its sign.
fn crossings(difference: &Series) -> Vec<f64> {
    let changes = difference.windows(2).filter(|p| p[0].1 * p[1].1 < 0.0);
    let mut times: Vec<f64> =
        changes.map(|p| p[0].0 + (p[1].0 - p[0].0) * p[0].1 / (p[0].1 - p[1].1)).collect();
    // Noise can cross zero several times.
    times.dedup_by(|later, earlier| *later - *earlier < 0.1 * period(LENGTH));
    times
}

#[test]
fn water_swings_in_a_u_tube() {
    CASE.run(|variant, across, figures| {
        let difference = swing(across, variant.keys);
        let zeros = crossings(&difference);
        assert!(zeros.len() >= 3, "the water swings less than a period: {zeros:?}");
        let measured = zeros[2] - zeros[0];
        figures.error("period over 2 pi sqrt(L / 2 g), minus one", measured / period(LENGTH) - 1.0);
        // Control: the period of a column half as long again.
        figures.measure(
            "the same for 1.5 times the length, difference",
            (measured / period(1.5 * LENGTH) - 1.0).abs(),
        );
        // The largest difference after each crossing.
        let turns = zeros.len().min(TURNS);
        let last = zeros[turns - 1];
        let after = difference.iter().filter(|p| (last..last + 0.5 * period(LENGTH)).contains(&p.0));
        let height = after.map(|p| p.1.abs()).fold(0.0, f64::max);
        let start = f64::from(LEVELS[0] - LEVELS[1]);
        figures.report("loss of height per half period", 1.0 - (height / start).powf(1.0 / turns as f64));
        figures.plot("Difference of the levels", ["time, s", "m"], &Series::new(), &difference);
    });
}
