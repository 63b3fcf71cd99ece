// The picture without the liquid as what refracted rays see. Needs globals.wgsl, environment.wgsl, and the bindings
// `scene_colour` (that picture, a layer per tile) and `scene_sampler`.

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
