//! Quadratic B-splines on a grid: an interpolation whose gradient is continuous.
//!
//! The force of a body is the gradient of its density. With linear interpolation this gradient jumps at every node where
//! the effective distance is curved, as in inner edges, and water in the edges of a tank never comes to rest.
//!
//! The values at the nodes are the coefficients. The spline is exact where they are linear, and elsewhere a mean over about a
//! cell. The filter that would make it pass through the values (Unser 1999) was tried and not used: it amplifies the errors of
//! the quadrature by up to two per axis, and pools around bodies moved a quarter more.

use glam::{UVec3, Vec3};

/// The first of the 3 x 3 x 3 nodes that matter at a point given in cells, their weights per axis, and the derivatives of the
/// weights. The grid has at least three nodes per axis.
#[inline]
pub(crate) fn weights(at: Vec3, nodes: UVec3) -> (UVec3, [Vec3; 3], [Vec3; 3]) {
    let center = (at + 0.5).as_uvec3().clamp(UVec3::ONE, nodes - UVec3::splat(2));
    let g = at - center.as_vec3();
    let (before, after) = (0.5 - g, 0.5 + g);
    (center - 1, [0.5 * before * before, 0.75 - g * g, 0.5 * after * after], [-before, -2.0 * g, after])
}

#[cfg(test)]
mod tests {
    use super::*;

    const NODES: UVec3 = UVec3::new(9, 7, 8);

    /// The value and the gradient per cell of the spline with these values at the nodes.
    fn evaluate(values: impl Fn(Vec3) -> f32, at: Vec3) -> (f32, Vec3) {
        let (first, weights, slopes) = weights(at, NODES);
        let (mut value, mut gradient) = (0.0, Vec3::ZERO);
        for (k, j, i) in (0..27).map(|n| (n / 9, n / 3 % 3, n % 3)) {
            let c = values((first + UVec3::new(i as u32, j as u32, k as u32)).as_vec3());
            let (x, y, z) = (weights[i].x, weights[j].y, weights[k].z);
            value += c * x * y * z;
            gradient += c * Vec3::new(slopes[i].x * y * z, x * slopes[j].y * z, x * y * slopes[k].z);
        }
        (value, gradient)
    }

    #[test]
    fn the_gradient_of_an_inner_edge_is_continuous_and_the_derivative_of_its_value() {
        let distance = |x: Vec3| (x.x - 1.0).min(x.y - 1.5);
        for at in [Vec3::new(4.5, 4.0, 3.2), Vec3::new(3.5, 4.0, 3.0), Vec3::new(3.0, 3.5, 3.0)] {
            for axis in [Vec3::X, Vec3::Y] {
                let [before, after] = [-1e-3, 1e-3].map(|e| evaluate(distance, at + e * axis));
                assert!(before.1.distance(after.1) < 0.01, "{at}: {} {}", before.1, after.1);
                let (_, gradient) = evaluate(distance, at);
                let difference = (after.0 - before.0) / 2e-3;
                assert!((difference - gradient.dot(axis)).abs() < 0.01, "{at}: {difference} {gradient}");
            }
        }
        // Control: between two nodes the gradient of the linear interpolation is their difference, which jumps at a node.
        let linear = |x: f32| distance(Vec3::new(x + 1.0, 3.5, 3.0)) - distance(Vec3::new(x, 3.5, 3.0));
        assert!((linear(2.0) - linear(3.0)).abs() > 0.5);
    }

    #[test]
    fn planes_are_exact() {
        let normal = Vec3::new(0.3, -0.8, 0.5);
        for at in [Vec3::new(2.2, 3.7, 4.1), Vec3::new(5.5, 2.5, 3.0), Vec3::new(0.2, 5.9, 6.8)] {
            let (value, gradient) = evaluate(|x| normal.dot(x) - 1.0, at);
            assert!((value - normal.dot(at) + 1.0).abs() < 1e-4);
            assert!(gradient.distance(normal) < 1e-4);
        }
    }
}
