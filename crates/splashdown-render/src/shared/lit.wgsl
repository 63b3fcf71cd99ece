// Every point of a body receives the whole sunlight. Stands in for trace.wgsl where there are no
// trees of triangles.

fn sunlight_at(position: vec3f, normal: vec3f) -> f32 {
    return 1.0;
}
