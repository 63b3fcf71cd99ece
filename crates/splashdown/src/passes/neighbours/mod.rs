//! Lists of neighbours on a GPU, for passes that visit the same neighbours again in a step.
//!
//! With a support radius of two spacings a warp tests about 170 candidates for each particle, of which about 30 are neighbours. A
//! pass over a list visits the neighbours only, and loads four at a time.
//!
//! The lists are for `dfsph`: the system, the iterations of the pressure, and those of the viscosity. Passes that visit
//! the neighbours once in a step search them themselves.
//!
//! # Layout
//! A list has words in layers of four: layer k of particle i is `neighbours[k * particle_count + i]`, so
//! that consecutive particles read consecutive memory. The first word is the number of neighbours, among
//! them the particle itself. The others are entries: the sorted index of a neighbour, and in the upper five
//! bits the number of its reflection (see [`boundary`](crate::boundary)). They are ordered by reflection
//! and index, so that sums are bit-identical when repeated. The last layer is filled with entries without a
//! neighbour, whose index is that of the particle.
//!
//! Where there are more neighbours than words, or where a buffer of the device cannot hold a layer, a
//! visit searches the candidates.
//!
//! The CPU has lists of another kind (`pairs`). It allocates no layers here, and the pass
//! does nothing.

mod cpu;

use glam::{UVec4, Vec4};
use splashdown_gpu::{PassDesc, WgslModule, bindings, wgsl};

use crate::boundary;
use crate::cells::{CANDIDATES, GRID, Grid, ROWS};
use crate::state::{PARAMS, Params, STATE};

/// The visit of the neighbours in a list.
pub const NEIGHBOURS: WgslModule =
    WgslModule { name: "sph/neighbours", source: include_str!("neighbours.wgsl") };

/// The encoding of an entry.
pub const NEIGHBOUR_ENTRIES: WgslModule =
    WgslModule { name: "sph/neighbour_entries", source: include_str!("neighbour_entries.wgsl") };

bindings! {
    /// The buffers of `list_neighbours.wgsl`.
    pub(super) struct ListBindings {
        params: uniform Params,
        grid: uniform Grid,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        neighbours: write [UVec4],
    }
}

/// See the module.
pub static LIST_NEIGHBOURS: PassDesc = PassDesc {
    label: "neighbours",
    wgsl: include_str!("list_neighbours.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, boundary::IMAGES, CANDIDATES, NEIGHBOUR_ENTRIES],
    entry: "list_neighbours",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ListBindings::LIST,
    cpu: |_, slots| cpu::list_neighbours(slots.into()),
};
