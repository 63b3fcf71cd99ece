// What an eye in the liquid sees. Needs globals.wgsl, fullscreen.wgsl, refracted.wgsl.
//
// The rasterised surface has only faces that one sees from outside. Here a pixel whose ray leaves the liquid first is in
// it. So is one whose ray enters it before the near plane, which cuts that part of the surface away.

struct Output {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> Output {
    let ray = view_ray(position.xy);
    let along = 1.0 / length(ray);
    let direction = ray * along;
    let surface = nearest_of(globals.water_root, globals.eye, direction, no_hit(FAR));
    if surface.triangle == NO_TRIANGLE {
        discard;
    }
    let found = struck(surface);
    let is_inside = dot(direction, found.face) > 0.0;
    if !is_inside && surface.distance * along > globals.near {
        discard;
    }
    let body = nearest_of(globals.body_root, globals.eye, direction, surface);
    var light: vec3f;
    if is_inside {
        light = followed_light(globals.eye, direction, vec3f(0.0, 1.0, 0.0), 2.0 * globals.pixel_angle, pixel_of_picture(position.xy));
    } else {
        light = traced_liquid(globals.eye + direction * surface.distance, found.normal, pixel_of_picture(position.xy));
    }
    return Output(vec4f(present(light), 1.0), min(depth_of(max(body.distance * along, globals.near)), 1.0));
}
