//! A search for points near a position.

use std::collections::HashMap;

use glam::{IVec3, Vec3};

/// Edge of a cell in particle spacings.
const CELL: f32 = 2.0;

/// Points by cell. The cells are in a hash map because a scene built in code may have a domain of any size.
#[derive(Debug)]
pub(super) struct PointGrid {
    cell: f32,
    cells: HashMap<IVec3, Vec<Vec3>>,
}

impl PointGrid {
    /// An empty grid; `spacing` in m.
    pub fn new(spacing: f32) -> Self {
        Self { cell: CELL * spacing, cells: HashMap::new() }
    }

    pub fn insert(&mut self, points: &[[f32; 3]]) {
        for &x in points {
            let x = Vec3::from(x);
            self.cells.entry(self.cell_of(x)).or_default().push(x);
        }
    }

    /// Whether the grid has a point nearer to `x` than `reach` (in m).
    pub fn any_within(&self, x: Vec3, reach: f32) -> bool {
        let (low, high) = (self.cell_of(x - reach), self.cell_of(x + reach));
        let found = |cell: IVec3| {
            self.cells
                .get(&cell)
                .is_some_and(|list| list.iter().any(|y| y.distance_squared(x) < reach * reach))
        };
        (low.z..=high.z)
            .any(|k| (low.y..=high.y).any(|j| (low.x..=high.x).any(|i| found(IVec3::new(i, j, k)))))
    }

    fn cell_of(&self, x: Vec3) -> IVec3 {
        (x / self.cell).floor().as_ivec3()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_found_across_cells_and_at_negative_coordinates() {
        let mut grid = PointGrid::new(0.1);
        grid.insert(&[[0.199, 0.0, -0.001], [-5.0, -5.0, -5.0]]);
        for (x, reach, expected) in [
            (Vec3::new(0.201, 0.0, 0.0), 0.05, true),
            (Vec3::new(0.251, 0.0, 0.0), 0.05, false),
            (Vec3::new(0.199, 0.0, 0.048), 0.05, true),
            (Vec3::splat(-5.02), 0.05, true),
            (Vec3::splat(-5.04), 0.05, false),
        ] {
            assert_eq!(grid.any_within(x, reach), expected, "{x}");
        }
    }
}
