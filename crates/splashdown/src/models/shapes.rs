//! Shapes given corner by corner.

use splashdown_io::Mesh;

/// A box of these edge lengths in m round the origin.
pub(super) fn cuboid(size: [f32; 3]) -> Mesh {
    let corner = |k: usize| [0, 1, 2].map(|axis| size[axis] * ((k >> axis & 1) as f32 - 0.5));
    let triangles = vec![
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    Mesh { vertices: (0..8).map(corner).collect(), normals: Vec::new(), triangles }
}
