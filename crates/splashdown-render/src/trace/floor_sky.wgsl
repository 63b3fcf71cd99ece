// The fraction of the sky that bodies leave to each point of the floor, weighted by the cosine.
// Needs globals.wgsl, fullscreen.wgsl, trace.wgsl.

override SIDE: u32 = 128u;
const RAYS = 20u;

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let uv = position.xy / f32(SIDE);
    let on_floor = globals.shadow_min + uv * globals.shadow_size;
    let origin = vec3f(on_floor.x, globals.floor_height + 2.0 * globals.ray_offset, on_floor.y);
    let texel = vec2u(position.xy);
    // A rotation that differs between the 16 texels of a group, which the blur averages.
    let turn = f32((texel.x & 3u) * 4u + (texel.y & 3u)) / 16.0;
    var open = 0.0;
    for (var i = 0u; i < RAYS; i++) {
        let r2 = (f32(i) + 0.5) / f32(RAYS);
        let angle = 6.2831853 * (f32(i) * 0.6180340 + turn);
        let r = sqrt(r2);
        let direction = vec3f(r * cos(angle), sqrt(1.0 - r2), r * sin(angle));
        open += select(1.0, 0.0, meets_body(origin, direction));
    }
    return vec4f(open / f32(RAYS), 0.0, 0.0, 0.0);
}
