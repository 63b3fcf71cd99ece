// Sky and floor behind everything: one triangle over the whole picture. Needs globals.wgsl, environment.wgsl.

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(corner * 4.0 - 1.0, 0.0, 1.0);
}

struct Output {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> Output {
    let ray = view_ray(position.xy);
    let stretch = length(ray);
    let direction = ray / stretch;
    let distance = floor_distance(globals.eye, direction);
    var output: Output;
    if distance > 0.0 {
        output.colour = vec4f(floor_colour(globals.eye, direction, distance, globals.pixel_angle), 1.0);
        output.depth = clamp(depth_of(distance / stretch), 0.0, 1.0);
    } else {
        output.colour = vec4f(sky(direction), 1.0);
        output.depth = 0.0;
    }
    output.colour = vec4f(encode(soften(output.colour.rgb)), 1.0);
    return output;
}
