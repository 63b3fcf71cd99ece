//! The collapse of a column of water, twice as high as wide or square, compared with Martin & Moyce 1952.
//!
//! A slab eight spacings thick between free-slip walls represents two dimensions. The front is the 98th percentile of x
//! below y = 0.1 a; the height is that of the column at the wall. The time of the experiment starts when a diaphragm
//! ruptures, so one time shift is a free parameter.

use splashdown::Simulation;
use splashdown_io::Particles;

use super::cases::{CONTROL, Case, Variant};
use super::executor;
use super::figures::{Figures, Series};
use super::scene;

const GRAVITY: f64 = 9.81;
/// The column's width in metres.
const A: f64 = 0.05715;

const SIZES: &[u32] = &[16, 20, 40];
const VARIANTS: &[Variant] = &[
    Variant::new("summation", "method = \"wcsph\""),
    Variant::new("continuity", "method = \"wcsph\"\ndensity = \"continuity\"\nartificial_viscosity = 0.1"),
    Variant::new("dfsph", "method = \"dfsph\""),
    Variant::extra("engineering", "accuracy = \"engineering\""),
    CONTROL,
];

static CASE: Case = Case { name: "collapsing column", across: "width", sizes: SIZES, variants: VARIANTS };
static SQUARE: Case =
    Case { name: "collapsing square column", across: "width", sizes: SIZES, variants: VARIANTS };
pub const CASES: &[&Case] = &[&CASE, &SQUARE];

/// Largest time shift, in units of T.
const SHIFT: f64 = 0.2;

fn measured(which: &str) -> Series {
    let rows = include_str!("../data/martin_moyce_1952.csv").lines();
    let row = |line: &str| {
        let mut words = line.split(',');
        (words.next() == Some(which)).then(|| {
            let mut number = || words.next().unwrap().parse().unwrap();
            (number(), number())
        })
    };
    rows.filter_map(row).collect()
}

struct Column {
    /// Height over width, n^2 in the paper.
    aspect: u32,
    /// Number of particles across the column's width.
    across: u32,
    solver: &'static str,
    gravity: f64,
    /// Duration, in units of sqrt(a / g).
    until: f64,
}

/// Simulation results: the front over T = t sqrt(n^2 g / a), the height over T = t sqrt(g / a).
struct Collapse {
    front: Series,
    height: Series,
}

impl Column {
    fn simulate(&self) -> Collapse {
        let spacing = A / f64::from(self.across);
        let (thick, length, high) = (8.0 * spacing, 9.0 * A, 3.0 * A);
        let scene = scene(&format!(
            r#"
            [scene]
            name = "martin-moyce"
            duration = 1.0
            gravity = [0, {}, 0]
            [domain]
            min = [0, 0, 0]
            max = [{length}, {high}, {thick}]
            open = ["y_max"]
            [fluid]
            particle_spacing = {spacing}
            [[fluid.block]]
            position = [0, 0, 0]
            size = [{A}, {}, {thick}]
            [solver]
            {}
            "#,
            -self.gravity,
            f64::from(self.aspect) * A,
            self.solver
        ));
        let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
        assert_eq!(simulation.stats().particles, 8 * self.aspect * self.across.pow(2));
        // Time is scaled by the earth's gravity, even if the simulated gravity differs.
        let unit = (A / GRAVITY).sqrt();
        let frames = (self.until / 0.02).ceil() as u32;
        let aspect = f64::from(self.aspect);
        let mut collapse = Collapse { front: Vec::new(), height: Vec::new() };
        for _ in 0..frames {
            let stats = simulation.advance((0.02 * unit) as f32).unwrap();
            let particles = simulation.particles().unwrap();
            let tau = stats.time / unit;
            collapse.front.push((tau * aspect.sqrt(), front(&particles) / A));
            collapse.height.push((tau, height(&particles, spacing) / (aspect * A)));
        }
        let stats = simulation.stats();
        assert_eq!((stats.escaped, stats.non_finite, stats.wall_corrections), (0, 0, 0), "{stats:?}");
        collapse
    }
}

fn front(particles: &Particles) -> f64 {
    let low = particles.positions.iter().filter(|x| f64::from(x[1]) < 0.1 * A);
    let mut x: Vec<f64> = low.map(|x| f64::from(x[0])).collect();
    x.sort_by(f64::total_cmp);
    x[(0.98 * (x.len() - 1) as f64).round() as usize]
}

/// The mean, over the eight rows across the slab, of the upper side of the highest particle within two spacings of the
/// wall.
fn height(particles: &Particles, spacing: f64) -> f64 {
    let mut tops = [0.0_f64; 8];
    for x in particles.positions.iter().filter(|x| f64::from(x[0]) < 2.0 * spacing) {
        let row = ((f64::from(x[2]) / spacing) as usize).min(7);
        tops[row] = tops[row].max(f64::from(x[1]) + 0.5 * spacing);
    }
    tops.iter().sum::<f64>() / 8.0
}

fn at(series: &Series, t: f64) -> f64 {
    let k = series.partition_point(|&(time, _)| time < t).clamp(1, series.len() - 1);
    let ((t0, v0), (t1, v1)) = (series[k - 1], series[k]);
    v0 + (v1 - v0) * (t - t0) / (t1 - t0)
}

/// Root mean square of the relative errors of the front at the best time shift, and that shift.
fn front_error(simulated: &Series, measured: &Series) -> (f64, f64) {
    let last = simulated[simulated.len() - 1].0;
    let error = |shift: f64| {
        let inside = measured.iter().filter(|(t, _)| t + shift <= last);
        let squares: Vec<f64> = inside.map(|&(t, z)| (at(simulated, t + shift) / z - 1.0).powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    let shifts = (-20..=20).map(|k| SHIFT * f64::from(k) / 20.0);
    shifts.map(|shift| (error(shift), shift)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
}

/// The time from which the speed of the front is constant, in units of its T: sqrt(a / g).
fn steady(aspect: u32) -> f64 {
    if aspect == 2 { 1.4 } else { 1.0 }
}

/// The slope of a straight line through the points after this time.
fn slope(series: impl Iterator<Item = (f64, f64)>, after: f64) -> f64 {
    let points: Series = series.filter(|(t, _)| *t > after).collect();
    let n = points.len() as f64;
    let (t, z) = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
    let above: f64 = points.iter().map(|p| (p.0 - t) * (p.1 - z)).sum();
    above / points.iter().map(|p| (p.0 - t).powi(2)).sum::<f64>()
}

fn height_error(simulated: &Series, measured: &Series, until: f64) -> f64 {
    let inside = measured.iter().filter(|(t, _)| *t <= until);
    let squares: Vec<f64> = inside.map(|&(t, h)| (at(simulated, t) - h).powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

fn compare(figures: &mut Figures, column: &Column) -> Collapse {
    let collapse = column.simulate();
    let square = if column.aspect == 1 { "square " } else { "" };
    let front = measured(&format!("{square}front"));
    let (error, shift) = front_error(&collapse.front, &front);
    figures.error("front, rms relative", error);
    figures.report("best time shift T", shift);
    let after = steady(column.aspect);
    let experiment = slope(front.iter().copied(), after);
    let inside = front.iter().map(|&(t, _)| (t, at(&collapse.front, t + shift)));
    let ratio = slope(inside, after) / experiment;
    figures.measure("speed of the front over the measured speed", ratio);
    let error = height_error(&collapse.height, &measured(&format!("{square}height")), column.until);
    figures.error("height, rms over the initial height", error);
    figures.plot("Front (dots: measured)", ["T", "front over width"], &front, &collapse.front);
    collapse
}

#[test]
fn a_collapsing_column_agrees_with_martin_and_moyce() {
    CASE.run(|variant, across, figures| {
        let until = if across < 20 { 2.5 } else { 4.2 };
        let column = Column { aspect: 2, across, solver: variant.keys, gravity: GRAVITY, until };
        let collapse = compare(figures, &column);
        if across == 40 {
            // Convergence: the front differs less between 20 and 40 particles than between 10 and 20.
            let [coarse, middle] =
                [10, 20].map(|across| Column { across, until: 2.4, ..column }.simulate().front);
            let gap = |a: &Series, b: &Series| {
                let squares =
                    (10..32).map(|k| (at(a, 0.1 * f64::from(k)) - at(b, 0.1 * f64::from(k))).powi(2));
                (squares.sum::<f64>() / 22.0).sqrt()
            };
            let (first, second) = (gap(&coarse, &middle), gap(&middle, &collapse.front));
            figures.report("front, 10 against 20 particles across, rms of Z", first);
            figures.measure("the same, 20 against 40 over 10 against 20", second / first);
        }
    });
}

#[test]
fn a_collapsing_square_column_agrees_with_martin_and_moyce() {
    SQUARE.run(|variant, across, figures| {
        compare(figures, &Column { aspect: 1, across, solver: variant.keys, gravity: GRAVITY, until: 4.4 });
    });
}

/// Compares a collapse with half of the gravity.
fn weak(case: &'static Case, column: &Column, names: [&str; 2]) {
    let mut figures = Figures::new(case, CONTROL.name, column.across);
    let collapse = column.simulate();
    let [front, height] = names.map(measured);
    figures.measure("front, rms relative", front_error(&collapse.front, &front).0);
    let after = steady(column.aspect);
    let last = front[front.len() - 1].0;
    let ratio = slope(collapse.front.iter().copied().filter(|(t, _)| *t < last), after)
        / slope(front.into_iter(), after);
    figures.measure("relative error of the speed of the front", (ratio - 1.0).abs());
    figures.measure(
        "height, rms over the initial height",
        height_error(&collapse.height, &height, column.until),
    );
    figures.close();
}

#[test]
fn half_the_gravity_is_detected() {
    let column =
        Column { aspect: 2, across: 10, solver: CASE.variants[0].keys, gravity: 0.5 * GRAVITY, until: 2.5 };
    weak(&CASE, &column, ["front", "height"]);
    weak(&SQUARE, &Column { aspect: 1, until: 3.4, ..column }, ["square front", "square height"]);
}
