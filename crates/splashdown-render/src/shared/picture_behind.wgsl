// The picture without the liquid as what refracted rays see. Needs globals.wgsl, environment.wgsl, and the bindings
// `scene_colour` (that picture, a layer per tile) and `scene_sampler`.

// The picture behind the liquid at a point of the scene.
fn scene_at(world: vec3f) -> vec3f {
    let clip = globals.clip_from_world * vec4f(world, 1.0);
    let in_target = clip.xy / max(clip.w, globals.near) * vec2f(0.5, -0.5) + 0.5;
    let in_picture = (in_target * globals.target_size + globals.tile_corner) / globals.picture_size;
    let pixel = clamp(in_picture, vec2f(0.001), vec2f(0.999)) * globals.picture_size;
    // Its tile, which may be another one.
    let tile = clamp(floor(pixel / globals.tile_stride), vec2f(0.0), globals.tile_grid - 1.0);
    let uv = (pixel - tile * globals.tile_stride + globals.tile_border) / globals.target_size;
    let layer = i32(tile.y * globals.tile_grid.x + tile.x);
    return light_of(textureSampleLevel(scene_colour, scene_sampler, uv, layer, 0.0).rgb);
}
