//! Finding what stands close to a point.

use std::collections::HashMap;

use glam::{IVec3, Vec3};

/// Edge of a cell in particle spacings.
const CELL: f32 = 2.0;

/// Points in cells of a hash map: a scene built in code may have a domain of any size.
#[derive(Debug)]
pub(super) struct Near {
    cell: f32,
    cells: HashMap<IVec3, Vec<Vec3>>,
}

impl Near {
    /// None yet; `spacing` in m.
    pub fn new(spacing: f32) -> Self {
        Self { cell: CELL * spacing, cells: HashMap::new() }
    }

    pub fn insert(&mut self, points: &[[f32; 3]]) {
        for &x in points {
            let x = Vec3::from(x);
            self.cells.entry(self.home(x)).or_default().push(x);
        }
    }

    /// Whether a point is nearer than `reach` (m, at most a cell) to `x`.
    pub fn crowded(&self, x: Vec3, reach: f32) -> bool {
        let (low, high) = (self.home(x - reach), self.home(x + reach));
        let found = |cell: IVec3| {
            self.cells
                .get(&cell)
                .is_some_and(|list| list.iter().any(|y| y.distance_squared(x) < reach * reach))
        };
        (low.z..=high.z)
            .any(|k| (low.y..=high.y).any(|j| (low.x..=high.x).any(|i| found(IVec3::new(i, j, k)))))
    }

    fn home(&self, x: Vec3) -> IVec3 {
        (x / self.cell).floor().as_ivec3()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_near_is_found_across_cells_and_below_zero() {
        let mut near = Near::new(0.1);
        near.insert(&[[0.199, 0.0, -0.001], [-5.0, -5.0, -5.0]]);
        for (x, reach, expected) in [
            (Vec3::new(0.201, 0.0, 0.0), 0.05, true),
            (Vec3::new(0.251, 0.0, 0.0), 0.05, false),
            (Vec3::new(0.199, 0.0, 0.048), 0.05, true),
            (Vec3::splat(-5.02), 0.05, true),
            (Vec3::splat(-5.04), 0.05, false),
        ] {
            assert_eq!(near.crowded(x, reach), expected, "{x}");
        }
    }
}
