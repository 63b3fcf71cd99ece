// Vertex shader of a mesh whose fragments need their distance from the eye. Needs globals.wgsl.

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) from_eye: vec3f,
}

@vertex
fn vertex_main(@location(0) vertex: vec4f) -> Varying {
    var out: Varying;
    out.position = globals.clip_from_world * vec4f(vertex.xyz, 1.0);
    out.from_eye = vertex.xyz - globals.eye;
    return out;
}

// Distance from the eye, minus the distance of the middle of the box, so that 16-bit floats
// suffice.
fn relative_distance(from_eye: vec3f) -> f32 {
    let middle = 0.5 * (globals.box_min + globals.box_max);
    return length(from_eye) - length(middle - globals.eye);
}
