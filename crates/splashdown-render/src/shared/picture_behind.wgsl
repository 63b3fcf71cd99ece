// The picture without the liquid as what refracted rays see, and the nearest body in it. Needs globals.wgsl,
// environment.wgsl, and the bindings `scene_colour` (that picture, a layer per tile), `solid` (relative distance of the
// nearest body at half the resolution, a layer per tile) and `scene_sampler`.

// The place of a point in textures with a layer per tile.
struct PlaceInScenes {
    uv: vec2f,
    layer: i32,
}

// Where the view ray through a point of the scene is; at the nearest border if that is outside the picture.
fn place_in_scenes(world: vec3f) -> PlaceInScenes {
    let clip = globals.clip_from_world * vec4f(world, 1.0);
    let in_target = clip.xy / max(clip.w, globals.near) * vec2f(0.5, -0.5) + 0.5;
    let in_picture = (in_target * globals.target_size + globals.tile_corner) / globals.picture_size;
    let pixel = clamp(in_picture, vec2f(0.001), vec2f(0.999)) * globals.picture_size;
    // Its tile, which may be another one.
    let tile = clamp(floor(pixel / globals.tile_stride), vec2f(0.0), globals.tile_grid - 1.0);
    let uv = (pixel - tile * globals.tile_stride + globals.tile_border) / globals.target_size;
    return PlaceInScenes(uv, i32(tile.y * globals.tile_grid.x + tile.x));
}

// The picture behind the liquid at a point of the scene: its light, and the fraction of what is behind bubbles that they
// do not hide.
fn scene_at(world: vec3f) -> vec4f {
    let place = place_in_scenes(world);
    let stored = textureSampleLevel(scene_colour, scene_sampler, place.uv, place.layer, 0.0);
    return vec4f(light_of(stored.rgb), stored.a);
}

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
