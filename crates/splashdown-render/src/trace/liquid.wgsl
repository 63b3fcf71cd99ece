// The surface of the liquid, with the path of light followed through it. Needs globals.wgsl,
// refracted.wgsl.

struct Varying {
    @builtin(position) @invariant position: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
}

@vertex
fn vertex_main(@location(0) vertex: vec4f, @location(1) normal: vec4f) -> Varying {
    var out: Varying;
    out.position = globals.clip_from_world * vec4f(vertex.xyz, 1.0);
    out.world = vertex.xyz;
    out.normal = normal.xyz;
    return out;
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    return vec4f(present(traced_liquid(in.world, in.normal, pixel_of_picture(in.position.xy))), 1.0);
}
