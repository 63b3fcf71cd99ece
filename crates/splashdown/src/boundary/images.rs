//! Images of the fluid behind the closed sides of the domain.
//!
//! A plane wall with free slip is a plane of symmetry. Behind it the fluid has an image: position and velocity are
//! reflected, and the density is the same. Every sum of SPH includes the images. Two sides that meet reflect twice, so
//! that an edge has three images and a corner seven.
//!
//! The pressure of an image is extrapolated with the gradient that the fluid has at the wall, rho0 times the body
//! acceleration. It is not below the smaller of zero and the particle's pressure, so that a ceiling exerts no suction.
//! Fluid that falls freely feels a floor within the support radius: the difference slows it by up to g.
//!
//! The support radius contains an image only if it contains the particle itself: the distance along the wall is the
//! same, and the distance across it is larger. So images need no cells of their own; a particle near a wall visits its
//! neighbours once more per image. A domain is at least a support radius wide, so that an image of an image is never
//! within the support.
//!
//! Without body forces, density and pressure force follow from one energy, which is conserved, as is the momentum along
//! the wall. Nothing needs an offset, a correction along the wall, or damping (Colagrossi & Landrini 2003). The
//! hydrostatic difference is not exactly symmetric along the wall.

use glam::{BVec3, Vec3};

use crate::state::Params;

/// The corners of a box, infinite where a side is open. `closed` has bit 2 * axis + side set for every closed side.
pub(crate) fn closed_bounds(min: Vec3, max: Vec3, closed: u32) -> [Vec3; 2] {
    let closed =
        |side: u32| BVec3::from_array([0, 1, 2].map(|axis: u32| (closed >> (2 * axis + side)) & 1 == 1));
    [Vec3::select(closed(0), min, Vec3::NEG_INFINITY), Vec3::select(closed(1), max, Vec3::INFINITY)]
}

/// A reflection at closed sides, at most one side per axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reflection {
    /// -1 for reflected axes, otherwise 1.
    pub sign: Vec3,
    /// The image of the origin, in metres.
    pub shift: Vec3,
}

/// The closed sides at which the fluid is reflected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Images {
    /// Corners of the domain in metres, infinite where a side is open.
    low: Vec3,
    high: Vec3,
}

impl Images {
    /// No side is closed.
    pub const NONE: Self = Self { low: Vec3::NEG_INFINITY, high: Vec3::INFINITY };

    /// The closed sides of the domain.
    pub fn new(params: &Params) -> Self {
        let [low, high] = closed_bounds(params.domain_min, params.domain_max, params.closed);
        Self { low, high }
    }

    /// The number of closed sides within `reach` of a point, in metres.
    #[inline(always)]
    pub fn sides_near(&self, x: Vec3, reach: f32) -> u32 {
        let reach = Vec3::splat(reach);
        [(x - self.low).cmplt(reach), (self.high - x).cmplt(reach)]
            .map(|near| near.bitmask().count_ones())
            .iter()
            .sum()
    }

    /// For the lower and the upper side of each axis a value that falls from 1 at the side to 0 at `reach` metres; 0 where it is
    /// open.
    #[inline(always)]
    pub fn nearness(&self, x: Vec3, reach: f32) -> [Vec3; 2] {
        [x - self.low, self.high - x].map(|distance| (1.0 - distance / reach).clamp(Vec3::ZERO, Vec3::ONE))
    }

    /// The sides between two corners in metres, infinite or far away where open.
    pub fn between(low: Vec3, high: Vec3) -> Self {
        Self { low, high }
    }

    /// The reflections whose images can be within `reach` of a point in the box between `low` and `high`, in metres.
    #[inline(always)]
    pub fn near(
        &self,
        low: Vec3,
        high: Vec3,
        reach: f32,
    ) -> impl Iterator<Item = Reflection> + Clone + use<> {
        let planes = [self.low, self.high];
        let is_near =
            [(low - self.low).cmplt(Vec3::splat(reach)), (self.high - high).cmplt(Vec3::splat(reach))];
        // Number k has the digits of base 3 of the axes: 0 for no reflection, 1 for the lower side, 2 for the upper.
        let any = (is_near[0] | is_near[1]).any();
        (1..if any { 27 } else { 1 }).filter_map(move |k: usize| {
            let mut reflection = Reflection { sign: Vec3::ONE, shift: Vec3::ZERO };
            for (axis, digit) in [k % 3, k / 3 % 3, k / 9].into_iter().enumerate() {
                if digit > 0 {
                    if !is_near[digit - 1].test(axis) {
                        return None;
                    }
                    reflection.sign[axis] = -1.0;
                    reflection.shift[axis] = 2.0 * planes[digit - 1][axis];
                }
            }
            Some(reflection)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner() -> Images {
        // The upper side of y is open.
        let params = Params {
            domain_min: Vec3::ZERO,
            domain_max: Vec3::new(4.0, 5.0, 6.0),
            closed: 0b110111,
            ..bytemuck::Zeroable::zeroed()
        };
        Images::new(&params)
    }

    fn images(x: Vec3, reach: f32) -> Vec<Vec3> {
        corner().near(x, x, reach).map(|by| by.sign * x + by.shift).collect()
    }

    #[test]
    fn a_plane_has_one_image_an_edge_three_and_a_corner_seven() {
        assert!(images(Vec3::new(2.0, 2.0, 2.0), 1.0).is_empty());
        assert_eq!(images(Vec3::new(0.5, 2.0, 2.0), 1.0), [Vec3::new(-0.5, 2.0, 2.0)]);
        assert_eq!(images(Vec3::new(3.5, 2.0, 2.0), 1.0), [Vec3::new(4.5, 2.0, 2.0)]);
        let edge = images(Vec3::new(0.5, 0.25, 2.0), 1.0);
        assert_eq!(
            edge,
            [Vec3::new(-0.5, 0.25, 2.0), Vec3::new(0.5, -0.25, 2.0), Vec3::new(-0.5, -0.25, 2.0)]
        );
        assert_eq!(images(Vec3::new(0.5, 0.25, 5.5), 1.0).len(), 7);
        // Control: an open side has none.
        assert!(images(Vec3::new(2.0, 4.9, 2.0), 1.0).is_empty());
        // Both sides of a narrow domain.
        assert_eq!(images(Vec3::new(2.0, 2.5, 3.0), 2.6).len(), 5);
    }

    #[test]
    fn nearness_falls_from_one_at_a_side_to_zero_at_the_reach() {
        let near = |x: f32, y: f32, z: f32, reach: f32| corner().nearness(Vec3::new(x, y, z), reach);
        assert_eq!(near(0.0, 2.0, 5.5, 1.0), [Vec3::X, 0.5 * Vec3::Z]);
        // Both sides of x and z, and y without its open side.
        assert_eq!(near(2.0, 4.9, 3.0, 4.0), [Vec3::new(0.5, 0.0, 0.25); 2]);
        // A particle that is slightly outside.
        assert_eq!(near(-0.1, 2.0, 3.0, 1.0), [Vec3::X, Vec3::ZERO]);
    }

    #[test]
    fn an_image_is_never_nearer_than_its_particle() {
        let images = corner();
        let at = |k: u32| {
            Vec3::new(
                (k * 37 % 100) as f32 / 25.0,
                (k * 61 % 100) as f32 / 20.0,
                (k * 83 % 100) as f32 / 16.7,
            )
        };
        for (a, b) in (0..100).map(|k| (at(k), at(7 * k + 3))) {
            for by in images.near(a, a, 10.0) {
                assert!((by.sign * b + by.shift).distance(a) >= b.distance(a) - 1e-5, "{a} {b} {by:?}");
            }
        }
    }
}
