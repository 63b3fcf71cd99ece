//! Meshes of boxes and tanks with sharp edges, shared by test programs.

use glam::Vec3;
use splashdown_io::Mesh;

/// The eight corners of a box, x fastest.
fn corners(min: Vec3, max: Vec3) -> [[f32; 3]; 8] {
    std::array::from_fn(|k| {
        let pick = |axis: usize| if k >> axis & 1 == 0 { min[axis] } else { max[axis] };
        [pick(0), pick(1), pick(2)]
    })
}

/// The outward faces of a box, without the one with this index in [-x, +x, -y, +y, -z, +z].
fn faces(first: u32, without: Option<usize>) -> Vec<[u32; 3]> {
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let kept = quads.iter().enumerate().filter(|(face, _)| Some(*face) != without);
    kept.flat_map(|(_, [a, b, c, d])| [[*a, *b, *c], [*a, *c, *d]])
        .map(|triangle| triangle.map(|corner: u32| first + corner))
        .collect()
}

/// A box with sharp edges.
pub fn cuboid(min: Vec3, max: Vec3) -> Mesh {
    Mesh::new(corners(min, max).to_vec(), faces(0, None))
}

/// A tank with walls of this thickness around an inner box, open at the top.
pub fn tub(min: Vec3, max: Vec3, wall: f32) -> Mesh {
    let outer = corners(min - Vec3::splat(wall), max.with_x(max.x + wall).with_z(max.z + wall));
    let vertices = [outer, corners(min, max)].concat();
    let mut triangles = faces(0, Some(3));
    // The inner faces have the opposite orientation.
    triangles.extend(faces(8, Some(3)).iter().map(|&[a, b, c]| [a, c, b]));
    // The rim connects the upper corners of both boxes.
    let ring = [2, 6, 7, 3];
    for k in 0..4 {
        let (a, b) = (ring[k], ring[(k + 1) % 4]);
        triangles.extend([[a, b, b + 8], [a, b + 8, a + 8]]);
    }
    Mesh::new(vertices, triangles)
}
