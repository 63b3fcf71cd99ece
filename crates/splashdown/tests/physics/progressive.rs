//! Progressive waves from a piston. Linear theory gives their height over the stroke of the piston,
//! 2 (cosh 2kh - 1) / (sinh 2kh + 2kh) (Biesel & Suquet 1951), and their phase speed, sqrt(g tanh(kh) / k); without viscosity
//! they keep their height.
//!
//! A slab four spacings thick represents two dimensions. The wave is four depths long. Its amplitude and phase follow from the
//! particles in a window of two wave lengths, weighted by cos^2 and exp(-ikx): the still water and waves in the opposite
//! direction vanish in this sum. The run ends before waves return from the far wall.

use splashdown::Simulation;
use splashdown_io::Particles;

use super::cases::{Case, Variant};
use super::figures::Series;
use super::{executor, scene};

const GRAVITY: f64 = 9.81;
/// Depth of the water, length of the wave and of the tank, and height of the wave in m.
const DEPTH: f64 = 0.5;
const WAVE: f64 = 4.0 * DEPTH;
const TANK: f64 = 4.5 * WAVE;
const HEIGHT: f64 = 0.04;
/// Centres of the two windows in m. They are one wave length apart.
const WINDOWS: [f64; 2] = [1.25 * WAVE, 2.25 * WAVE];

static CASE: Case = Case {
    name: "progressive wave",
    across: "depth",
    sizes: &[12, 20, 28],
    variants: &[
        Variant::new("dfsph", "method = \"dfsph\""),
        Variant::extra("dfsph, support 3", "method = \"dfsph\"\nsupport_ratio = 3"),
        Variant::extra("continuity", "density = \"continuity\""),
        Variant::extra("engineering", "accuracy = \"engineering\""),
    ],
};
pub const CASES: &[&Case] = &[&CASE];

fn wave_number() -> f64 {
    std::f64::consts::TAU / WAVE
}

fn frequency() -> f64 {
    (GRAVITY * wave_number() * (wave_number() * DEPTH).tanh()).sqrt()
}

/// The height of the waves over the stroke of the piston.
fn transfer() -> f64 {
    let twice = 2.0 * wave_number() * DEPTH;
    2.0 * (twice.cosh() - 1.0) / (twice.sinh() + twice)
}

/// The complex amplitude in m of the waves along +x around `centre`.
fn amplitude(particles: &Particles, area: f64, centre: f64) -> [f64; 2] {
    let mut sum = [0.0, 0.0];
    for x in particles.positions.iter().map(|x| f64::from(x[0])) {
        if (x - centre).abs() < WAVE {
            let weight = (0.5 * std::f64::consts::PI * (x - centre) / WAVE).cos().powi(2);
            let phase = wave_number() * x;
            sum[0] += weight * phase.cos();
            sum[1] -= weight * phase.sin();
        }
    }
    // The window has the length of one wave, and exp(ikx) is half of a cosine.
    sum.map(|part| 2.0 * area * part / WAVE)
}

struct Measured {
    height: f64,
    speed: f64,
    loss: f64,
    curve: Series,
}

fn measure(across: u32, solver: &str) -> Measured {
    let spacing = DEPTH / f64::from(across);
    let thick = 4.0 * spacing;
    let (omega, stroke) = (frequency(), HEIGHT / transfer());
    let period = std::f64::consts::TAU / omega;
    // The piston covers the end of the slab.
    let (top, wide) = (1.6 * DEPTH, thick + 0.2);
    let scene = scene(&format!(
        "[scene]\nname = \"waves\"\nduration = 20\n[domain]\nmin = [-0.2, 0, 0]\nmax = [{TANK}, {}, {thick}]\n\
         open = [\"y_max\"]\n[fluid]\nparticle_spacing = {spacing}\n[[fluid.block]]\nposition = [0, 0, 0]\n\
         size = [{TANK}, {DEPTH}, {thick}]\n[solver]\n{solver}\n[[body]]\nname = \"piston\"\nmesh = \"cube\"\n\
         scale = [0.2, {top}, {wide}]\nposition = [-0.1, {}, {}]\n\
         move = [\"{}*min(t/{period},1)*sin({omega}*t)\", \"0\", \"0\"]\n",
        1.4 * DEPTH,
        0.5 * top - 0.05,
        0.5 * thick,
        0.5 * stroke,
    ));
    let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
    let area = spacing.powi(3) / thick;
    let samples = 24;
    // Waves have the group speed 0.64 c; the second window ends 3.25 wave lengths from the piston.
    let (start, end) = (6 * samples, 8 * samples);
    let mut phases: Vec<(f64, f64)> = Vec::new();
    let (mut heights, mut curve) = ([0.0, 0.0], Series::new());
    for frame in 1..=end {
        let stats = simulation.advance((period / f64::from(samples)) as f32).unwrap();
        assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
        let particles = simulation.particles().unwrap();
        let waves = WINDOWS.map(|centre| amplitude(&particles, area, centre));
        curve.push((stats.time, 2.0 * waves[0][0].hypot(waves[0][1])));
        if frame > start {
            for (height, wave) in heights.iter_mut().zip(waves) {
                *height += 2.0 * wave[0].hypot(wave[1]) / f64::from(end - start);
            }
            let phase = waves[0][1].atan2(waves[0][0]);
            let turns = phases
                .last()
                .map_or(0.0, |&(_, last): &(f64, f64)| ((last - phase) / std::f64::consts::TAU).round());
            phases.push((stats.time, phase + turns * std::f64::consts::TAU));
        }
    }
    // The distance between the windows is one wave length at the phase speed: the phase between them gives the wave number.
    let particles = simulation.particles().unwrap();
    let [near, far] = WINDOWS.map(|centre| amplitude(&particles, area, centre));
    let between = far[1].atan2(far[0]) - near[1].atan2(near[0]);
    let between = between - std::f64::consts::TAU * (between / std::f64::consts::TAU).round();
    let (first, last) = (phases[0], phases[phases.len() - 1]);
    let measured = -(last.1 - first.1) / (last.0 - first.0);
    let speed = measured / (wave_number() + between / WAVE);
    Measured { height: heights[0], speed, loss: 1.0 - heights[1] / heights[0], curve }
}

#[test]
fn waves_from_a_piston_keep_their_height_and_speed() {
    CASE.run(|variant, across, figures| {
        let measured = measure(across, variant.keys);
        let speed = frequency() / wave_number();
        figures.error("phase speed over linear theory, minus one", measured.speed / speed - 1.0);
        figures.measure("the same for 0.8 times the depth, difference", {
            let shallow = (GRAVITY / wave_number() * (0.8 * wave_number() * DEPTH).tanh()).sqrt();
            (measured.speed / shallow - 1.0).abs()
        });
        figures.error("height over that of the piston's theory, minus one", measured.height / HEIGHT - 1.0);
        figures.error("loss of height per wave length", measured.loss);
        let line = vec![(0.0, HEIGHT), (measured.curve[measured.curve.len() - 1].0, HEIGHT)];
        let title = "Height in the first window (dots: theory)";
        figures.plot(title, ["time, s", "height, m"], &line, &measured.curve);
    });
}
