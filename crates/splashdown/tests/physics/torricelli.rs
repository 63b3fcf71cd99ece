//! A tank that drains through a slit in its floor (Torricelli 1643). The level falls as
//! (sqrt(y0) - C_d (A_o / A) sqrt(g / 2) t)^2, with C_d about 0.61 for a sharp edge (gate: 0.55 to 0.66). The speed of the
//! jet is sqrt(2 g y) within 4 %.
//!
//! A slab eight spacings thick represents two dimensions. The floor consists of two plates with a slit eight spacings
//! wide, 16 at full resolution. The kernel smooths the edges of the slit: at eight spacings the flow is a seventh too
//! large, so it is reported without a gate.

use glam::Vec3;
use splashdown::Simulation;
use splashdown::scene::Motion;

use super::cases::{Case, Variant};
use super::figures::{Figures, Series};
use super::meshes::cuboid;
use super::shapes::{body, file};
use super::{executor, scene};

const GRAVITY: f64 = 9.81;
const SLIT: f32 = 0.08;

static CASE: Case = Case {
    name: "Torricelli",
    across: "slit",
    sizes: &[8, 12, 16],
    variants: &[
        Variant::new(
            "continuity",
            "density = \"continuity\"\nartificial_viscosity = 0.05\nnegative_pressure = \"clamp\"",
        ),
        Variant::extra("engineering", "accuracy = \"engineering\""),
        Variant::extra("dfsph", "method = \"dfsph\""),
    ],
};
pub const CASES: &[&Case] = &[&CASE];

struct Tank {
    spacing: f32,
    width: f32,
    depth: f32,
    seconds: f64,
}

/// The slope and the value at zero of a straight line through points.
fn line(points: &Series) -> (f64, f64) {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
    let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
        / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>();
    (slope, y - slope * x)
}

#[test]
fn a_draining_tank_follows_torricelli() {
    CASE.run(|variant, across, figures| {
        let spacing = SLIT / across as f32;
        let tank = if across > 8 {
            Tank { spacing, width: 0.48, depth: 0.3, seconds: 0.8 }
        } else {
            Tank { spacing, width: 0.48, depth: 0.25, seconds: 0.6 }
        };
        drain(&tank, variant.keys, figures);
    });
}

fn drain(tank: &Tank, solver: &str, figures: &mut Figures) {
    let thick = 8.0 * tank.spacing;
    let folder = tempfile::tempdir().unwrap();
    let (plate, below) = (0.02, 0.16);
    let mut scene = scene(&format!(
        "[scene]\nname = \"torricelli\"\nduration = 2\nframe_rate = 50\n[domain]\nmin = [0, {}, 0]\nmax = [{}, {}, {thick}]\n\
         open = [\"y_min\", \"y_max\"]\n[fluid]\nparticle_spacing = {}\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [{}, {}, {thick}]\n\
         [solver]\n{solver}\n\
         [[probe]]\nname = \"left\"\nquantity = \"height\"\nposition = [{}, 0, {}]\n\
         [[probe]]\nname = \"right\"\nquantity = \"height\"\nposition = [{}, 0, {}]\n",
        -below,
        tank.width,
        1.2 * tank.depth,
        tank.spacing,
        tank.width,
        tank.depth,
        0.15 * tank.width,
        0.5 * thick,
        0.85 * tank.width,
        0.5 * thick,
    ));
    let middle = 0.5 * tank.width;
    let sides = [("left", -0.1, middle - 0.5 * SLIT), ("right", middle + 0.5 * SLIT, tank.width + 0.1)];
    for (name, from, to) in sides {
        // The plates extend beyond the sides of the domain.
        let mesh = cuboid(Vec3::new(from, -plate, -0.1), Vec3::new(to, 0.0, thick + 0.1));
        let shape = file(folder.path(), &format!("{name}.obj"), &mesh);
        scene.bodies.push(body(name, shape, 1.0, Vec3::ZERO, Motion::Static));
    }
    let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
    let mut levels = Series::new();
    let mut jet = Series::new();
    for _ in 0..(tank.seconds * 50.0) as u32 {
        let stats = simulation.advance(0.02).unwrap();
        assert_eq!((stats.non_finite, stats.wall_corrections), (0, 0), "{stats:?}");
        let rows = simulation.take_probe_rows();
        for (a, b) in rows[0].iter().zip(&rows[1]) {
            levels.push((a[0], 0.5 * (a[1] + b[1])));
        }
        // The core of the jet, half a slit width to a slit width below the edge, where it has contracted.
        let particles = simulation.particles().unwrap();
        let level = levels[levels.len() - 1].1;
        let core = particles.positions.iter().zip(&particles.velocities).filter(|(x, _)| {
            (x[0] - middle).abs() < 0.15 * SLIT && (-SLIT..-0.5 * SLIT).contains(&(x[1] + plate))
        });
        let ratios: Vec<f64> = core
            .map(|(x, v)| f64::from(-v[1]) / (2.0 * GRAVITY * (level - f64::from(x[1]))).sqrt())
            .collect();
        if stats.time > 0.4 * tank.seconds && !ratios.is_empty() {
            jet.push((stats.time, ratios.iter().sum::<f64>() / ratios.len() as f64));
        }
    }
    let roots: Series =
        levels.iter().filter(|(t, _)| *t > 0.4 * tank.seconds).map(|&(t, y)| (t, y.sqrt())).collect();
    let (slope, _) = line(&roots);
    let discharge = -slope / (f64::from(SLIT / tank.width) * (0.5 * GRAVITY).sqrt());
    figures.measure("C_d from the falling level", discharge);
    let speed = jet.iter().map(|(_, ratio)| ratio).sum::<f64>() / jet.len() as f64;
    figures.measure("speed of the jet over sqrt(2 g y)", speed);
    let ideal = |&(t, _): &(f64, f64)| {
        let (t0, y0) = levels[0];
        (t, (y0.sqrt() - 0.61 * f64::from(SLIT / tank.width) * (0.5 * GRAVITY).sqrt() * (t - t0)).powi(2))
    };
    let formula: Series = levels.iter().step_by(15).map(ideal).collect();
    figures.plot("Level over the slit (dots: C_d = 0.61)", ["time, s", "level, m"], &formula, &levels);
}
