//! The mesh of water that touches bodies.

use glam::Vec3;
use splashdown_gpu::{CpuExecutor, Executor, testing};
use splashdown_io::Mesh;

use crate::scene::Scene;
use crate::surface::reconstruct_with;
use crate::{Device, Simulation};

const SPACING: f32 = 0.05;
const DEPTH: f32 = 0.7;
const CUBE: (Vec3, f32) = (Vec3::new(0.43, 0.31, 0.41), 0.33);
const BALL: (Vec3, f32) = (Vec3::new(0.93, 0.33, 0.47), 0.21);

/// A tank with a cube and a ball under water at a time in s, with these keys of `[surface]`.
fn simulation(surface: &str, executor: Executor, time: f32) -> (Scene, Simulation) {
    let ((cube, edge), (ball, radius)) = (CUBE, BALL);
    let body = |name: &str, mesh: &str, scale: f32, at: Vec3| {
        let [x, y, z] = at.to_array();
        format!(
            "[[body]]\nname = \"{name}\"\nmesh = \"{mesh}\"\nscale = {scale}\nposition = [{x}, {y}, {z}]\n"
        )
    };
    let text = format!(
        "[scene]\nname = \"bodies\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1.3, 1.0, 0.9]\n[fluid]\n\
         particle_spacing = {SPACING}\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [1.3, {DEPTH}, 0.9]\n{}{}\
         [surface]\n{surface}\n",
        body("cube", "cube", edge, cube),
        body("ball", "sphere", 10.0 * radius, ball),
    );
    let scene = Scene::parse(&text, "bodies").unwrap_or_else(|errors| panic!("{errors}"));
    let mut simulation = Simulation::with_executor(&scene, executor).unwrap();
    if time > 0.0 {
        simulation.advance(time).unwrap();
    }
    (scene, simulation)
}

/// The signed distance of a point from the cube and from the ball in spacings.
fn distances(x: Vec3) -> [f32; 2] {
    let ((cube, edge), (ball, radius)) = (CUBE, BALL);
    let beyond = (x - cube).abs() - 0.5 * edge;
    let of_cube = beyond.max(Vec3::ZERO).length() + beyond.max_element().min(0.0);
    [of_cube, x.distance(ball) - radius].map(|distance| distance / SPACING)
}

/// Number of vertices under water near the bodies, and their largest distances from the cube and from the ball.
fn misplaced(mesh: &Mesh) -> (usize, [f32; 2]) {
    let (mut count, mut largest) = (0, [0.0_f32; 2]);
    for x in &mesh.vertices {
        let x = Vec3::from(*x);
        let is_free = x.y > DEPTH - 2.0 * SPACING;
        for (largest, distance) in largest.iter_mut().zip(distances(x)) {
            if !is_free && distance < 1.0 {
                count += 1;
                *largest = largest.max(distance.abs());
            }
        }
    }
    (count, largest)
}

#[test]
fn the_mesh_touches_bodies() {
    for (kernels, smoothing) in [("isotropic", 0), ("isotropic", 15), ("anisotropic", 15)] {
        let keys = format!("kernels = \"{kernels}\"\nsmoothing_iterations = {smoothing}");
        for (name, executor) in testing::executors("the_mesh_touches_bodies") {
            let (scene, mut simulation) = simulation(&keys, executor, 0.2);
            let mut surface = simulation.surface(&scene.surface).unwrap();
            simulation.extract(&mut surface).unwrap();
            let mesh = simulation.mesh(&surface).unwrap();
            assert!(mesh.topology().unwrap().is_watertight(), "{name} {keys}");
            let (count, largest) = misplaced(&mesh);
            assert!(count > 1000 && largest.iter().all(|d| *d < 0.3), "{name} {keys}: {count} {largest:?}");
            // Negative control: the surface of the particles alone ends before the bodies.
            let positions = simulation.particles().unwrap().positions;
            let mut executor = Executor::from(CpuExecutor::new());
            let (without, _) = reconstruct_with(&positions, surface.params(), &mut executor).unwrap();
            let (_, largest) = misplaced(&without);
            assert!(largest[0] > 0.3, "{name} {keys}: {largest:?}");
        }
    }
}

#[test]
fn the_mesh_touches_bodies_at_the_start() {
    for kernels in ["isotropic", "anisotropic"] {
        let executor = Executor::from(CpuExecutor::new());
        let keys = format!("kernels = \"{kernels}\"\nsmoothing_iterations = 5");
        let (scene, mut simulation) = simulation(&keys, executor, 0.0);
        let mut surface = simulation.surface(&scene.surface).unwrap();
        simulation.extract(&mut surface).unwrap();
        let mesh = simulation.mesh(&surface).unwrap();
        let (count, largest) = misplaced(&mesh);
        assert!(count > 1000 && largest.iter().all(|d| *d < 0.3), "{keys}: {count} {largest:?}");
    }
}

/// Number of edges at which two faces lie on each other.
fn folds(mesh: &Mesh) -> usize {
    let corner = |v: u32| Vec3::from(mesh.vertices[v as usize]);
    let mut faces = std::collections::HashMap::new();
    let mut count = 0;
    for &[a, b, c] in &mesh.triangles {
        let normal = (corner(b) - corner(a)).cross(corner(c) - corner(a)).normalize_or_zero();
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if let Some(other) = faces.insert((from.min(to), from.max(to)), normal) {
                count += usize::from(normal.dot(other) < -0.95);
            }
        }
    }
    count
}

#[test]
fn smoothing_turns_few_triangles_over() {
    // Over 0.5 s, up to 8 of 35,000 edges are folded, and none before smoothing.
    const MOST: f64 = 1.0 / 2000.0;
    let share = |mesh: &Mesh| folds(mesh) as f64 / (1.5 * mesh.triangles.len() as f64);
    for kernels in ["isotropic", "anisotropic"] {
        for (name, executor) in testing::executors("smoothing_turns_few_triangles_over") {
            let keys = format!("kernels = \"{kernels}\"\nsmoothing_iterations = 5");
            let (scene, mut simulation) = simulation(&keys, executor, 0.2);
            let mut surface = simulation.surface(&scene.surface).unwrap();
            simulation.extract(&mut surface).unwrap();
            let mut mesh = simulation.mesh(&surface).unwrap();
            assert!(share(&mesh) < MOST, "{name} {kernels}: {} folds", folds(&mesh));
            // Control: one triangle in a thousand is turned over.
            for triangle in mesh.triangles.iter_mut().step_by(1000) {
                triangle.swap(1, 2);
            }
            assert!(share(&mesh) > MOST, "{name} {kernels}: {} folds", folds(&mesh));
        }
    }
}

#[test]
fn water_beside_a_body_is_level() {
    // A column through the surface.
    let text = format!(
        "[scene]\nname = \"column\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1.0, 1.0, 0.9]\n[fluid]\n\
         particle_spacing = {SPACING}\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [1.0, 0.5, 0.9]\n[[body]]\n\
         name = \"column\"\nmesh = \"cube\"\nscale = 0.3\nposition = [0.5, 0.5, 0.45]\n[surface]\n\
         smoothing_iterations = 15\n"
    );
    let scene = Scene::parse(&text, "column").unwrap_or_else(|errors| panic!("{errors}"));
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    let mut surface = simulation.surface(&scene.surface).unwrap();
    simulation.extract(&mut surface).unwrap();
    let mesh = simulation.mesh(&surface).unwrap();
    let beside = mesh.vertices.iter().zip(&mesh.normals).filter(|(x, n)| {
        let out = ((x[0] - 0.5).abs().max((x[2] - 0.45).abs()) - 0.15) / SPACING;
        (0.2..1.5).contains(&out) && n[1] > 0.7
    });
    let offsets: Vec<f32> = beside.map(|(x, _)| (x[1] - 0.5) / SPACING).collect();
    let largest = offsets.iter().fold(0.0_f32, |most, offset| most.max(offset.abs()));
    assert!(offsets.len() > 40 && largest < 0.3, "{}: {largest} spacings", offsets.len());
}
