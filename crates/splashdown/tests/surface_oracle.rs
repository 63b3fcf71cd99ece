//! The surface compared with `splashsurf_lib`, an independent implementation, with equal
//! parameters.

use std::collections::HashMap;
use std::io::Write;
use std::path::Path;

use glam::{IVec3, Vec3};
use rayon::prelude::*;
use splashdown::surface::{SurfaceParams, reconstruct_with};
use splashdown_gpu::testing;
use splashdown_io::{Mesh, npy};
use splashsurf_lib::nalgebra::Vector3;

const SPACING: f32 = 0.05;

fn oracle(points: &[[f32; 3]], params: &SurfaceParams) -> Mesh {
    let points: Vec<_> = points.iter().map(|&p| Vector3::from(p)).collect();
    let mut theirs = splashsurf_lib::Parameters::new(SPACING / 2.0, params.support_radius, params.cell_size);
    theirs.iso_surface_threshold = params.iso_level;
    let mesh = splashsurf_lib::reconstruct_surface::<i64, f32>(&points, &theirs).unwrap().mesh;
    Mesh::new(
        mesh.vertices.iter().map(|&v| v.into()).collect(),
        mesh.triangles.iter().map(|t| t.map(|v| v as u32)).collect(),
    )
}

/// Triangles in a grid of cubes, for the search of the nearest triangle.
struct Cubes {
    size: f32,
    triangles: Vec<[Vec3; 3]>,
    cubes: HashMap<IVec3, Vec<u32>>,
}

impl Cubes {
    fn new(mesh: &Mesh, size: f32) -> Self {
        let corner = |v: u32| Vec3::from(mesh.vertices[v as usize]);
        let triangles: Vec<_> = mesh.triangles.iter().map(|t| t.map(corner)).collect();
        let mut cubes: HashMap<IVec3, Vec<u32>> = HashMap::new();
        for (i, [a, b, c]) in triangles.iter().enumerate() {
            let low = (a.min(*b).min(*c) / size).floor().as_ivec3();
            let high = (a.max(*b).max(*c) / size).floor().as_ivec3();
            for (x, y, z) in (low.x..=high.x)
                .flat_map(|x| (low.y..=high.y).flat_map(move |y| (low.z..=high.z).map(move |z| (x, y, z))))
            {
                cubes.entry(IVec3::new(x, y, z)).or_default().push(i as u32);
            }
        }
        Self { size, triangles, cubes }
    }

    /// Distance to the nearest triangle; infinite if there is none in the adjacent cubes.
    fn distance(&self, p: Vec3) -> f32 {
        let center = (p / self.size).floor().as_ivec3();
        let around = (0..27).map(|i| center + IVec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        let near = around.filter_map(|cube| self.cubes.get(&cube)).flatten();
        near.map(|&t| nearest(p, self.triangles[t as usize]).distance(p)).fold(f32::INFINITY, f32::min)
    }
}

/// The point of a triangle nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
fn nearest(p: Vec3, [a, b, c]: [Vec3; 3]) -> Vec3 {
    let on_side = |from: Vec3, to: Vec3| {
        let side = to - from;
        from + side * ((p - from).dot(side) / side.length_squared().max(1e-30)).clamp(0.0, 1.0)
    };
    let normal = (b - a).cross(c - a);
    let is_inside = |from: Vec3, to: Vec3| (to - from).cross(p - from).dot(normal) >= 0.0;
    if normal.length_squared() > 0.0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a) {
        return p - normal * ((p - a).dot(normal) / normal.length_squared());
    }
    let sides = [on_side(a, b), on_side(b, c), on_side(c, a)];
    sides.into_iter().min_by(|x, y| x.distance(p).total_cmp(&y.distance(p))).unwrap()
}

/// The largest distance of a vertex of one mesh from the other mesh, in both directions.
fn hausdorff(a: &Mesh, b: &Mesh, reach: f32) -> f32 {
    let one_way = |from: &Mesh, to: &Mesh| {
        let cubes = Cubes::new(to, reach);
        from.vertices.par_iter().map(|&v| cubes.distance(v.into())).reduce(|| 0.0, f32::max)
    };
    one_way(a, b).max(one_way(b, a))
}

/// Compares with equal parameters and, as a negative control, with another iso level.
fn agree(points: &[[f32; 3]], cell_ratio: f32, test_name: &str) {
    let params = {
        let mut params = SurfaceParams::new(SPACING);
        params.cell_size = cell_ratio * SPACING;
        params
    };
    let cell = params.cell_size;
    let theirs = oracle(points, &params);
    for (name, mut executor) in testing::executors(test_name) {
        let (ours, _) = reconstruct_with(points, &params, &mut executor).unwrap();
        assert!(ours.topology().unwrap().is_watertight());
        // Both use the same field, but their lattices may be offset by a fraction of a cell.
        let distance = hausdorff(&ours, &theirs, cell) / cell;
        let volume = ours.volume() / theirs.volume();
        assert!(distance < 0.5, "{test_name}, {name}: {distance} cells");
        assert!((volume - 1.0).abs() < 0.01, "{test_name}, {name}: volume ratio {volume}");
        // The smallest relevant change: the iso level at a tenth of a spacing farther outside.
        let other = {
            let mut params = params;
            params.iso_level = 0.5;
            params
        };
        let (control, _) = reconstruct_with(points, &other, &mut executor).unwrap();
        let volume = control.volume() / theirs.volume();
        assert!(volume > 1.01, "{test_name}, {name}: the control's volume ratio is {volume}");
    }
}

#[test]
fn a_splash_agrees_with_splashsurf() {
    let test_name = "a_splash_agrees_with_splashsurf";
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/particles/mid64k.npy");
    if !file.exists() {
        let _ = writeln!(std::io::stderr(), "SKIPPED: {test_name}: the shared test data do not exist");
        return;
    }
    let points = npy::read_positions(&file).unwrap();
    agree(&points, 0.5, test_name);
}

#[test]
fn a_jittered_block_with_drops_agrees_with_splashsurf() {
    let unit = |i: usize| testing::noise(i as u32) as f32 / u32::MAX as f32 - 0.5;
    let mut points: Vec<[f32; 3]> = (0..14 * 14 * 14)
        .map(|i| [i % 14, i / 14 % 14, i / 196].map(|c| c as f32))
        .enumerate()
        .map(|(i, p)| std::array::from_fn(|axis| SPACING * (p[axis] + 0.4 * unit(3 * i + axis))))
        .collect();
    // Single particles and pairs above it.
    points.extend((0..40).map(|i| {
        let place = 50_000 + 3 * i;
        [1.0 * unit(place) + 0.35, 1.1 + 0.6 * unit(place + 1), 1.0 * unit(place + 2) + 0.35]
    }));
    for cell_ratio in [0.5, 0.8] {
        agree(&points, cell_ratio, "a_jittered_block_with_drops_agrees_with_splashsurf");
    }
}
