//! Classification against a brute-force search, and the surface without isolated particles.

use glam::Vec3;
use splashdown_gpu::{CpuExecutor, Executor, testing};
use splashdown_io::{Mesh, Particles};

use super::{droplet_radius, droplets_of, isolated};
use crate::surface::{Surface, SurfaceParams, SurfaceStats, reconstruct, reconstruct_with};

const SPACING: f32 = 0.1;

fn params(min_blob: u32, min_neighbours: u32) -> SurfaceParams {
    SurfaceParams { min_blob, min_neighbours, ..SurfaceParams::new(SPACING) }
}

/// A lattice of particles.
fn lattice([nx, ny, nz]: [u32; 3], corner: [f32; 3]) -> Vec<[f32; 3]> {
    let place = |i: u32| [i % nx, i / nx % ny, i / nx / ny];
    let x = |i| Vec3::from(corner) + SPACING * Vec3::from(place(i).map(|c| c as f32));
    (0..nx * ny * nz).map(|i| x(i).to_array()).collect()
}

fn count(positions: &[[f32; 3]], min_blob: u32, min_neighbours: u32) -> usize {
    isolated(positions, &params(min_blob, min_neighbours)).unwrap().len()
}

#[test]
fn blocks_and_films_are_not_isolated() {
    for size in [[8, 8, 8], [12, 2, 12], [12, 1, 12], [3, 3, 1], [4, 4, 2]] {
        let particles = lattice(size, [0.0; 3]);
        assert_eq!(count(&particles, 9, 3), 0, "{size:?}");
    }
    // Negative controls: a row of single particles, and the corners of a film for a higher limit.
    assert_eq!(count(&lattice([30, 1, 1], [0.0; 3]), 9, 3), 30);
    assert_eq!(count(&lattice([12, 1, 12], [0.0; 3]), 9, 4), 4);
}

#[test]
fn blobs_are_counted_by_particles() {
    for (size, number) in [([1, 1, 1], 1), ([2, 1, 1], 2), ([2, 2, 2], 8), ([4, 2, 1], 8), ([3, 3, 1], 9)] {
        let blob = lattice(size, [0.0; 3]);
        for min_blob in 0..=32 {
            let expected = if number < min_blob { number } else { 0 };
            assert_eq!(count(&blob, min_blob, 0), expected as usize, "{size:?} below {min_blob}");
        }
    }
    // A row of five has one neighbour at its ends and two elsewhere.
    let row = lattice([5, 1, 1], [0.0; 3]);
    assert_eq!([1, 2, 3].map(|least| count(&row, 0, least)), [0, 2, 5]);
}

#[test]
fn links_end_at_nine_tenths_of_the_support() {
    let pair = |distance: f32| [[0.0; 3], [distance * 2.0 * SPACING, 0.0, 0.0]];
    assert_eq!(count(&pair(0.899), 2, 0), 0);
    assert_eq!(count(&pair(0.901), 2, 0), 2);
}

/// Isolated particles by the definition: the sizes of the connected components, by comparing all pairs.
fn brute_force(positions: &[[f32; 3]], params: &SurfaceParams) -> Vec<u32> {
    let n = positions.len();
    let distance = |i: usize, j: usize| Vec3::from(positions[i]).distance(positions[j].into());
    let is_linked = |i: usize, j: usize| i != j && distance(i, j) < 0.9 * params.support_radius;
    let mut blob: Vec<usize> = (0..n).collect();
    loop {
        let lowest =
            |i: usize| (0..n).filter(|&j| is_linked(i, j)).map(|j| blob[j]).fold(blob[i], usize::min);
        let next: Vec<usize> = (0..n).map(lowest).collect();
        if next == blob {
            break;
        }
        blob = next;
    }
    let size = |i: usize| (0..n).filter(|&j| blob[j] == blob[i]).count();
    let neighbours = |i: usize| (0..n).filter(|&j| is_linked(i, j)).count();
    let is_isolated =
        |i: &usize| size(*i) < params.min_blob as usize || neighbours(*i) < params.min_neighbours as usize;
    (0..n).filter(is_isolated).map(|i| i as u32).collect()
}

/// Random particles, sparse enough for blobs of all sizes.
fn spray(seed: u32) -> Vec<[f32; 3]> {
    let unit = |i: u32| testing::noise(1000 * seed + i) as f32 / u32::MAX as f32;
    (0..300).map(|i| [0, 1, 2].map(|axis| 1.3 * unit(3 * i + axis))).collect()
}

#[test]
fn classification_agrees_with_a_comparison_of_all_pairs() {
    for seed in 0..8 {
        let positions = spray(seed);
        for (min_blob, min_neighbours) in
            [(2, 0), (9, 0), (32, 0), (0, 3), (9, 3), (4, 6), (0, 32), (40, 0), (100, 3)]
        {
            let params = params(min_blob, min_neighbours);
            let expected = brute_force(&positions, &params);
            assert_eq!(isolated(&positions, &params).unwrap(), expected, "{min_blob} {min_neighbours}");
            // Control: the cases are neither empty nor complete, except for the highest limit.
            let is_partial = !expected.is_empty() && expected.len() < positions.len();
            assert!(is_partial || min_neighbours == 32 || min_blob >= 32, "{}", expected.len());
        }
    }
}

/// The mesh, and the droplets of an extraction.
fn extract(
    positions: &[[f32; 3]],
    params: &SurfaceParams,
    executor: &mut Executor,
) -> (Mesh, Particles, SurfaceStats) {
    let points: Vec<Vec3> = positions.iter().map(|&x| x.into()).collect();
    let input = reconstruct::upload(executor, &points, params).unwrap();
    let mut surface = Surface::new(executor, *params, input).unwrap();
    let stats = surface.extract(executor).unwrap();
    let droplets = splashdown_gpu::block_on(surface.droplets_async(executor)).unwrap();
    (surface.mesh(executor).unwrap(), droplets, stats)
}

#[test]
fn both_executors_list_the_isolated_particles() {
    for (name, mut executor) in testing::executors("both_executors_list_the_isolated_particles") {
        for positions in
            [spray(1), [lattice([7, 7, 7], [0.3; 3]), spray(2)].concat(), lattice([1, 1, 1], [0.0; 3])]
        {
            let params = params(9, 3);
            let expected = isolated(&positions, &params).unwrap();
            let (mesh, droplets, stats) = extract(&positions, &params, &mut executor);
            assert_eq!((&droplets.ids, stats.droplets as usize), (&expected, expected.len()), "{name}");
            let all = Particles::from_positions(positions.clone());
            assert_eq!(droplets.positions, droplets_of(&all, &expected, SPACING).positions, "{name}");
            assert_eq!(mesh.is_empty(), expected.len() == positions.len(), "{name}");
        }
    }
}

#[test]
fn the_mesh_excludes_isolated_particles() {
    let block = lattice([8, 8, 8], [0.0; 3]);
    let drops = [lattice([2, 2, 1], [1.5, 0.0, 0.0]), lattice([1, 1, 1], [0.0, 2.0, 0.0])].concat();
    let both = [&block[..], &drops].concat();
    let mut executor = Executor::from(CpuExecutor::new());
    let mut volume = |positions: &[[f32; 3]], min_blob| {
        let (mesh, stats) = reconstruct_with(positions, &params(min_blob, 0), &mut executor).unwrap();
        let topology = mesh.topology().unwrap();
        assert!(topology.is_watertight(), "{topology}");
        (topology.components, mesh.volume(), stats.droplets)
    };
    let (components, alone, _) = volume(&block, 0);
    assert_eq!(components, 1);
    let (components, separated, droplets) = volume(&both, 9);
    assert_eq!((components, droplets), (1, 5));
    assert!((separated / alone - 1.0).abs() < 1e-5, "{separated} {alone}");
    // Negative control: without separation the drops are components of the mesh.
    assert_eq!(volume(&both, 0).0, 3);
    // Nothing remains.
    assert_eq!(volume(&drops, 9), (0, 0.0, 5));
}

#[test]
fn droplets_have_the_volume_of_their_particles() {
    let sphere = 4.0 / 3.0 * std::f64::consts::PI * f64::from(droplet_radius(SPACING)).powi(3);
    assert!((sphere / f64::from(SPACING).powi(3) - 1.0).abs() < 1e-6, "{sphere}");
    let particles = Particles::from_positions(lattice([3, 1, 1], [0.0; 3])).with_ids(vec![7, 8, 9]);
    let droplets = droplets_of(&particles, &[2, 0], SPACING);
    assert_eq!((droplets.len(), &droplets.ids), (2, &vec![9, 7]));
    let [width] = &droplets.attributes[..] else { panic!("{:?}", droplets.attributes) };
    assert_eq!((width.name.as_str(), &width.values), ("width", &vec![2.0 * droplet_radius(SPACING); 2]));
}

#[test]
fn limits_above_32_are_refused() {
    let mut executor = Executor::from(CpuExecutor::new());
    for params in [params(33, 0), params(0, 33)] {
        let error = reconstruct_with(&[[0.0; 3]], &params, &mut executor).unwrap_err().to_string();
        assert!(error.contains("is 33; it must be at most 32"), "{error}");
    }
    assert!(isolated(&[], &params(32, 32)).unwrap().is_empty());
}
