//! The passes of a step, one folder each: equation and declaration (`mod.rs`), WGSL, and the CPU's way (`cpu.rs`).
//!
//! Particles rest in arrays "A" (`positions`, `velocities`, `ids`). A step sorts them by cell into arrays "B"
//! (`sorted_*`), computes from B, and integrates back into A, so that a step needs no swap of buffers and one
//! that has nothing to do leaves A untouched. The pass that moves particles counts them for the next step's
//! sort, and that sort ends the step before it.

pub mod acceleration;
pub mod continuity;
pub mod density;
pub mod force_integrate;
pub mod integrate;
pub mod mueller;
pub mod normals;
pub mod state_equation;

pub(crate) mod advance;

pub use advance::WGSL as ADVANCE;

use splashdown_gpu::{PassDesc, WgslModule};

/// `acceleration_of`: all forces in one visit of the neighbours.
pub const FORCES: WgslModule = WgslModule { name: "sph/forces", source: include_str!("forces.wgsl") };

/// The passes of this module.
pub fn passes() -> Vec<&'static PassDesc> {
    vec![
        &continuity::WENDLAND_C2,
        &continuity::CUBIC_SPLINE,
        &density::WENDLAND_C2,
        &density::CUBIC_SPLINE,
        &density::POLY6,
        &integrate::INTEGRATE,
        &integrate::UNCOUNTED,
        &acceleration::WENDLAND_C2,
        &acceleration::CUBIC_SPLINE,
        &acceleration::WENDLAND_C2_PRESSURE,
        &acceleration::WENDLAND_C2_OTHER,
        &force_integrate::WENDLAND_C2,
        &force_integrate::CUBIC_SPLINE,
        &mueller::MUELLER,
        &normals::WENDLAND_C2,
        &normals::CUBIC_SPLINE,
        &state_equation::STATE_EQUATION,
    ]
}
