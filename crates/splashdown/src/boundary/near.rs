//! Evaluates the walls only for particles near one.

use glam::{BVec3, Vec3, Vec4};

use super::{WallTerms, Walls};

/// The corners of a box, infinite where a side is open. `closed` has bit 2 * axis + side set for every closed side.
pub(crate) fn closed_bounds(min: Vec3, max: Vec3, closed: u32) -> [Vec3; 2] {
    let closed =
        |side: u32| BVec3::from_array([0, 1, 2].map(|axis: u32| (closed >> (2 * axis + side)) & 1 == 1));
    [Vec3::select(closed(0), min, Vec3::NEG_INFINITY), Vec3::select(closed(1), max, Vec3::INFINITY)]
}

/// Walls with their table, and the box in which no wall is within the support.
pub(crate) struct NearWalls<'a> {
    walls: Walls,
    table: &'a [Vec4],
    low: Vec3,
    high: Vec3,
}

impl<'a> NearWalls<'a> {
    pub fn new(walls: Walls, table: &'a [Vec4]) -> Self {
        let [low, high] = closed_bounds(walls.min, walls.max, walls.closed);
        let (low, high) = (low + walls.support_radius, high - walls.support_radius);
        Self { walls, table, low, high }
    }

    #[inline(always)]
    fn is_near(&self, x: Vec3) -> bool {
        x.cmplt(self.low).any() || x.cmpgt(self.high).any()
    }

    /// The contributions of the walls at `x`, a point inside the box; `None` if no wall is within the support.
    #[inline(always)]
    pub fn terms(&self, x: Vec3) -> Option<WallTerms> {
        self.is_near(x).then(|| self.walls.terms(self.table, x))
    }

    /// The density of the walls at `x`, over the rest density.
    #[inline(always)]
    pub fn density(&self, x: Vec3) -> f32 {
        if self.is_near(x) { self.walls.density_at(self.table, x) } else { 0.0 }
    }
}
