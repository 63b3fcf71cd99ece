// Every point of a body that faces the sun receives the whole sunlight. Stands in for sunlit.wgsl where there are no
// trees of triangles.

fn sun_on(point: vec3f, normal: vec3f, in_liquid: bool) -> vec3f {
    return vec3f(max(dot(normal, globals.sun), 0.0));
}
