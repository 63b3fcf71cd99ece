//! Removal of small connected components of a surface: single particles and spray.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use splashdown_io::Mesh;

/// Removes the connected components of a mesh that enclose less than `volume` m^3; returns their
/// number.
///
/// Bubbles have triangles that face inwards and a negative volume; they remain. A closed mesh
/// remains closed. The remaining vertices keep their order, normals and velocities.
pub fn remove_small_components(mesh: &mut Mesh, volume: f64) -> usize {
    take_small_components(mesh, volume).len()
}

/// As [`remove_small_components`]; returns the bounding boxes of the components, lower and upper corner in m.
pub fn take_small_components(mesh: &mut Mesh, volume: f64) -> Vec<[[f32; 3]; 2]> {
    let components = Components::of(mesh);
    // Relative to a vertex of the component, which avoids cancellation far from the origin.
    let mut six_fold = vec![0.0; mesh.vertices.len()];
    let place = |vertex: u32| DVec3::from(mesh.vertices[vertex as usize].map(f64::from));
    for &[a, b, c] in &mesh.triangles {
        let piece = components.roots[a as usize];
        let [a, b, c] = [a, b, c].map(|corner| place(corner) - place(piece));
        six_fold[piece as usize] += a.dot(b.cross(c));
    }
    let is_small = |piece: &u32| (0.0..6.0 * volume).contains(&six_fold[*piece as usize]);
    let mut boxes = components.boxes.clone();
    boxes.retain(|piece, _| is_small(piece));
    components.remove(mesh, |piece| boxes.contains_key(&piece));
    boxes.into_values().map(|corners| corners.map(Into::into)).collect()
}

/// Removes the connected components of a mesh for whose bounding box, lower and upper corner in m, `keep` is false; returns
/// their number. The remaining vertices keep their order, normals, velocities and attributes.
pub fn retain_components(mesh: &mut Mesh, mut keep: impl FnMut([Vec3; 2]) -> bool) -> usize {
    let components = Components::of(mesh);
    let mut removed = components.boxes.clone();
    removed.retain(|_, corners| !keep(*corners));
    components.remove(mesh, |piece| removed.contains_key(&piece));
    removed.len()
}

/// The connected components of a mesh. Their smallest vertices identify them.
struct Components {
    /// The component of each vertex.
    roots: Vec<u32>,
    /// Bounding boxes.
    boxes: BTreeMap<u32, [Vec3; 2]>,
}

impl Components {
    fn of(mesh: &Mesh) -> Self {
        let mut parents: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
        for &[a, b, c] in &mesh.triangles {
            join(&mut parents, a, b);
            join(&mut parents, b, c);
        }
        let roots: Vec<u32> = (0..parents.len() as u32).map(|vertex| root(&mut parents, vertex)).collect();
        let mut boxes: BTreeMap<u32, [Vec3; 2]> = BTreeMap::new();
        for &vertex in mesh.triangles.as_flattened() {
            let at = Vec3::from(mesh.vertices[vertex as usize]);
            let [low, high] = boxes.entry(roots[vertex as usize]).or_insert([at; 2]);
            (*low, *high) = (low.min(at), high.max(at));
        }
        Self { roots, boxes }
    }

    /// Removes components.
    fn remove(&self, mesh: &mut Mesh, is_removed: impl Fn(u32) -> bool) {
        let keep: Vec<bool> = self.roots.iter().map(|&piece| !is_removed(piece)).collect();
        if keep.iter().all(|&keep| keep) {
            return;
        }
        mesh.triangles.retain(|&[a, _, _]| keep[a as usize]);
        retain_vertices(mesh, &keep);
    }
}

/// Removes the vertices whose flag is false, which no triangle uses. The others keep their order, normals, velocities and
/// attributes.
pub(super) fn retain_vertices(mesh: &mut Mesh, keep: &[bool]) {
    let mut number = 0;
    let numbers: Vec<u32> = keep
        .iter()
        .map(|&keep| {
            number += u32::from(keep);
            number.wrapping_sub(1)
        })
        .collect();
    mesh.triangles.as_flattened_mut().iter_mut().for_each(|vertex| *vertex = numbers[*vertex as usize]);
    for values in [&mut mesh.vertices, &mut mesh.normals, &mut mesh.velocities] {
        let mut keep = keep.iter();
        values.retain(|_| keep.next().is_some_and(|&keep| keep));
    }
    for attribute in &mut mesh.attributes {
        let mut keep = keep.iter().flat_map(|keep| std::iter::repeat_n(keep, attribute.components));
        attribute.values.retain(|_| keep.next().is_some_and(|&keep| keep));
    }
}

/// The smallest known vertex of the component (union-find).
pub(super) fn root(parents: &mut [u32], mut vertex: u32) -> u32 {
    while parents[vertex as usize] != vertex {
        let above = parents[vertex as usize];
        // Path halving.
        parents[vertex as usize] = parents[above as usize];
        vertex = above;
    }
    vertex
}

/// Unites the sets of two elements (union-find).
pub(super) fn join(parents: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b) as usize] = a.min(b);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{SurfaceParams, reconstruct_with};
    use splashdown_gpu::{CpuExecutor, Executor};
    use splashdown_io::Attribute;

    #[test]
    fn small_components_are_removed_and_the_rest_is_unchanged() {
        let spacing = 0.1;
        let block = (0..512).map(|i| [i % 8, i / 8 % 8, i / 64].map(|c| spacing * c as f32));
        let lone = [[5.0, 0.0, 0.0], [0.0, 5.0, 0.0]];
        let mut executor = Executor::from(CpuExecutor::new());
        let params = SurfaceParams::new(spacing);
        let block: Vec<_> = block.collect();
        let (alone, _) = reconstruct_with(&block, &params, &mut executor).unwrap();
        let (mut mesh, _) = reconstruct_with(&[&block[..], &lone].concat(), &params, &mut executor).unwrap();
        mesh.velocities = mesh.vertices.clone();
        let heights = mesh.vertices.iter().map(|vertex| vertex[1]).collect();
        let places = mesh.vertices.as_flattened().to_vec();
        for (components, values) in [(1, heights), (3, places)] {
            mesh.attributes.push(Attribute { name: "a".to_owned(), components, values });
        }
        let particle = f64::from(spacing).powi(3);
        // The ball of a single particle is slightly larger than the volume of a particle in the
        // bulk.
        assert_eq!(remove_small_components(&mut mesh, 0.1 * particle), 0);
        assert_eq!(mesh.topology().unwrap().components, 3);
        let boxes = take_small_components(&mut mesh, 3.0 * particle);
        assert_eq!(boxes.len(), 2);
        for ([low, high], place) in boxes.into_iter().zip(lone) {
            let (low, high, place) = (Vec3::from(low), Vec3::from(high), Vec3::from(place));
            assert!(
                low.cmplt(place).all()
                    && high.cmpgt(place).all()
                    && (high - low).max_element() < 2.0 * spacing
            );
        }
        assert_eq!(mesh.vertices.len(), alone.vertices.len());
        assert_eq!(mesh.velocities, mesh.vertices);
        assert!(mesh.vertices.iter().map(|vertex| vertex[1]).eq(mesh.attributes[0].values.iter().copied()));
        assert_eq!(mesh.attributes[1].values, mesh.vertices.as_flattened());
        let topology = mesh.topology().unwrap();
        assert!(topology.is_watertight() && topology.components == 1 && topology.unused_vertices == 0);
        assert!((mesh.volume() / alone.volume() - 1.0).abs() < 1e-3);
        let mut all = mesh.clone();
        assert_eq!(retain_components(&mut all, |[_, high]| high.max_element() < 1.0), 0);
        assert_eq!(retain_components(&mut all, |[_, high]| high.max_element() > 1.0), 1);
        assert!(all.is_empty() && all.vertices.is_empty());
        assert_eq!(remove_small_components(&mut mesh, 1e9), 1);
        assert!(mesh.is_empty() && mesh.vertices.is_empty());
        assert_eq!(remove_small_components(&mut mesh, 1e9), 0);
    }

    #[test]
    fn bubbles_are_kept() {
        let mut mesh = Mesh::new(
            vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [0, 2, 3]],
        );
        assert!(mesh.volume() < 0.0);
        assert_eq!(remove_small_components(&mut mesh, 1e9), 0);
    }
}
