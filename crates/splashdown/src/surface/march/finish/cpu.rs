use splashdown_gpu::dispatch_groups;

use super::FinishBindings;

pub(super) fn finish(buffers: FinishBindings<'_>) {
    let FinishBindings { lattice, vertex_starts, triangle_starts, status, .. } = buffers;
    status.vertices_needed = vertex_starts[lattice.block_capacity as usize];
    status.triangles_needed = triangle_starts[lattice.block_capacity as usize];
    status.vertices = status.vertices_needed.min(lattice.vertex_capacity);
    status.triangles = status.triangles_needed.min(lattice.triangle_capacity);
    buffers.draw_args[..5].copy_from_slice(&[3 * status.triangles, 1, 0, 0, 0]);
    buffers.vertex_groups[..3].copy_from_slice(&dispatch_groups(status.vertices.div_ceil(64)));
    buffers.triangle_groups[..3].copy_from_slice(&dispatch_groups(status.triangles.div_ceil(64)));
}
