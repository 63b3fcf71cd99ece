//! A bounding volume hierarchy of triangles, for nearest distances and winding numbers.

use glam::Vec3;

/// Maximum number of triangles in a leaf.
const LEAF: usize = 4;
/// A node is approximated by a dipole beyond this distance, in radii of the node (Barill et al. 2018).
const FAR: f32 = 2.3;

struct Node {
    low: Vec3,
    high: Vec3,
    /// Index of the first child, which the second one follows, or of the first triangle of a leaf.
    first: u32,
    /// Number of triangles of a leaf; 0 for an inner node.
    count: u32,
    /// Area-weighted centre of the node's triangles.
    center: Vec3,
    /// Sum of the triangles' normals times their areas.
    dipole: Vec3,
    /// Distance of the farthest corner from `center`.
    radius: f32,
}

/// The hierarchy of nodes and the triangles in its order.
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    triangles: Vec<[Vec3; 3]>,
}

impl Bvh {
    /// Builds the tree by splitting at the median of the widest axis. `triangles` must not be empty.
    pub fn new(mut triangles: Vec<[Vec3; 3]>) -> Self {
        let mut nodes = Vec::with_capacity(2 * triangles.len() / LEAF + 1);
        nodes.push(summary(&triangles, 0, triangles.len()));
        let mut open = vec![0];
        while let Some(n) = open.pop() {
            let (first, count) = (nodes[n].first as usize, nodes[n].count as usize);
            if count <= LEAF {
                continue;
            }
            let extent = nodes[n].high - nodes[n].low;
            let axis = if extent.x >= extent.y.max(extent.z) {
                0
            } else if extent.y >= extent.z {
                1
            } else {
                2
            };
            let key = |t: &[Vec3; 3]| t[0][axis] + t[1][axis] + t[2][axis];
            let half = count / 2;
            triangles[first..first + count].select_nth_unstable_by(half, |a, b| key(a).total_cmp(&key(b)));
            let child = nodes.len();
            nodes.push(summary(&triangles, first, half));
            nodes.push(summary(&triangles, first + half, count - half));
            (nodes[n].first, nodes[n].count) = (child as u32, 0);
            open.extend([child, child + 1]);
        }
        Self { nodes, triangles }
    }

    /// The distance from `x` to the nearest triangle, at most `most`.
    pub fn distance(&self, x: Vec3, most: f32) -> f32 {
        let mut best = most * most;
        let mut stack = [0u32; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let node = &self.nodes[stack[depth] as usize];
            if box_distance(node, x) >= best {
                continue;
            }
            if node.count > 0 {
                for t in &self.triangles[node.first as usize..(node.first + node.count) as usize] {
                    best = best.min(triangle_distance(x, t));
                }
                continue;
            }
            let [a, b] = [node.first, node.first + 1];
            let [da, db] = [a, b].map(|c| box_distance(&self.nodes[c as usize], x));
            // The nearer child goes on top of the stack, so that it is visited first.
            let order = if da <= db { [b, a] } else { [a, b] };
            stack[depth..depth + 2].copy_from_slice(&order);
            depth += 2;
        }
        best.sqrt()
    }

    /// The distance along a ray to the nearest triangle within `most` that it leaves through the back (`leaving`) or
    /// meets from the front. `direction` is a unit vector.
    pub fn ray(&self, origin: Vec3, direction: Vec3, most: f32, leaving: bool) -> Option<f32> {
        let mut best = most;
        let mut stack = [0u32; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let node = &self.nodes[stack[depth] as usize];
            if !meets_box(node, origin, direction, best) {
                continue;
            }
            if node.count == 0 {
                stack[depth..depth + 2].copy_from_slice(&[node.first, node.first + 1]);
                depth += 2;
                continue;
            }
            for t in &self.triangles[node.first as usize..(node.first + node.count) as usize] {
                let normal = (t[1] - t[0]).cross(t[2] - t[0]);
                if (normal.dot(direction) > 0.0) == leaving
                    && let Some(distance) = ray_distance(origin, direction, t)
                {
                    best = best.min(distance);
                }
            }
        }
        (best < most).then_some(best)
    }

    /// The generalised winding number (Jacobson et al. 2013; far clusters as dipoles: Barill et al. 2018).
    pub fn winding(&self, x: Vec3) -> f32 {
        self.winding_to(x, FAR)
    }

    /// As [`winding`](Self::winding), with clusters as dipoles from this multiple of their radius. The error falls with
    /// its square.
    pub fn winding_to(&self, x: Vec3, far: f32) -> f32 {
        let mut sum = 0.0;
        let mut stack = [0u32; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let node = &self.nodes[stack[depth] as usize];
            let away = node.center - x;
            let r = away.length();
            if r > far * node.radius {
                sum += node.dipole.dot(away) / (r * r * r);
            } else if node.count > 0 {
                for t in &self.triangles[node.first as usize..(node.first + node.count) as usize] {
                    sum += solid_angle(x, t);
                }
            } else {
                stack[depth..depth + 2].copy_from_slice(&[node.first, node.first + 1]);
                depth += 2;
            }
        }
        sum / (4.0 * std::f32::consts::PI)
    }
}

fn summary(triangles: &[[Vec3; 3]], first: usize, count: usize) -> Node {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (mut center, mut dipole, mut area) = (Vec3::ZERO, Vec3::ZERO, 0.0);
    let own = &triangles[first..first + count];
    for t in own {
        let normal = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]);
        let weight = normal.length();
        center += weight * (t[0] + t[1] + t[2]) / 3.0;
        area += weight;
        dipole += normal;
        for &corner in t {
            (low, high) = (low.min(corner), high.max(corner));
        }
    }
    let center = if area > 0.0 { center / area } else { 0.5 * (low + high) };
    let radius = own.iter().flatten().map(|c| c.distance(center)).fold(0.0, f32::max);
    Node { low, high, first: first as u32, count: count as u32, center, dipole, radius }
}

fn box_distance(node: &Node, x: Vec3) -> f32 {
    x.clamp(node.low, node.high).distance_squared(x)
}

/// True if a ray meets the box of a node within the distance `most`.
fn meets_box(node: &Node, origin: Vec3, direction: Vec3, most: f32) -> bool {
    // A component of zero gives infinities of both signs, or NaN on a face, which min and max ignore.
    let (a, b) = ((node.low - origin) / direction, (node.high - origin) / direction);
    let mut range = (0.0_f32, most);
    for axis in 0..3 {
        range.0 = range.0.max(a[axis].min(b[axis]));
        range.1 = range.1.min(a[axis].max(b[axis]));
    }
    range.0 <= range.1
}

/// The distance along a ray to a triangle, in lengths of `direction`, if it hits the triangle (Moeller & Trumbore 1997).
pub fn ray_distance(origin: Vec3, direction: Vec3, &[a, b, c]: &[Vec3; 3]) -> Option<f32> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    if determinant.abs() < f32::MIN_POSITIVE {
        return None;
    }
    let from = origin - a;
    let u = from.dot(across) / determinant;
    let other = from.cross(ab);
    let v = direction.dot(other) / determinant;
    let distance = ac.dot(other) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0).then_some(distance)
}

/// The solid angle of a triangle seen from `x` (van Oosterom & Strackee 1983).
pub(super) fn solid_angle(x: Vec3, t: &[Vec3; 3]) -> f32 {
    let [a, b, c] = t.map(|corner| corner - x);
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let numerator = a.dot(b.cross(c));
    let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * numerator.atan2(denominator)
}

/// Squared distance from a point to a triangle (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
fn triangle_distance(p: Vec3, &[a, b, c]: &[Vec3; 3]) -> f32 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return p.distance_squared(a);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return p.distance_squared(b);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return p.distance_squared(a + ab * (d1 / (d1 - d3)));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return p.distance_squared(c);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return p.distance_squared(a + ac * (d2 / (d2 - d6)));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return p.distance_squared(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    }
    let sum = va + vb + vc;
    p.distance_squared(a + ab * (vb / sum) + ac * (vc / sum))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_hit_inside_and_missed_outside() {
        let corners = [Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, 0.0, 1.0), Vec3::new(0.0, 1.0, 1.0)];
        let at = |x: f32, y: f32| ray_distance(Vec3::new(x, y, -1.0), Vec3::Z, &corners);
        assert_eq!(at(0.2, 0.3), Some(2.0));
        assert_eq!(at(0.6, 0.6), None);
        assert_eq!(ray_distance(Vec3::new(0.2, 0.3, 2.0), Vec3::Z, &corners), None);
    }

    fn cube() -> Vec<[Vec3; 3]> {
        let mesh = crate::models::build("cube").unwrap();
        mesh.triangles.iter().map(|t| t.map(|v| Vec3::from(mesh.vertices[v as usize]))).collect()
    }

    #[test]
    fn distances_and_winding_numbers_of_a_cube_match_the_formula() {
        let bvh = Bvh::new(cube());
        for k in 0..1000u32 {
            let x = Vec3::new((k % 10) as f32, (k / 10 % 10) as f32, (k / 100) as f32) * 0.23 - 1.03;
            let q = x.abs() - 0.5;
            let exact = q.max(Vec3::ZERO).length() + q.max_element().min(0.0);
            assert!((bvh.distance(x, 1e9) - exact.abs()).abs() < 1e-5, "{x}");
            assert!((bvh.winding(x) - f32::from(exact < 0.0)).abs() < 0.05, "{x} {}", bvh.winding(x));
        }
    }
}
