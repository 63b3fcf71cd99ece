use splashdown_gpu::{CpuWork, Slot, dispatch_groups};

use crate::surface::params::{Lattice, Status};

pub(super) fn finish(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [lattice, vertex_starts, triangle_starts, status, draw_args, vertex_groups, triangle_groups] = slots
    else {
        unreachable!()
    };
    let lattice = lattice.get::<Lattice>();
    let total = |starts: &Slot<'_>| starts.read::<u32>()[lattice.block_capacity as usize];
    let status = &mut status.write::<Status>()[0];
    status.vertices_needed = total(vertex_starts);
    status.triangles_needed = total(triangle_starts);
    status.vertices = status.vertices_needed.min(lattice.vertex_capacity);
    status.triangles = status.triangles_needed.min(lattice.triangle_capacity);
    draw_args.write::<u32>()[..5].copy_from_slice(&[3 * status.triangles, 1, 0, 0, 0]);
    vertex_groups.write::<u32>()[..3].copy_from_slice(&dispatch_groups(status.vertices.div_ceil(64)));
    triangle_groups.write::<u32>()[..3].copy_from_slice(&dispatch_groups(status.triangles.div_ceil(64)));
}
