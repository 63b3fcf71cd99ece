//! The thesis's forces (Mueller, Charypar & Gross 2003).

use splashdown_gpu::{Grid as Extent, Recording};

use super::Solver;
use super::wcsph::record_density;
use crate::cells::Cells;
use crate::fields::Fields;
use crate::passes::{density, mueller};

impl Solver {
    /// Density by poly6, and pressure.
    pub(super) fn mueller2003_pressure(
        &self,
        step: &mut Recording,
        cells: &Cells,
        fields: &Fields,
        all: Extent,
    ) {
        record_density(step, &density::POLY6, cells, fields, all);
    }

    /// The force densities.
    pub(super) fn mueller2003_forces(
        &self,
        step: &mut Recording,
        cells: &Cells,
        fields: &Fields,
        all: Extent,
    ) {
        step.dispatch(
            &mueller::MUELLER,
            all,
            &[
                fields.params.id(),
                cells.grid_uniform.id(),
                fields.state.id(),
                cells.cell_start.id(),
                fields.sorted_positions.id(),
                fields.sorted_velocities.id(),
                fields.densities.id(),
                fields.wall_table.id(),
                fields.accelerations.id(),
            ],
        );
    }
}
