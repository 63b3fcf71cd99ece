// The nearest body behind a point of the scene, for refracted rays. Needs globals.wgsl, picture_behind.wgsl, and the
// bindings `solid` (relative distance of the nearest body at half the resolution, a layer per tile) and `scene_sampler`.

// Relative distances above this one are those of pixels without a body.
const NO_BODY = 50000.0;

// Distance from the eye minus that of the middle of the box, as `solid` has it: 16-bit floats are more precise near 0.
fn relative_to_middle(world: vec3f) -> f32 {
    let middle = 0.5 * (globals.box_min + globals.box_max);
    return length(world - globals.eye) - length(middle - globals.eye);
}

// Relative distance of the nearest body in the pixels around a point: the picture is filtered there.
fn body_towards(world: vec3f) -> f32 {
    let place = place_in_scenes(world);
    let around = textureGather(0, solid, scene_sampler, place.uv, place.layer);
    return min(min(around.x, around.y), min(around.z, around.w));
}

// Distance along a ray at which it meets the body on the view ray through its origin, if it goes on in about that
// direction; -1 without such a body.
fn body_ahead(origin: vec3f, direction: vec3f) -> f32 {
    let body = body_towards(origin);
    let ahead = body - relative_to_middle(origin);
    // A body nearer than the origin hides it there, and is not behind it.
    let is_behind = body < NO_BODY && ahead > 0.0 && dot(direction, origin - globals.eye) > 0.0;
    return select(-1.0, ahead, is_behind);
}
