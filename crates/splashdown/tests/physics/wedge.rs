//! A wedge enters still water at a constant speed, without gravity. The flow is similar to itself at all times, so that the
//! force per length is k rho V^3 t. R. Zhao and O. Faltinsen, "Water entry of two-dimensional bodies", J. Fluid Mech. 246
//! (1993) 593-612, give k = 14.139 for a deadrise angle of 30 degrees and 23.657 for 25, by the similarity solution of
//! Dobrovol'skaya (1969). A solution of her similarity problem
//! (`python3 docs/validation/wedge_similarity.py 30,25,40`) gives 14.02 and 23.57, and 5.45 instead of 5.477 for 40 degrees: both
//! agree within one per cent. Wagner's theory, for small angles, gives pi^3 / (4 tan^2 a) = 23.3.
//!
//! The tank is 2.8 m wide and 0.7 m deep. One of half the size increased the force by 10 % at the end.
//!
//! The slope of the force over time does not depend on the moment of the first contact. A slab four spacings thick represents
//! two dimensions; the resolution is the number of spacings of the final depth of the apex. The slope is sensitive to the noise
//! of the force, the impulse is not.

use glam::Vec3;
use splashdown::Simulation;
use splashdown_io::Mesh;

use super::cases::{Case, Variant};
use super::figures::Series;
use super::shapes::file;
use super::{executor, scene};

/// The speed in m/s, and the final depth of the apex in m.
const SPEED: f64 = 1.0;
const DEPTH: f64 = 0.08;
/// Half the width of the wedge in m, and the tangent of 30 degrees.
const HALF: f32 = 0.2;
const SLOPE: f32 = 0.577_350_3;
/// The coefficient k for 30 degrees, and for 25 as a control.
const FORCE: f64 = 14.139;
const FORCE_25: f64 = 23.657;

static CASE: Case = Case {
    name: "water entry of a wedge",
    across: "depth",
    sizes: &[8, 12, 16],
    variants: &[
        Variant::new("continuity", "density = \"continuity\"\nsound_speed = 20"),
        Variant::extra("engineering", "accuracy = \"engineering\"\nsound_speed = 20"),
        Variant::extra("summation", "density = \"summation\"\nsound_speed = 20"),
        Variant::extra("dfsph", "method = \"dfsph\""),
    ],
};
pub const CASES: &[&Case] = &[&CASE];

/// A prism along z with the apex at the origin, downwards.
fn prism(thick: f32) -> Mesh {
    let end = |z: f32| [[-HALF, HALF * SLOPE, z], [HALF, HALF * SLOPE, z], [0.0, 0.0, z]];
    let triangles =
        vec![[0, 1, 2], [3, 5, 4], [0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2], [2, 5, 3], [2, 3, 0]];
    Mesh::new([end(-0.1), end(thick + 0.1)].concat(), triangles)
}

/// The slope of a straight line through points.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
    points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
        / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

#[test]
fn the_force_on_a_wedge_grows_with_time() {
    CASE.run(|variant, across, figures| {
        let spacing = DEPTH / f64::from(across);
        let thick = 4.0 * spacing;
        let folder = tempfile::tempdir().unwrap();
        let level = 0.7;
        let mut scene = scene(&format!(
            "[scene]\nname = \"wedge\"\nduration = 1\ngravity = [0, 0, 0]\n[domain]\nmin = [-1.4, 0, 0]\n\
             max = [1.4, 1.0, {thick}]\nopen = [\"y_max\"]\n[fluid]\nparticle_spacing = {spacing}\n\
             [[fluid.block]]\nposition = [-1.4, 0, 0]\nsize = [2.8, {level}, {thick}]\n\
             [[body]]\nname = \"wedge\"\nmesh = \"cube\"\nposition = [0, {level}, 0]\n\
             move = [\"0\", \"-{SPEED}*t\", \"0\"]\n\
             [[probe]]\nname = \"force\"\nquantity = \"force\"\nbody = \"wedge\"\n[solver]\n{}\n",
            variant.keys
        ));
        scene.bodies[0].mesh.shape = file(folder.path(), "wedge.obj", &prism(thick as f32));
        scene.bodies[0].mesh.scale = Vec3::ONE;
        let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
        let mut forces = Series::new();
        for _ in 0..40 {
            let stats = simulation.advance((DEPTH / SPEED / 40.0) as f32).unwrap();
            assert_eq!(stats.non_finite, 0, "{stats:?}");
            let rows = simulation.take_probe_rows();
            forces.extend(rows[0].iter().map(|row| (row[0], row[2] / thick)));
        }
        let late = forces.partition_point(|p| p.0 < 0.5 * DEPTH / SPEED);
        let found = slope(&forces[late..]) / (1000.0 * SPEED.powi(3));
        let impulse =
            |points: &[(f64, f64)]| points.windows(2).map(|w| (w[1].0 - w[0].0) * w[1].1).sum::<f64>();
        let exact: Vec<_> =
            forces[late - 1..].iter().map(|&(t, _)| (t, 1000.0 * FORCE * SPEED.powi(3) * t)).collect();
        figures.error(
            "impulse in the second half over the exact one, minus one",
            impulse(&forces[late - 1..]) / impulse(&exact) - 1.0,
        );
        figures.error("slope of the force over 14.139 rho V^3, minus one", found / FORCE - 1.0);
        figures.measure("the same for 25 degrees, difference", (found / FORCE_25 - 1.0).abs());
        let exact = (1..=40).map(|k| 0.002 * f64::from(k)).map(|t| (t, 1000.0 * FORCE * t)).collect();
        let axes = ["time, s", "force per length, N/m"];
        figures.plot("Force (dots: Zhao and Faltinsen)", axes, &exact, &forces);
    });
}
