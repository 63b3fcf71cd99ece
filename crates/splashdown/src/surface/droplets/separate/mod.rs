//! Copies the particles that remain to an array of their own, and lists the isolated ones.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, WgslModule, bindings, wgsl};

use super::Droplet;
use crate::cells::{GRID, Grid};
use crate::surface::modules::{LATTICE, STATUS};
use crate::surface::params::Lattice;

/// The WGSL side of [`Droplet`].
const DROPLET: WgslModule = WgslModule { name: "surface/droplet", source: include_str!("../droplet.wgsl") };

bindings! {
    /// The buffers of `separate.wgsl`.
    pub(super) struct SeparateBindings {
        lattice: uniform Lattice,
        grid: uniform Grid,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        sorted_ids: read [u32],
        kept: read [u32],
        kept_starts: read [u32],
        kept_positions: write [Vec4],
        droplets: write [Droplet],
    }
}

pub(crate) static SEPARATE: PassDesc = PassDesc {
    label: "surface.separate",
    wgsl: include_str!("separate.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE, DROPLET],
    entry: "separate",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: SeparateBindings::LIST,
    cpu: |_, slots| cpu::separate(slots.into()),
};
