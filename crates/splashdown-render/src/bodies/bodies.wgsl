// Bodies: matte, lit by sun and sky. Needs globals.wgsl, environment.wgsl, matte.wgsl.

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(perspective, centroid) world: vec3f,
    @location(1) @interpolate(perspective, centroid) normal: vec3f,
    @location(2) @interpolate(flat) colour: vec3f,
}

@vertex
fn vertex_main(@location(0) vertex: vec4f, @location(1) normal: vec4f, @location(2) colour: vec4f) -> Varying {
    var out: Varying;
    out.position = globals.clip_from_world * vec4f(vertex.xyz, 1.0);
    out.world = vertex.xyz;
    out.normal = normal.xyz;
    out.colour = colour.rgb;
    return out;
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    let to_eye = normalize(globals.eye - in.world);
    return vec4f(present(matte(in.world, in.normal, in.colour, to_eye)), 1.0);
}
