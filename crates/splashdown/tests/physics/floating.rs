//! Floating balls. The draft follows Archimedes within 4 % of the diameter. The heave period follows from an added mass of half the displaced mass, within 10 %.

use glam::Vec3;
use splashdown::scene::{MeshShape, Motion, Scene};

use super::cases::{Case, Variant, is_validation};
use super::figures::Series;
use super::scene;
use super::shapes::{at_rest, body};

const RADIUS: f32 = 0.08;
const SIDE: f32 = 0.56;

const CONTINUITY: &str = "density = \"continuity\"\nartificial_viscosity = 0.05";
const ENGINEERING: &str = "accuracy = \"engineering\"";
const DFSPH: &str = "method = \"dfsph\"";

/// Floating balls need 12 spacings per diameter.
static DRAFT: Case = Case {
    name: "floating ball, draft",
    across: "diameter",
    sizes: &[12, 16],
    variants: &[
        Variant::extra("continuity", CONTINUITY),
        Variant::extra("engineering", ENGINEERING),
        Variant::extra("dfsph", DFSPH),
    ],
};
/// At eight spacings the gap around the ball is a sixth of its radius (0.898 measured), so the gate applies from 12.
static HEAVE: Case = Case {
    name: "floating ball, heave",
    across: "diameter",
    sizes: &[8, 12, 16],
    variants: &[
        Variant::new("continuity", CONTINUITY),
        Variant::extra("engineering", ENGINEERING),
        Variant::extra("dfsph", DFSPH),
    ],
};
pub const CASES: &[&Case] = &[&DRAFT, &HEAVE];

/// A tank of still water with a ball of this density whose centre is `height` in m above the level.
fn tank(solver: &str, across: u32, density: f32, height: f32) -> Scene {
    let spacing = 2.0 * RADIUS / across as f32;
    let depth = (0.28 / spacing).round() * spacing;
    let mut scene = scene(&format!(
        "[scene]\nname = \"floating\"\nduration = 2\n[domain]\nmin = [0, 0, 0]\nmax = [{SIDE}, 0.5, {SIDE}]\nopen = [\"y_max\"]\n\
         [fluid]\nparticle_spacing = {spacing}\nviscosity = 1e-6\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [{SIDE}, {depth}, {SIDE}]\n\
         [solver]\n{solver}\n"
    ));
    let motion = Motion::Dynamic { density, velocity: Vec3::ZERO, angular_velocity: Vec3::ZERO, hinge: None };
    let place = Vec3::new(0.5 * SIDE, depth + height, 0.5 * SIDE);
    scene.bodies.push(body("ball", MeshShape::Model("sphere".into()), RADIUS / 0.1, place, motion));
    scene
}

/// The height of the ball above the initial water level, over time.
fn heights(scene: &Scene, seconds: f64) -> Series {
    let splashdown::scene::Shape::Box { size, .. } = &scene.fluid.blocks[0].shape else {
        panic!("the fluid is not a block")
    };
    let level = size.y;
    let mut simulation = at_rest(scene, |x| level - x.y);
    let mut found = Series::new();
    for k in 0..(seconds / 0.01) as u32 {
        let stats = simulation.advance(0.01).unwrap();
        assert_eq!((stats.non_finite, stats.escaped), (0, 0), "{stats:?}");
        let y = simulation.body_states().unwrap()[0].position.y;
        found.push((0.01 * f64::from(k + 1), f64::from(y - level)));
    }
    found
}

/// The depth of a ball's centre below the level at rest, over its radius, for a density in kg/m^3: the volume of the
/// submerged cap equals that of the displaced water.
fn archimedes(density: f64) -> f64 {
    let share = |s: f64| (2.0 + 3.0 * s - s.powi(3)) / 4.0;
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if share(middle) < density / 1000.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn the_draft_of_floating_balls_follows_archimedes() {
    if !is_validation() {
        eprintln!("SKIPPED: floating balls need 12 spacings per diameter; run `cargo xtask validate`");
        return;
    }
    DRAFT.run(|variant, across, figures| {
        for density in [100.0, 200.0, 700.0] {
            let under = archimedes(density);
            let scene = tank(variant.keys, across, density as f32, (-under * f64::from(RADIUS)) as f32);
            let late: Series = heights(&scene, 1.5).into_iter().filter(|(t, _)| *t > 0.8).collect();
            let mean = late.iter().map(|(_, y)| y).sum::<f64>() / late.len() as f64;
            // The water level does not rise: the particles inside the ball were removed.
            let error = (mean / f64::from(RADIUS) + under) / 2.0;
            figures.error(format!("height error over the diameter, {density} kg/m^3"), error);
        }
    });
}

#[test]
fn a_ball_heaves_with_its_added_mass() {
    let lift = 0.3 * RADIUS;
    HEAVE.run(|variant, across, figures| {
        let found = heights(&tank(variant.keys, across, 500.0, lift), 1.1);
        // The ball passes its mean height downwards, upwards, downwards: half a period each.
        let mean = found.iter().map(|(_, y)| y).sum::<f64>() / found.len() as f64;
        let passes: Vec<f64> = found
            .windows(2)
            .filter(|pair| (pair[0].1 > mean) != (pair[1].1 > mean))
            .map(|pair| pair[0].0 + 0.01 * (mean - pair[0].1) / (pair[1].1 - pair[0].1))
            .collect();
        assert!(passes.len() >= 2, "{passes:?} {found:?}");
        let period = 2.0 * (passes[1] - passes[0]);
        // m = rho V / 2, added rho V / 4, restored by rho g pi R^2.
        let exact = std::f64::consts::TAU * (f64::from(RADIUS) / 9.81).sqrt();
        figures.measure("period over 2 pi sqrt(R / g)", period / exact);
        figures.report("mean height over the diameter", mean / f64::from(2.0 * RADIUS));
        figures.plot(
            "A ball of 500 kg/m^3, released 0.3 R above equilibrium",
            ["time, s", "height, m"],
            &Series::new(),
            &found,
        );
    });
}
