//! Weakly compressible SPH (Monaghan 1994; Becker & Teschner 2007; delta-SPH: Molteni & Colagrossi 2009).

use splashdown_gpu::{Grid as Extent, PassDesc, Recording};

use super::Solver;
use crate::cells::Cells;
use crate::fields::Fields;
use crate::passes::{acceleration, continuity, density, force_integrate, normals};
use crate::scene::KernelKind;

impl Solver {
    /// Density, by summation or by the continuity equation, and pressure.
    pub(super) fn wcsph_pressure(&self, step: &mut Recording, cells: &Cells, fields: &Fields, all: Extent) {
        if self.continuity {
            step.dispatch(
                self.by_kernel(&continuity::WENDLAND_C2, &continuity::CUBIC_SPLINE),
                all,
                &[
                    fields.params.id(),
                    cells.grid_uniform.id(),
                    fields.state.id(),
                    cells.cell_start.id(),
                    fields.sorted_positions.id(),
                    fields.sorted_velocities.id(),
                    fields.wall_table.id(),
                    fields.densities.id(),
                ],
            );
        } else {
            record_density(
                step,
                self.by_kernel(&density::WENDLAND_C2, &density::CUBIC_SPLINE),
                cells,
                fields,
                all,
            );
        }
    }

    /// All accelerations in one visit of the neighbours.
    pub(super) fn wcsph_forces(&self, step: &mut Recording, cells: &Cells, fields: &Fields, all: Extent) {
        if self.tension {
            step.dispatch(
                self.by_kernel(&normals::WENDLAND_C2, &normals::CUBIC_SPLINE),
                all,
                &[
                    fields.params.id(),
                    cells.grid_uniform.id(),
                    cells.cell_start.id(),
                    fields.sorted_positions.id(),
                    fields.densities.id(),
                    fields.normals.id(),
                ],
            );
        }
        step.dispatch(
            self.by_kernel(&acceleration::WENDLAND_C2, &acceleration::CUBIC_SPLINE),
            all,
            &[
                fields.params.id(),
                cells.grid_uniform.id(),
                fields.state.id(),
                cells.cell_start.id(),
                fields.sorted_positions.id(),
                fields.sorted_velocities.id(),
                fields.densities.id(),
                fields.normals.id(),
                fields.wall_table.id(),
                fields.accelerations.id(),
            ],
        );
    }

    /// All accelerations in one visit of the neighbours, and the motion that follows from them.
    pub(super) fn wcsph_force_integrate(
        &self,
        step: &mut Recording,
        cells: &Cells,
        fields: &Fields,
        all: Extent,
    ) {
        step.dispatch(
            self.by_kernel(&force_integrate::WENDLAND_C2, &force_integrate::CUBIC_SPLINE),
            all,
            &[
                fields.params.id(),
                cells.grid_uniform.id(),
                fields.state.id(),
                fields.wall_table.id(),
                cells.cell_start.id(),
                fields.sorted_positions.id(),
                fields.sorted_velocities.id(),
                fields.densities.id(),
                fields.positions.id(),
                fields.velocities.id(),
                fields.counters.id(),
                cells.cell_counts.id(),
            ],
        );
    }

    pub(super) fn by_kernel(
        &self,
        wendland_c2: &'static PassDesc,
        cubic_spline: &'static PassDesc,
    ) -> &'static PassDesc {
        match self.kernel {
            KernelKind::WendlandC2 => wendland_c2,
            KernelKind::CubicSpline => cubic_spline,
        }
    }
}

/// Appends a pass of the family [`density`].
pub(super) fn record_density(
    step: &mut Recording,
    pass: &'static PassDesc,
    cells: &Cells,
    fields: &Fields,
    all: Extent,
) {
    let buffers = [
        fields.params.id(),
        cells.grid_uniform.id(),
        cells.cell_start.id(),
        fields.sorted_positions.id(),
        fields.wall_table.id(),
        fields.densities.id(),
    ];
    step.dispatch(pass, all, &buffers);
}
