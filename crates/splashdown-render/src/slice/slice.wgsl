// A plane through the fluid, coloured by the weighted average of a quantity. Needs globals.wgsl.

@group(2) @binding(0) var sums: texture_2d<f32>;          // W q, W
@group(2) @binding(1) var colour_map: texture_2d<f32>;    // 256 x 1

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let axis = globals.slice_axis;
    let margin = vec3f(globals.slice_support_radius);
    let low = globals.box_min - margin;
    let high = globals.box_max + margin;
    var corner = low;
    corner[axis] = globals.slice_position;
    let u = (axis + 1u) % 3u;
    let v = (axis + 2u) % 3u;
    corner[u] = select(low[u], high[u], (index & 1u) == 1u);
    corner[v] = select(low[v], high[v], index > 1u);
    return globals.clip_from_world * vec4f(corner, 1.0);
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let sum = textureLoad(sums, vec2u(position.xy), 0).rg;
    // The weights sum to `slice_full` inside the fluid and to half of that at a flat free surface.
    let filled = sum.g / globals.slice_full - 0.5;
    let covered = clamp(filled / max(fwidth(filled), 1e-4) + 0.5, 0.0, 1.0);
    if covered == 0.0 {
        discard;
    }
    let place = clamp(sum.r / max(sum.g, 1e-6), 0.0, 1.0);
    let colour = textureLoad(colour_map, vec2u(u32(255.0 * place + 0.5), 0u), 0).rgb;
    return vec4f(encode(colour), covered);
}
