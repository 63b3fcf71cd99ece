// The depth of the liquid's surface alone, so that the costly shader runs once per pixel. Needs
// globals.wgsl. The position is computed as in liquid.wgsl.

@vertex
fn vertex_main(@location(0) vertex: vec4f) -> @builtin(position) @invariant vec4f {
    return globals.clip_from_world * vec4f(vertex.xyz, 1.0);
}

@fragment
fn fragment_main() -> @location(0) vec4f {
    return vec4f(0.0);
}
