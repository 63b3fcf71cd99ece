//! The passes of a step, one folder each: equation and declaration (`mod.rs`), WGSL, and the CPU implementation
//! (`cpu.rs`).
//!
//! Between steps the particles are stored in the persistent arrays (`positions`, `velocities`, `ids`). A step sorts them
//! by cell into the sorted arrays (`sorted_*`), computes from these, and integrates back into the persistent arrays.
//! So a step needs no swap of buffers, and a step after the end of a frame does not change the persistent arrays. The
//! integration counts the particles for the sort of the next step, and that sort ends the step before it.

pub mod acceleration;
pub mod continuity;
pub mod corrected_acceleration;
pub mod density;
pub mod force_integrate;
pub mod implicit;
pub mod integrate;
pub mod mueller;
pub mod neighbours;
pub mod normals;
pub mod shifted_integrate;
pub mod smooth_normals;
pub mod state_equation;
pub mod suspension;
pub mod tension_force;
pub mod viscous;

pub(crate) mod advance;
pub(crate) mod correction;
pub(crate) mod group_sum;
pub(crate) mod tension;

pub use advance::WGSL as ADVANCE;
pub use tension::WGSL as TENSION;

use splashdown_gpu::{PassDesc, WgslModule};

/// `acceleration_of`: all forces in one loop over the neighbours.
pub const FORCES: WgslModule = WgslModule { name: "sph/forces", source: include_str!("forces.wgsl") };

/// The passes of this module.
pub fn passes() -> Vec<&'static PassDesc> {
    let explicit = [
        &neighbours::LIST_NEIGHBOURS,
        &continuity::WENDLAND_C2,
        &continuity::WENDLAND_BLEND,
        &continuity::CUBIC_SPLINE,
        &continuity::WENDLAND_C2_BODIES,
        &continuity::WENDLAND_BLEND_BODIES,
        &continuity::CUBIC_SPLINE_BODIES,
        &corrected_acceleration::WENDLAND_C2,
        &corrected_acceleration::WENDLAND_BLEND,
        &corrected_acceleration::CUBIC_SPLINE,
        &shifted_integrate::SHIFTED_INTEGRATE,
        &shifted_integrate::UNCOUNTED,
        &density::WENDLAND_C2,
        &density::WENDLAND_BLEND,
        &density::CUBIC_SPLINE,
        &density::POLY6,
        &integrate::INTEGRATE,
        &integrate::UNCOUNTED,
        &acceleration::WENDLAND_C2,
        &acceleration::WENDLAND_BLEND,
        &acceleration::CUBIC_SPLINE,
        &acceleration::WENDLAND_C2_PRESSURE,
        &acceleration::WENDLAND_C2_OTHER,
        &acceleration::WENDLAND_BLEND_PRESSURE,
        &acceleration::CUBIC_SPLINE_PRESSURE,
        &acceleration::WENDLAND_BLEND_OTHER,
        &acceleration::CUBIC_SPLINE_OTHER,
        &force_integrate::WENDLAND_C2,
        &force_integrate::WENDLAND_BLEND,
        &force_integrate::CUBIC_SPLINE,
        &mueller::MUELLER,
        &smooth_normals::WENDLAND_C2,
        &smooth_normals::WENDLAND_BLEND,
        &smooth_normals::CUBIC_SPLINE,
        &tension_force::WENDLAND_C2,
        &tension_force::WENDLAND_BLEND,
        &tension_force::CUBIC_SPLINE,
        &tension_force::WENDLAND_C2_CORRECTED,
        &tension_force::WENDLAND_BLEND_CORRECTED,
        &tension_force::CUBIC_SPLINE_CORRECTED,
        &normals::WENDLAND_C2,
        &normals::WENDLAND_BLEND,
        &normals::CUBIC_SPLINE,
        &state_equation::STATE_EQUATION,
    ];
    let implicit = implicit::passes().into_iter().chain(viscous::passes()).chain(suspension::passes());
    explicit.into_iter().chain(implicit).collect()
}
