// Sky and floor. Needs globals.wgsl, environment.wgsl, fullscreen.wgsl.

struct Output {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> Output {
    let ray = view_ray(position.xy);
    let ray_length = length(ray);
    let direction = ray / ray_length;
    let distance = floor_distance(globals.eye, direction);
    var output: Output;
    if distance > 0.0 {
        output.colour = vec4f(floor_colour(globals.eye, direction, distance, globals.pixel_angle), 1.0);
        output.depth = clamp(depth_of(distance / ray_length), 0.0, 1.0);
    } else {
        output.colour = vec4f(sky(direction), 1.0);
        output.depth = 0.0;
    }
    output.colour = vec4f(present(output.colour.rgb), 1.0);
    return output;
}
