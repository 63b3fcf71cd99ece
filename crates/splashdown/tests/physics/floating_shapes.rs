//! Floating bodies of 300 kg/m^3: the share of the volume below the water level is 0.3 for every shape (Archimedes), within
//! 2 %, and bodies that float flat do not heel.
//!
//! The level follows from the balance of forces, with the water at its rest density: water and body weigh as much as water up
//! to the level, whatever the distance that the water keeps from the body. Where the water is compacted, its level is lower and
//! the share too large.

use std::path::PathBuf;

use glam::{Quat, Vec3};
use splashdown::BodyState;
use splashdown::scene::{BoundaryKind, Motion};
use splashdown_io::Mesh;

use super::cases::{CONTROL, Case, Variant, is_validation};
use super::figures::{Figures, Series};
use super::shapes::{at_rest, body, file};
use super::{meshes, scene};

/// The longest side of each body, the depth of the water and the width of the tank, in m.
const LENGTH: f32 = 0.2;
const DEPTH: f32 = 0.24;
const SIDE: f32 = 0.52;
/// The density of the bodies over that of water.
const DENSITY: f64 = 0.3;
/// The means cover the seconds between these.
const SETTLED: f64 = 1.5;
const END: f64 = 3.0;

const PARTICLES: &str = "dfsph, boundary particles";

static SHAPES: Case = Case {
    name: "floating shapes",
    across: "length",
    sizes: &[10, 15, 20],
    variants: &[
        Variant::extra("continuity", "method = \"wcsph\"\ndensity = \"continuity\""),
        Variant::extra("engineering", "accuracy = \"engineering\""),
        Variant::extra("dfsph", "method = \"dfsph\""),
        Variant::extra(PARTICLES, "method = \"dfsph\""),
        CONTROL,
    ],
};
pub const CASES: &[&Case] = &[&SHAPES];

/// The volume of a closed mesh below the height `level`, by the divergence theorem for the field (0, y - level, 0): the
/// section at the level does not contribute.
fn volume_below(mesh: &Mesh, place: impl Fn(Vec3) -> Vec3, level: f64) -> f64 {
    let mut sum = 0.0;
    for triangle in &mesh.triangles {
        let corners = triangle.map(|i| {
            let x = place(Vec3::from(mesh.vertices[i as usize])).as_dvec3();
            x.with_y(x.y - level)
        });
        let mut wet = Vec::with_capacity(4);
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i], corners[j])) {
            if a.y < 0.0 {
                wet.push(a);
            }
            if (a.y < 0.0) != (b.y < 0.0) {
                wet.push(a.lerp(b, a.y / (a.y - b.y)));
            }
        }
        for pair in wet.windows(2).skip(1) {
            let normal = (pair[0] - wet[0]).cross(pair[1] - wet[0]);
            sum += 0.5 * normal.y * (wet[0].y + pair[0].y + pair[1].y) / 3.0;
        }
    }
    sum
}

/// A mesh with its longest side scaled to [`LENGTH`], centred at the origin.
fn fitted(mut mesh: Mesh) -> Mesh {
    let corners = || mesh.vertices.iter().map(|v| Vec3::from(*v));
    let (low, high) = (corners().reduce(Vec3::min).unwrap(), corners().reduce(Vec3::max).unwrap());
    let scale = LENGTH / (high - low).max_element();
    for vertex in &mut mesh.vertices {
        *vertex = ((Vec3::from(*vertex) - 0.5 * (low + high)) * scale).to_array();
    }
    mesh
}

/// A torus about the y axis with these radii in m.
fn torus(major: f32, minor: f32) -> Mesh {
    const RING: u32 = 96;
    const TUBE: u32 = 48;
    let angle = |k: u32, of: u32| std::f32::consts::TAU * k as f32 / of as f32;
    let point = |k: u32| {
        let (u, v) = (angle(k / TUBE, RING), angle(k % TUBE, TUBE));
        let radius = major + minor * v.cos();
        [radius * u.cos(), minor * v.sin(), radius * u.sin()]
    };
    let index = |i: u32, j: u32| (i % RING) * TUBE + j % TUBE;
    let quad = |k: u32| {
        let (i, j) = (k / TUBE, k % TUBE);
        let [a, b, c, d] = [index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i + 1, j)];
        [[a, b, c], [a, c, d]]
    };
    Mesh::new((0..RING * TUBE).map(point).collect(), (0..RING * TUBE).flat_map(quad).collect())
}

/// The submerged share over time of a body that floats, over that of Archimedes for [`DENSITY`], and its largest heel in
/// degrees. `density` is that of the body over that of water.
fn float(solver: &str, boundary: BoundaryKind, across: u32, mesh: &Mesh, density: f64) -> (Series, f64) {
    let spacing = LENGTH / across as f32;
    let fit = |length: f32| (length / spacing).round() * spacing;
    let (side, depth) = (fit(SIDE), fit(DEPTH));
    let mut scene = scene(&format!(
        "[scene]\nname = \"floating\"\nduration = 3\n[domain]\nmin = [0, 0, 0]\nmax = [{side}, 0.5, {side}]\nopen = [\"y_max\"]\n\
         [fluid]\nparticle_spacing = {spacing}\nviscosity = 1e-6\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [{side}, {depth}, {side}]\n\
         [solver]\n{solver}\n"
    ));
    let volume = mesh.volume();
    let upright = |height: f32| move |x: Vec3| x + Vec3::Y * height;
    let (mut low, mut high) = (-LENGTH, LENGTH);
    for _ in 0..40 {
        let height = 0.5 * (low + high);
        if volume_below(mesh, upright(height), 0.0) > DENSITY * volume { low = height } else { high = height }
    }
    let folder = tempfile::tempdir().unwrap();
    let motion = Motion::Dynamic {
        density: 1000.0 * density as f32,
        velocity: Vec3::ZERO,
        angular_velocity: Vec3::ZERO,
        hinge: None,
    };
    let place = Vec3::new(0.5 * side, depth + low, 0.5 * side);
    let mut float = body("float", file(folder.path(), "float.ply", mesh), 1.0, place, motion);
    float.boundary = boundary;
    scene.bodies.push(float);

    let mut simulation = at_rest(&scene, |x| depth - x.y);
    let water = simulation.particles().unwrap().positions.len() as f64 * f64::from(spacing).powi(3);
    let level = (water + DENSITY * volume) / f64::from(side).powi(2);
    let share = |state: &BodyState| {
        volume_below(mesh, |x| state.position + state.orientation * x, level) / volume / DENSITY
    };
    let (mut shares, mut heel) = (Series::new(), 0.0f32);
    for k in 1..=(END / 0.02) as u32 {
        let stats = simulation.advance(0.02).unwrap();
        assert_eq!((stats.non_finite, stats.escaped), (0, 0), "{stats:?}");
        let state = simulation.body_states().unwrap()[0];
        shares.push((0.02 * f64::from(k), share(&state)));
        heel = heel.max((state.orientation * Vec3::Y).angle_between(Vec3::Y));
    }
    (shares, f64::from(heel.to_degrees()))
}

/// The mean of the settled shares.
fn settled(shares: &Series) -> f64 {
    let late: Vec<f64> = shares.iter().filter(|point| point.0 > SETTLED).map(|point| point.1).collect();
    late.iter().sum::<f64>() / late.len() as f64
}

fn measure(
    figures: &mut Figures,
    variant: &Variant,
    across: u32,
    name: &str,
    mesh: &Mesh,
    floats_flat: bool,
) {
    let boundary = if variant.name == PARTICLES { BoundaryKind::Particles } else { BoundaryKind::Map };
    let (shares, heel) = float(variant.keys, boundary, across, mesh, DENSITY);
    figures.error(share_of(name), settled(&shares) - 1.0);
    if floats_flat {
        figures.error(format!("largest heel in degrees, {name}"), heel);
    }
    figures.plot(
        &format!("Submerged share over that of Archimedes, {name}"),
        ["time, s", "share over 0.3"],
        &vec![(0.0, 1.0), (END, 1.0)],
        &shares,
    );
}

/// The name of the figure of a shape.
fn share_of(name: &str) -> String {
    format!("submerged share over that of Archimedes, minus one, {name}")
}

#[test]
fn floating_shapes_displace_their_weight() {
    if !is_validation() {
        eprintln!("SKIPPED: floating shapes take minutes; run `cargo xtask validate`");
        return;
    }
    let spot = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/meshes/spot.obj");
    let half = 0.5 * Vec3::new(LENGTH, 0.2 * LENGTH, LENGTH);
    let spot = spot.exists().then(|| fitted(splashdown_io::read_mesh(&spot).unwrap()));
    if spot.is_none() {
        eprintln!("SKIPPED: spot.obj does not exist");
    }
    let shapes = [
        ("torus", Some(fitted(torus(0.7, 0.3))), true),
        ("plate", Some(meshes::cuboid(-half, half)), true),
        ("figure", Some(fitted(splashdown::models::build("figure").unwrap())), false),
        ("Spot", spot, false),
    ];
    SHAPES.run(|variant, across, figures| {
        for (name, mesh, floats_flat) in &shapes {
            match mesh {
                Some(mesh) => measure(figures, variant, across, name, mesh, *floats_flat),
                None => figures.omit(share_of(name)),
            }
        }
    });
}

#[test]
fn another_density_of_a_floating_torus_is_detected() {
    let mut figures = Figures::new(&SHAPES, CONTROL.name, 10);
    let mesh = fitted(torus(0.7, 0.3));
    let (shares, _) = float("method = \"dfsph\"", BoundaryKind::Map, 10, &mesh, 1.1 * DENSITY);
    figures.measure("the same for 1.1 times the density, torus", settled(&shares) - 1.0);
    figures.close();
}

#[test]
fn the_volume_below_a_level_is_that_of_the_cut_mesh() {
    let cube = meshes::cuboid(Vec3::ZERO, Vec3::ONE);
    let turned = |x: Vec3| Quat::from_rotation_z(std::f32::consts::FRAC_PI_4) * x;
    assert!((volume_below(&cube, |x| x, 0.25) - 0.25).abs() < 1e-6);
    assert!((volume_below(&cube, turned, 0.5f64.sqrt()) - 0.5).abs() < 1e-6);
    assert!((volume_below(&cube, turned, 0.1) - 0.01).abs() < 1e-6);
    let ring = fitted(torus(0.7, 0.3));
    assert!((volume_below(&ring, |x| x, 0.0) / ring.volume() - 0.5).abs() < 1e-4);
    assert_eq!((volume_below(&cube, |x| x, -1.0), volume_below(&cube, |x| x, 2.0)), (0.0, 1.0));
}
