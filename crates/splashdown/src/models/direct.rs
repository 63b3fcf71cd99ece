//! Meshes built triangle by triangle, with exact corners.

use splashdown_io::Mesh;

/// A prism: an outline extruded along z from -`half_width` to +`half_width`. The outline (x, y in m) is
/// counter-clockwise and star-shaped with respect to its first corner. The mesh has no normals because its
/// edges are sharp.
fn prism(outline: &[[f32; 2]], half_width: f32) -> Mesh {
    let count = outline.len() as u32;
    let side = |z: f32| outline.iter().map(move |&[x, y]| [x, y, z]);
    let vertices = side(half_width).chain(side(-half_width)).collect();
    let mut triangles = Vec::new();
    for i in 1..count - 1 {
        triangles.push([0, i, i + 1]);
        triangles.push([count, count + i + 1, count + i]);
    }
    for i in 0..count {
        let j = (i + 1) % count;
        triangles.push([i, count + i, count + j]);
        triangles.push([i, count + j, j]);
    }
    Mesh::new(vertices, triangles)
}

pub(super) fn cube() -> Mesh {
    prism(&[[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]], 0.5)
}

/// The obstacle of SPHERIC test 2 (Kleefsman et al. 2005), which stands lengthwise across the flow along x.
pub(super) fn marin_box() -> Mesh {
    prism(&[[-0.0805, 0.0], [0.0805, 0.0], [0.0805, 0.161], [-0.0805, 0.161]], 0.2015)
}

pub(super) fn ramp() -> Mesh {
    prism(&[[0.5, 0.0], [0.5, 0.3], [-0.5, 0.0]], 0.25)
}

pub(super) fn steps() -> Mesh {
    let mut outline = vec![[0.5, 0.0], [0.5, 0.5]];
    for i in (1..=5_u8).rev() {
        let (x, top) = (-0.7 + 0.2 * f32::from(i), 0.1 * f32::from(i));
        outline.extend([[x, top], [x, top - 0.1]]);
    }
    prism(&outline, 0.25)
}
