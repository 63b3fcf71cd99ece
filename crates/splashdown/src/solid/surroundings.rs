//! What surrounds a static solid: the closed sides of the domain and other static solids.
//!
//! Behind a closed side lies the image of everything in front of it. A solid therefore fills its part of the domain and
//! the image of that part. What lies outside the domain does not count, because the images of the fluid are there. Where
//! solids overlap, the first one counts. The shares of all solids and images thus add up to their union.

use glam::{Quat, Vec3};

use super::field::DistanceField;
use super::{Solid, bounds};

/// A solid at its place in the world.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// The solid.
    pub solid: &'a Solid,
    /// Position of the mesh's origin in m.
    pub position: Vec3,
    /// The mesh's rotation.
    pub rotation: Quat,
}

impl Placed<'_> {
    /// Signed distance in m at a point of the world.
    fn distance(&self, x: Vec3) -> f32 {
        self.solid.field.distance(self.rotation.conjugate() * (x - self.position))
    }

    /// The part of a cell of this size (m) around a point of the world that the solid leaves open.
    pub(crate) fn open_part(&self, x: Vec3, size: f32) -> f32 {
        1.0 - filled(self.distance(x), size)
    }

    /// Lower and upper corner in m of a box around it.
    fn bounds(&self) -> (Vec3, Vec3) {
        let (low, high) = bounds(&self.solid.mesh);
        corners_of(low, high, self.position, self.rotation)
    }
}

/// The surroundings of a static solid.
#[derive(Clone, Debug)]
pub struct Surroundings<'a> {
    /// Position of the solid's mesh in m.
    pub position: Vec3,
    /// Rotation of the solid's mesh.
    pub rotation: Quat,
    /// Corners of the domain in m, infinite at open sides.
    pub closed: [Vec3; 2],
    /// The solids whose shares are counted before this one's.
    pub others: Vec<Placed<'a>>,
}

impl Surroundings<'_> {
    /// Removes what is farther than `reach` (m) from a mesh with these corners in its own frame; `None` if nothing
    /// remains.
    pub fn within(mut self, (low, high): (Vec3, Vec3), reach: f32) -> Option<Self> {
        let (low, high) = corners_of(low, high, self.position, self.rotation);
        let (low, high) = (low - reach, high + reach);
        self.others.retain(|other| {
            let (from, to) = other.bounds();
            from.cmplt(high).all() && to.cmpgt(low).all()
        });
        let is_inside = low.cmpgt(self.closed[0]).all() && high.cmplt(self.closed[1]).all();
        (!is_inside || !self.others.is_empty()).then_some(self)
    }

    /// All inputs that change the result, for a hash.
    pub(super) fn words(&self) -> Vec<f32> {
        let mut words = Vec::new();
        words.extend(self.position.to_array());
        words.extend(self.rotation.to_array());
        words.extend(self.closed.iter().flat_map(|x| x.to_array()));
        for Placed { solid: Solid { field, .. }, position, rotation } in &self.others {
            words.extend(position.to_array());
            words.extend(rotation.to_array());
            words.extend(field.min.to_array());
            words.push(field.cell_size);
            words.extend(field.nodes.map(|n| n as f32));
            words.extend(field.values.iter().map(|value| value.x));
        }
        words
    }

    /// The point of the mesh's frame whose image, or which itself, is `y`.
    pub(super) fn fold(&self, y: Vec3) -> Vec3 {
        self.local(self.folded(self.world(y)))
    }

    /// Whether a side or another solid is within `reach` (m) of a point of the mesh's frame.
    pub(super) fn is_near(&self, y: Vec3, reach: f32) -> bool {
        let x = self.world(y);
        (x - reach).cmple(self.closed[0]).any()
            || (x + reach).cmpge(self.closed[1]).any()
            || self.others.iter().any(|other| other.distance(x) <= reach)
    }

    /// The part of a cell of this size (m) around a point of the mesh's frame that the solid and its images fill, and
    /// the others do not.
    pub(super) fn share(&self, field: &DistanceField, y: Vec3, size: f32) -> f32 {
        let x = self.folded(self.world(y));
        // A cell on a side is also filled by the image from the other half.
        let half = Vec3::splat(0.5 * size);
        let is_low = (x - self.closed[0]).cmplt(half);
        let is_cut = is_low | (self.closed[1] - x).cmplt(half);
        let planes = Vec3::select(is_low, self.closed[0], self.closed[1]);
        let cut = is_cut.bitmask();
        (0..8)
            .filter(|mask| mask & !cut == 0)
            .map(|mask| {
                let mut image = x;
                for axis in (0..3).filter(|axis| mask >> axis & 1 == 1) {
                    image[axis] = 2.0 * planes[axis] - x[axis];
                }
                self.share_inside(field, image, size)
            })
            .sum()
    }

    /// The part of a cell around a point of the world that lies in the solid and the domain, and in no other solid.
    fn share_inside(&self, field: &DistanceField, x: Vec3, size: f32) -> f32 {
        let y = self.local(x);
        let mut share = filled(field.distance(y), size);
        if share <= 0.0 {
            return 0.0;
        }
        let is_partial = share < 1.0;
        let normal = || self.rotation * field.normal(y);
        for axis in 0..3 {
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                let outside = filled(sign * (x[axis] - self.closed[side][axis]), size);
                if outside > 0.0 {
                    let cosine = if is_partial { sign * normal()[axis] } else { 0.0 };
                    share = without(share, outside, cosine);
                }
            }
        }
        for other in &self.others {
            let taken = filled(other.distance(x), size);
            if taken > 0.0 {
                let of_other = || {
                    let y = other.rotation.conjugate() * (x - other.position);
                    other.rotation * other.solid.field.normal(y)
                };
                let cosine = if is_partial && taken < 1.0 { normal().dot(of_other()) } else { 0.0 };
                share = without(share, taken, cosine);
            }
        }
        share
    }

    fn world(&self, y: Vec3) -> Vec3 {
        self.position + self.rotation * y
    }

    fn local(&self, x: Vec3) -> Vec3 {
        self.rotation.conjugate() * (x - self.position)
    }

    /// A point reflected into the domain. A domain is at least a support radius wide, so that one reflection per axis
    /// is enough.
    fn folded(&self, x: Vec3) -> Vec3 {
        let [low, high] = self.closed;
        let x = Vec3::select(x.cmplt(low), 2.0 * low - x, x);
        Vec3::select(x.cmpgt(high), 2.0 * high - x, x)
    }
}

/// The part of a cell that lies inside a surface at this signed distance from its centre.
pub(super) fn filled(distance: f32, size: f32) -> f32 {
    (0.5 - distance / size).clamp(0.0, 1.0)
}

/// The part of a cell that the first of two sets fills alone. The fractions of the cell that they fill do not tell how
/// they overlap; the cosine of the angle between their normals does.
fn without(share: f32, taken: f32, cosine: f32) -> f32 {
    let across = share * (1.0 - taken);
    if cosine > 0.0 {
        // Surfaces that face the same way: one set contains the other.
        cosine * (share - taken).max(0.0) + (1.0 - cosine) * across
    } else {
        // Surfaces that face one another: the sets are disjoint as far as the cell has room.
        -cosine * share.min(1.0 - taken) + (1.0 + cosine) * across
    }
}

/// The corners of the box around a box that has been rotated and moved.
fn corners_of(low: Vec3, high: Vec3, position: Vec3, rotation: Quat) -> (Vec3, Vec3) {
    (0..8).fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(from, to), k| {
        let pick = |axis: usize| if k >> axis & 1 == 0 { low[axis] } else { high[axis] };
        let x = position + rotation * Vec3::new(pick(0), pick(1), pick(2));
        (from.min(x), to.max(x))
    })
}

#[cfg(test)]
mod tests {
    use super::without;

    #[test]
    fn overlaps_follow_the_angle_of_the_surfaces() {
        for (share, taken, cosine, expected) in [
            // The same half of a cell; the two halves of a cell; two quarters of a cell.
            (0.5, 0.5, 1.0, 0.0),
            (0.5, 0.5, -1.0, 0.5),
            (0.5, 0.5, 0.0, 0.25),
            (0.7, 0.6, -1.0, 0.4),
            (0.7, 0.0, 0.3, 0.7),
            (1.0, 1.0, 0.0, 0.0),
        ] {
            assert!((without(share, taken, cosine) - expected).abs() < 1e-6, "{share} {taken} {cosine}");
        }
    }
}
