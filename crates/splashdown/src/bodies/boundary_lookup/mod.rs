//! Finds the bodies near each particle, with one look-up in the map of each near body.
//!
//! The map of a body is a grid. Each node stores the signed distance from the surface and the *effective* distance:
//! the distance of a plane wall with the same kernel fraction D(q) (Koschier & Bender 2017 store the integral
//! itself). For a plane both distances are linear and interpolation is exact. For other shapes the chain rule gives
//! the gradient of the kernel fraction, -A(q)/H grad(effective), from the same eight reads.
//!
//! Alternatively, boundary particles represent the body (Akinci et al. 2012): the kernel fraction is sum V_b W, and
//! the slope, minus its gradient, is -sum V_b grad W. The boundary particles are sorted into cells in the frame of the
//! body, so that a moving body needs no sort. The effective distance follows from the kernel fraction.
//!
//! Walls and bodies share the kernel without overlap. Only the part of a body inside the closed sides of the domain
//! counts, and the images of this part behind them; where bodies overlap, the first one counts. For bodies that do not
//! move this is part of their maps ([`Surroundings`](crate::solid::Surroundings)), or of the volumes of their boundary
//! particles. For maps of other bodies the lookup estimates it from distances and normals.
//!
//! The two nearest bodies are stored per particle. A particle inside a body is moved along the normal towards the
//! surface by at most a tenth of a spacing, and counted.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, WgslModule, bindings, wgsl};

use super::field;
use super::types::{self, Body, Contact};
use crate::boundary::{self, KernelPair};
use crate::kernel::{self, CubicSpline, Kernel, Poly6, WendlandBlend};
use crate::state::{PARAMS, Params, STATE, STEP_COUNTERS};

const IMPORTS: &[WgslModule] = &[
    wgsl::INDEX,
    STATE,
    PARAMS,
    STEP_COUNTERS,
    kernel::WGSL,
    boundary::PLANES,
    boundary::IMAGES,
    types::WGSL,
    field::MAP,
];

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

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "bodies.boundary_lookup.wendland_blend",
    constants: &[
        ("KERNEL", WendlandBlend::ID as f64),
        ("WALL_KERNEL", KernelPair::WendlandBlend.id() as f64),
    ],
    cpu: |_, slots| cpu::boundary_lookup::<WendlandBlend>(slots.into()),
    ..WENDLAND_C2
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
