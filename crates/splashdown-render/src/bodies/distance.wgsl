// How far the nearest solid is, for the liquid's thickness in front of it. Needs globals.wgsl.

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

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    // As in thickness.wgsl: from the middle of the box.
    let middle = 0.5 * (globals.box_min + globals.box_max);
    return vec4f(length(in.from_eye) - length(middle - globals.eye), 0.0, 0.0, 0.0);
}
