// Normals of the surface of the liquid, from a mesh. Needs globals.wgsl, normal_code.wgsl.

struct Varying {
    @builtin(position) position: vec4f,
    // Centroid interpolation: extrapolated normals would cause bright pixels along the outline.
    @location(0) @interpolate(perspective, centroid) normal: vec3f,
}

@vertex
fn vertex_main(@location(0) vertex: vec4f, @location(1) normal: vec4f) -> Varying {
    var out: Varying;
    out.position = globals.clip_from_world * vec4f(vertex.xyz, 1.0);
    out.normal = normal.xyz;
    return out;
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec2u {
    return code_of_normal(in.normal);
}
