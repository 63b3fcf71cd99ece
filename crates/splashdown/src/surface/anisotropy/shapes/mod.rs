//! The centre and the matrix of the kernel of each particle; see [`anisotropy`](super).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::Grid;
use crate::surface::modules::{CANDIDATES, GRID, LATTICE, STATUS, WALLS};
use crate::surface::params::Lattice;

bindings! {
    /// The buffers of `shapes.wgsl`. `kernel_matrices` has two vectors per particle: (xx, xy, xz, yy) and (yz, zz) in 1/m^2, with
    /// the square of a bound of the half-axes in m^2. w of a centre is the weight of a particle inside the fluid, otherwise 0.
    pub(super) struct ShapesBindings {
        lattice: uniform Lattice,
        grid: uniform Grid,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        neighbour_moments: read [Vec4],
        kernel_centres: write [Vec4],
        kernel_matrices: write [Vec4],
    }
}

pub(crate) static SHAPES: PassDesc = PassDesc {
    label: "surface.shapes",
    wgsl: include_str!("shapes.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE, WALLS, CANDIDATES],
    entry: "shapes",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ShapesBindings::LIST,
    cpu: |_, slots| cpu::shapes(slots.into()),
};
