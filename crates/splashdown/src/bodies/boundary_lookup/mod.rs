//! Which bodies a particle feels, and how: one look-up in the map of each body that is near.
//!
//! A body's map holds at every node of a grid the signed distance from its surface and the *effective*
//! distance: that of the plane wall whose share of the kernel, D(q), is the body's (Koschier & Bender 2017
//! store the integral itself). For a plane both are the same straight line, so that interpolation is exact; for
//! anything else the chain rule gives the gradient of the share, -A(q)/H grad(effective), at the cost of eight
//! reads.
//!
//! A body may instead be felt by particles on its surface (Akinci et al. 2012): share = sum V_b W, slope = -sum
//! V_b grad W. They lie in cells in the body's own frame, so that a moving body needs no sort. The effective
//! distance then follows from the share.
//!
//! The two bodies that matter most are kept per particle. A particle inside a body is put back by at most a tenth of a
//! spacing along the normal, and counted.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, WgslModule, bindings, wgsl};

use super::types::{self, Body, Contact};
use crate::boundary::{self, KernelPair};
use crate::kernel::{self, CubicSpline, Kernel, Poly6};
use crate::state::{PARAMS, Params, STATE, STEP_COUNTERS};

const IMPORTS: &[WgslModule] =
    &[wgsl::INDEX, STATE, PARAMS, STEP_COUNTERS, kernel::WGSL, boundary::PLANES, types::WGSL];

bindings! {
    /// The buffers of `boundary_lookup.wgsl`.
    pub(super) struct BoundaryLookupBindings {
        params: uniform Params,
        cell_start: read [u32],
        bodies: read [Body],
        maps: read [Vec2],
        sorted_positions: write [Vec4],
        contacts: write [Contact],
        counters: atomic [u32],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "bodies.boundary_lookup.wendland_c2",
    wgsl: include_str!("boundary_lookup.wgsl"),
    imports: IMPORTS,
    entry: "boundary_lookup",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0), ("WALL_KERNEL", 0.0)],
    bindings: BoundaryLookupBindings::LIST,
    cpu: |_, slots| cpu::boundary_lookup::<kernel::WendlandC2>(slots.into()),
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "bodies.boundary_lookup.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("WALL_KERNEL", KernelPair::CubicSpline.id() as f64)],
    cpu: |_, slots| cpu::boundary_lookup::<CubicSpline>(slots.into()),
    ..WENDLAND_C2
};

/// With the kernels of Mueller 2003.
pub static MUELLER: PassDesc = PassDesc {
    label: "bodies.boundary_lookup.mueller",
    constants: &[("KERNEL", Poly6::ID as f64), ("WALL_KERNEL", KernelPair::Mueller.id() as f64)],
    cpu: |_, slots| cpu::boundary_lookup::<Poly6>(slots.into()),
    ..WENDLAND_C2
};
