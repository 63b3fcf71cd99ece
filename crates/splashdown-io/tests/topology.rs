//! Volume, area and topology, with a control for every defect that is counted.

mod common;

use common::{cube, joined, torus};
use splashdown_io::{IoError, Mesh, Topology};

fn report(mesh: &Mesh) -> Topology {
    mesh.topology().expect("a well-formed mesh")
}

#[test]
fn a_cube_is_watertight_with_its_volume_and_area() {
    let cube = cube([0.0; 3], 2.0);
    let topology = report(&cube);
    assert!(topology.is_watertight(), "{topology}");
    assert_eq!((topology.vertices, topology.edges, topology.triangles), (8, 18, 12));
    assert_eq!((topology.euler_characteristic, topology.components), (2, 1));
    assert_eq!(cube.volume(), 8.0);
    assert_eq!(cube.area(), 24.0);
}

#[test]
fn a_torus_has_euler_characteristic_zero_and_pappus_volume() {
    let torus = torus(2.0, 0.5, 400, 200);
    let topology = report(&torus);
    assert!(topology.is_watertight(), "{topology}");
    assert_eq!(topology.euler_characteristic, 0);
    // An inscribed polygon of n sides has (2 pi / n)^2 / 6 less area than the circle: 2e-4 for 200 sides.
    let (volume, area) =
        (2.0 * std::f64::consts::PI.powi(2) * 2.0 * 0.25, 4.0 * std::f64::consts::PI.powi(2));
    assert!((torus.volume() / volume - 1.0).abs() < 3e-4, "{}", torus.volume());
    assert!((torus.area() / area - 1.0).abs() < 3e-4, "{}", torus.area());
}

#[test]
fn an_inside_out_mesh_has_negative_volume_and_is_oriented() {
    let mut cube = cube([0.0; 3], 1.0);
    cube.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    assert_eq!(cube.volume(), -1.0);
    assert!(report(&cube).is_watertight());
}

#[test]
fn volume_is_accurate_far_from_the_origin() {
    // At 4096 m the corners of a 1/8 m cube are exact in f32, so the volume is exact too.
    assert_eq!(cube([4096.0, -4096.0, 4096.0], 0.125).volume(), 0.125_f64.powi(3));
}

#[test]
fn a_missing_triangle_is_a_hole_of_three_edges() {
    for gone in 0..12 {
        let mut cube = cube([0.0; 3], 1.0);
        cube.triangles.remove(gone);
        let topology = report(&cube);
        assert!(!topology.is_closed() && topology.is_oriented() && topology.is_manifold(), "{topology}");
        assert_eq!((topology.boundary_edges, topology.euler_characteristic), (3, 1));
        assert!(topology.to_string().starts_with("not watertight: 3 boundary edges; "), "{topology}");
    }
}

#[test]
fn a_flipped_triangle_has_three_flipped_edges() {
    for flipped in 0..12 {
        let mut cube = cube([0.0; 3], 1.0);
        cube.triangles[flipped].swap(1, 2);
        let topology = report(&cube);
        assert!(topology.is_closed() && topology.is_manifold() && !topology.is_oriented(), "{topology}");
        assert_eq!((topology.flipped_edges, topology.non_manifold_vertices), (3, 0));
    }
}

#[test]
fn a_doubled_triangle_makes_non_manifold_edges() {
    let mut cube = cube([0.0; 3], 1.0);
    cube.triangles.push(cube.triangles[4]);
    let topology = report(&cube);
    assert_eq!((topology.non_manifold_edges, topology.boundary_edges, topology.flipped_edges), (3, 0, 0));
    assert!(!topology.is_manifold());
}

#[test]
fn cubes_that_touch_at_a_corner_have_a_non_manifold_vertex() {
    let mut pair = joined(cube([0.0; 3], 1.0), &cube([1.0; 3], 1.0));
    let apart = report(&pair);
    assert!(apart.is_watertight(), "{apart}");
    assert_eq!((apart.components, apart.euler_characteristic), (2, 4));

    // Corner 7 of the first cube is at corner 0 of the second, which is vertex 8.
    pair.triangles.iter_mut().flatten().filter(|index| **index == 8).for_each(|index| *index = 7);
    let pinched = report(&pair);
    assert_eq!((pinched.non_manifold_vertices, pinched.components, pinched.unused_vertices), (1, 1, 1));
    assert!(pinched.is_closed() && pinched.is_oriented() && !pinched.is_manifold(), "{pinched}");
}

#[test]
fn cubes_that_share_an_edge_have_a_non_manifold_edge() {
    let mut pair = joined(cube([0.0; 3], 1.0), &cube([1.0, 1.0, 0.0], 1.0));
    for (from, to) in [(8, 3), (12, 7)] {
        pair.triangles.iter_mut().flatten().filter(|index| **index == from).for_each(|index| *index = to);
    }
    let topology = report(&pair);
    assert_eq!((topology.non_manifold_edges, topology.non_manifold_vertices), (1, 2));
}

#[test]
fn degenerate_triangles_and_unused_vertices_are_counted() {
    let mut cube = cube([0.0; 3], 1.0);
    cube.triangles.push([3, 3, 5]);
    cube.vertices.push([9.0; 3]);
    let topology = report(&cube);
    assert_eq!((topology.degenerate_triangles, topology.unused_vertices), (1, 1));
    assert_eq!((topology.edges, topology.euler_characteristic, topology.is_manifold()), (18, 2, false));
}

#[test]
fn an_empty_mesh_is_closed() {
    let topology = report(&Mesh::default());
    assert!(topology.is_watertight());
    assert_eq!((topology.vertices, topology.components, topology.euler_characteristic), (0, 0, 0));
    assert_eq!((Mesh::default().volume(), Mesh::default().area()), (0.0, 0.0));
    assert!(Mesh::default().is_empty());
}

#[test]
fn a_bad_index_or_length_is_named() {
    let mut mesh = cube([0.0; 3], 1.0);
    mesh.triangles[7][2] = 8;
    assert_eq!(mesh.check(), Err(IoError::IndexOutOfRange { triangle: 7, index: 8, vertices: 8 }));
    assert_eq!(mesh.topology(), Err(mesh.check().unwrap_err()));
    assert!(mesh.volume().is_finite() && mesh.area().is_finite());

    let mut mesh = cube([0.0; 3], 1.0);
    mesh.normals = vec![[0.0, 1.0, 0.0]; 7];
    let message = mesh.check().unwrap_err().to_string();
    assert!(message.contains("`normals` has 7 entries for 8 vertices"), "{message}");
}
