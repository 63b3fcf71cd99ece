#import gpu/index
#import surface/lattice

#bindings

@compute @workgroup_size(1)
fn finish() {
    let vertices = vertex_starts[lattice.block_capacity];
    let triangles = triangle_starts[lattice.block_capacity];
    status.vertices_needed = vertices;
    status.triangles_needed = triangles;
    status.vertices = min(vertices, lattice.vertex_capacity);
    status.triangles = min(triangles, lattice.triangle_capacity);
    // Arguments of an indexed indirect draw: index count, instance count, first index, base vertex,
    // first instance.
    draw_args[0] = 3u * status.triangles;
    draw_args[1] = 1u;
    draw_args[2] = 0u;
    draw_args[3] = 0u;
    draw_args[4] = 0u;
    let for_vertices = dispatch_groups((status.vertices + 63u) / 64u);
    let for_triangles = dispatch_groups((status.triangles + 63u) / 64u);
    for (var i = 0u; i < 3u; i++) {
        vertex_groups[i] = for_vertices[i];
        triangle_groups[i] = for_triangles[i];
    }
}
