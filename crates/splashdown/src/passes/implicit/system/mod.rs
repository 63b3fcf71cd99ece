//! Density, diagonal of the implicit pressure, and viscous accelerations, in one visit of the neighbours.
//!
//! delta_i = sum V W; the sum of g_ij and the sum of g_ij^2, of which the diagonal of the system is
//! dt^2 (|sum g + b|^2 + sum g^2). The pair of a particle and its image moves together, which the second sum does not
//! contain: it is enlarged by a third for each side that is near.
//!
//! Viscosity, body forces and the friction of walls are those of [`acceleration`](crate::passes::acceleration).

mod cpu;

use glam::{UVec4, Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::boundary::{self, KernelPair};
use crate::cells::{CANDIDATES, GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel, WendlandBlend};
use crate::passes::neighbours::{NEIGHBOUR_ENTRIES, NEIGHBOURS};
use crate::state::{PARAMS, Params, STATE, StepState};

bindings! {
    /// The buffers of `implicit_system.wgsl`.
    pub(super) struct SystemBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: uniform StepState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        neighbours: read [UVec4],
        sorted_velocities: read [Vec4],
        densities: write [Vec2],
        accelerations: write [Vec4],
        stiffness: write [Vec4],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "implicit.system.wendland_c2",
    wgsl: include_str!("implicit_system.wgsl"),
    imports: &[
        wgsl::INDEX,
        STATE,
        PARAMS,
        GRID,
        ROWS,
        boundary::IMAGES,
        CANDIDATES,
        NEIGHBOURS,
        NEIGHBOUR_ENTRIES,
        kernel::WGSL,
        boundary::PLANES,
        boundary::LAW,
        boundary::WALL_FRICTION,
    ],
    entry: "implicit_system",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0), ("WALL_KERNEL", 0.0)],
    bindings: SystemBindings::LIST,
    cpu: |work, slots| cpu::system::<kernel::WendlandC2>(work.scratch, slots.into()),
};

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "implicit.system.wendland_blend",
    constants: &[
        ("KERNEL", WendlandBlend::ID as f64),
        ("WALL_KERNEL", KernelPair::WendlandBlend.id() as f64),
    ],
    cpu: |work, slots| cpu::system::<WendlandBlend>(work.scratch, slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "implicit.system.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("WALL_KERNEL", KernelPair::CubicSpline.id() as f64)],
    cpu: |work, slots| cpu::system::<CubicSpline>(work.scratch, slots.into()),
    ..WENDLAND_C2
};
