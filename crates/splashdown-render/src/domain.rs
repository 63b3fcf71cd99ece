//! The domain of the simulation, drawn as a box.

use crate::RenderError;
use glam::Vec3;

/// The box of the simulation, and which of its sides are walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// Lower corner, metres.
    pub min: [f32; 3],
    /// Upper corner, metres.
    pub max: [f32; 3],
    /// Whether there is a wall at -x, +x, -y, +y, -z, +z. An edge between two open sides is dashed
    /// and faint.
    pub closed: [bool; 6],
}

/// How a domain is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Tank {
    /// With a liquid as panes of glass at its closed upright sides, otherwise as lines at its edges.
    Glass,
    /// As lines at its edges.
    Edges,
    /// Not at all.
    Hidden,
}

/// What is drawn around a domain, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Surroundings {
    /// Height of the floor. It is slightly below the box, so that there is no z-fighting with the
    /// underside of the fluid.
    pub floor_height: f32,
    /// Length of a tile of the floor.
    pub tile_size: f32,
    /// Distance from the domain at which haze replaces 63 % of the light of the floor.
    pub fade_distance: f32,
    /// Thickness of the panes of the tank.
    pub glass_thickness: f32,
}

/// One edge of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BoxEdge {
    pub start: Vec3,
    pub end: Vec3,
    /// The eye sees both adjacent walls from the inside, so that fluid may hide this edge.
    pub behind: bool,
    /// At least one of the two sides is a wall.
    pub wall: bool,
}

impl Domain {
    /// A box with walls on all sides except the top.
    pub fn closed(min: [f32; 3], max: [f32; 3]) -> Domain {
        Domain { min, max, closed: [true, true, true, false, true, true] }
    }

    /// Sizes of the floor and of the tank, which depend on those of the box.
    pub fn surroundings(&self) -> Surroundings {
        let extent = Vec3::from(self.max) - Vec3::from(self.min);
        Surroundings {
            floor_height: self.min[1] - 0.002 * extent.length(),
            tile_size: round_tile_size(0.2 * extent.x.max(extent.z)),
            fade_distance: 16.0 * extent.length(),
            glass_thickness: 0.004 * extent.length(),
        }
    }

    pub(crate) fn check(&self) -> Result<(), RenderError> {
        let (low, high) = (Vec3::from(self.min), Vec3::from(self.max));
        if low.is_finite() && high.is_finite() && low.cmplt(high).all() {
            return Ok(());
        }
        Err(RenderError::Value {
            what: "the box of the domain",
            given: format!("{low} to {high}"),
            allowed: "a box whose max is greater than its min on every axis",
        })
    }

    pub(crate) fn contains(&self, point: Vec3) -> bool {
        point.cmpge(Vec3::from(self.min)).all() && point.cmple(Vec3::from(self.max)).all()
    }

    /// The eight corners. Bit 0 of the index selects x, bit 1 y, bit 2 z.
    pub(crate) fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|index| {
            Vec3::from_array(std::array::from_fn(|axis| match index >> axis & 1 {
                0 => self.min[axis],
                _ => self.max[axis],
            }))
        })
    }

    /// The number of edges that fluid in the box can hide.
    pub(crate) fn edges_behind(&self, eye: Vec3) -> u32 {
        self.edges(eye).iter().filter(|edge| edge.behind).count() as u32
    }

    /// The twelve edges; those that fluid in the box can hide come first.
    pub(crate) fn edges(&self, eye: Vec3) -> [BoxEdge; 12] {
        let corners = self.corners();
        let seen_from_outside = |axis: usize, upper: bool| match upper {
            false => eye[axis] < self.min[axis],
            true => eye[axis] > self.max[axis],
        };
        let mut edges: [BoxEdge; 12] = std::array::from_fn(|index| {
            let (along, first, second) = (index / 4, (index / 4 + 1) % 3, (index / 4 + 2) % 3);
            let (upper_first, upper_second) = (index & 1 == 1, index & 2 == 2);
            let start = usize::from(upper_first) << first | usize::from(upper_second) << second;
            let side = |axis: usize, upper: bool| self.closed[2 * axis + usize::from(upper)];
            BoxEdge {
                start: corners[start],
                end: corners[start | 1 << along],
                behind: !seen_from_outside(first, upper_first) && !seen_from_outside(second, upper_second),
                wall: side(first, upper_first) || side(second, upper_second),
            }
        });
        edges.sort_by_key(|edge| !edge.behind);
        edges
    }
}

/// A round number of 1, 2 or 5 times a power of ten, at most `length`.
fn round_tile_size(length: f32) -> f32 {
    let power = 10f32.powf(length.log10().floor());
    match length / power {
        ratio if ratio >= 5.0 => 5.0 * power,
        ratio if ratio >= 2.0 => 2.0 * power,
        _ => power,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tile_sizes_are_round_numbers() {
        for (length, tile) in [(0.4, 0.2), (0.99, 0.5), (1.0, 1.0), (7.0, 5.0), (23.0, 20.0)] {
            let found = round_tile_size(length);
            assert!((found - tile).abs() < 1e-5 * tile, "{length} gives {found}");
        }
    }

    #[test]
    fn there_are_twelve_different_edges_of_the_right_lengths() {
        let domain = Domain::closed([0.0; 3], [1.0, 2.0, 3.0]);
        let edges = domain.edges(Vec3::splat(10.0));
        let total: f32 = edges.iter().map(|edge| edge.start.distance(edge.end)).sum();
        assert_eq!(total, 4.0 * (1.0 + 2.0 + 3.0));
        for (i, a) in edges.iter().enumerate() {
            for b in &edges[..i] {
                assert!(a.start.midpoint(a.end) != b.start.midpoint(b.end));
            }
        }
    }

    #[test]
    fn seen_from_a_corner_the_three_edges_at_the_opposite_corner_can_be_hidden() {
        let domain = Domain::closed([0.0; 3], [1.0; 3]);
        let edges = domain.edges(Vec3::splat(5.0));
        let behind: Vec<_> = edges.iter().filter(|edge| edge.behind).collect();
        assert_eq!(behind.len(), 3);
        assert!(behind.iter().all(|edge| edge.start == Vec3::ZERO));
        assert!(edges[..3].iter().all(|edge| edge.behind), "hidden edges come first");
        assert_eq!(
            domain.edges(Vec3::splat(0.5)).iter().filter(|edge| edge.behind).count(),
            12,
            "eye inside"
        );
    }

    #[test]
    fn only_edges_between_open_sides_are_open() {
        let mut domain = Domain::closed([0.0; 3], [1.0; 3]);
        assert!(domain.edges(Vec3::splat(5.0)).iter().all(|edge| edge.wall));
        domain.closed = [false, true, true, false, true, true];
        let open: Vec<_> = domain.edges(Vec3::splat(5.0)).into_iter().filter(|edge| !edge.wall).collect();
        assert_eq!(open.len(), 1);
        assert_eq!((open[0].start, open[0].end), (Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 1.0, 1.0)));
    }

    #[test]
    fn an_inverted_box_is_refused() {
        assert!(Domain::closed([0.0; 3], [1.0, 0.0, 1.0]).check().is_err());
        assert!(Domain::closed([0.0; 3], [1.0, f32::NAN, 1.0]).check().is_err());
        assert!(Domain::closed([0.0; 3], [1.0; 3]).check().is_ok());
    }
}
