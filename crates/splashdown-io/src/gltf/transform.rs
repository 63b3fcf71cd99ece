//! The transforms of a scene's nodes.

use super::document::{Document, Node};

/// Three rows of a 4 x 4 matrix that maps positions to positions.
pub(super) type Affine = [[f64; 4]; 3];

const IDENTITY: Affine = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// The nodes of the default scene with their transforms into the coordinates of the scene, parents before children.
///
/// A node has at most one parent; otherwise a file could contain a cycle, or a graph with exponentially many paths.
pub(super) fn nodes_with_transforms(document: &Document) -> Result<Vec<(&Node, Affine)>, String> {
    let number = document.scene.unwrap_or(0);
    let scenes = document.scenes.len();
    let scene = document
        .scenes
        .get(number)
        .ok_or_else(|| format!("its scene is number {number}, but it has {scenes} (numbered from 0)"))?;
    let mut seen = vec![false; document.nodes.len()];
    let mut open: Vec<(usize, Affine)> = scene.nodes.iter().map(|&node| (node, IDENTITY)).rev().collect();
    let mut placed = Vec::new();
    while let Some((index, parent)) = open.pop() {
        let Some(node) = document.nodes.get(index) else {
            return Err(format!("it uses node {index}, but has {} (numbered from 0)", seen.len()));
        };
        if std::mem::replace(&mut seen[index], true) {
            return Err(format!("node {index} is a child of more than one node, or of itself"));
        }
        let transform = product(&parent, &local(node));
        placed.push((node, transform));
        open.extend(node.children.iter().map(|&child| (child, transform)));
    }
    Ok(placed)
}

/// The transform of a node: a matrix by columns, or scale, then rotation (a quaternion x y z w), then translation.
fn local(node: &Node) -> Affine {
    if let Some(columns) = node.matrix {
        return std::array::from_fn(|row| std::array::from_fn(|column| columns[4 * column + row]));
    }
    let [x, y, z, w] = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let rotation = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let scale = node.scale.unwrap_or([1.0; 3]);
    let translation = node.translation.unwrap_or_default();
    std::array::from_fn(|row| {
        let [a, b, c] = std::array::from_fn(|column| rotation[row][column] * scale[column]);
        [a, b, c, translation[row]]
    })
}

/// The product of two matrices: `child` is applied first.
fn product(parent: &Affine, child: &Affine) -> Affine {
    parent.map(|row| {
        std::array::from_fn(|column| {
            let sum: f64 = (0..3).map(|k| row[k] * child[k][column]).sum();
            sum + if column == 3 { row[3] } else { 0.0 }
        })
    })
}

/// Transforms a position.
pub(super) fn apply(transform: &Affine, [x, y, z]: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = [x, y, z].map(f64::from);
    transform.map(|[a, b, c, d]| (a * x + b * y + c * z + d) as f32)
}

/// Whether a transform is a reflection, that is, has a negative determinant.
pub(super) fn mirrors([a, b, c]: &Affine) -> bool {
    let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
    a[0] * minor(1, 2) - a[1] * minor(0, 2) + a[2] * minor(0, 1) < 0.0
}
