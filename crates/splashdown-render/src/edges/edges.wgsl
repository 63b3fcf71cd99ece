// The edges of the box as lines of constant width on the screen. Needs globals.wgsl.

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(linear) across: f32,   // pixels from the middle of the line
    @location(1) along: f32,                         // 0 at the start, 1 at the end
    @location(2) @interpolate(flat) edge: u32,
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32, @builtin(instance_index) edge: u32) -> Varying {
    let line = globals.edges[edge];
    // Both ends are clipped to the near plane before the perspective division.
    let start_distance = dot(line.start - globals.eye, globals.forward);
    let end_distance = dot(line.end - globals.eye, globals.forward);
    var s = 0.0;
    var e = 1.0;
    let slope = end_distance - start_distance;
    if start_distance < globals.near {
        s = (globals.near - start_distance) / slope;
    }
    if end_distance < globals.near {
        e = (globals.near - start_distance) / slope;
    }
    let hidden = start_distance < globals.near && end_distance < globals.near;
    let a = globals.clip_from_world * vec4f(mix(line.start, line.end, s), 1.0);
    let b = globals.clip_from_world * vec4f(mix(line.start, line.end, e), 1.0);
    let half_size = 0.5 * globals.target_size;
    let direction = b.xy / b.w * half_size - a.xy / a.w * half_size;
    let tangent = direction / max(length(direction), 1e-6);
    let normal = vec2f(-tangent.y, tangent.x);

    let at_end = (index & 1u) == 1u;
    let side = select(-1.0, 1.0, index >= 2u);
    let reach = 0.5 * globals.line_width + 1.0;
    var clip = select(a, b, at_end);
    let push = normal * side * reach + tangent * select(-0.5, 0.5, at_end) * globals.line_width;
    clip = vec4f(clip.xy + push / half_size * clip.w, clip.z, clip.w);
    // Depth bias: fluid in contact with the wall would otherwise hide parts of the line.
    clip.z *= 1.002;

    var out: Varying;
    out.position = select(clip, vec4f(2.0, 2.0, 2.0, 1.0), hidden);
    out.across = side * reach;
    out.along = select(s, e, at_end);
    out.edge = edge;
    return out;
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    let line = globals.edges[in.edge];
    var opacity = line.opacity * clamp(0.5 * globals.line_width + 0.5 - abs(in.across), 0.0, 1.0);
    if line.dashes > 0.0 {
        opacity *= select(0.0, 1.0, fract(in.along * line.dashes) < 0.5);
    }
    return vec4f(encode(vec3f(0.012, 0.020, 0.030)), opacity);
}
