// Path length in fluid between the sun and each point of the floor, one point primitive per
// particle. Needs globals.wgsl.

@group(1) @binding(0) var<storage, read> positions: array<vec4f>;

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let particle = positions[index];
    let p = particle.xyz;
    let on_floor = p.xz - globals.sun.xz * ((p.y - globals.floor_height) / globals.sun.y);
    let uv = (on_floor - globals.shadow_min) / globals.shadow_size;
    // The negated condition is also true for NaN.
    if !(all(uv > vec2f(0.0)) && all(uv < vec2f(1.0)) && particle.w == 0.0) {
        return vec4f(2.0, 2.0, 2.0, 1.0);
    }
    return vec4f(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.5, 1.0);
}

@fragment
fn fragment_main() -> @location(0) vec4f {
    return vec4f(globals.shadow_particle_path, 0.0, 0.0, 0.0);
}
