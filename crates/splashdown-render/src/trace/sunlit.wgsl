// Sunlight on bodies, behind other bodies and behind liquid, which focuses it. Needs globals.wgsl, environment.wgsl,
// trace.wgsl, sun_layers.wgsl.

@group(1) @binding(3) var body_sunlight: texture_2d<f32>;   // fraction of the sunlight on a horizontal surface, per colour

// The light in one layer, averaged over a few texels.
fn layer_light(place: vec2f, layer: f32) -> vec3f {
    let corner = vec2f(layer % TILES, floor(layer / TILES));
    let texel = TILES / vec2f(textureDimensions(body_sunlight));
    var sum = vec3f(0.0);
    for (var i = 0; i < 9; i++) {
        let step = vec2f(f32(i % 3 - 1), f32(i / 3 - 1));
        let weight = (2.0 - abs(step.x)) * (2.0 - abs(step.y)) / 16.0;
        // The sampler interpolates: half a texel at the border belongs to the next tile.
        let within = clamp(place + step * texel, 0.5 * texel, 1.0 - 0.5 * texel);
        sum += weight * textureSampleLevel(body_sunlight, map_sampler, (corner + within) / TILES, 0.0).rgb;
    }
    return sum;
}

// The light at the height of a point: of the two nearest layers.
fn mapped_light(point: vec3f, towards_sun: vec3f, in_liquid: bool) -> vec3f {
    let place = place_on_map(point, towards_sun);
    let first = select(LAYERS, 0.0, in_liquid);
    let lower = floor(height_in_layers(point.y) - 0.5);
    var light = vec3f(0.0);
    for (var i = 0; i < 2; i++) {
        let layer = lower + f32(i);
        if layer >= 0.0 && layer < LAYERS {
            light += layer_light(place, first + layer);
        }
    }
    return light;
}

// Light of the sun on a point of a body, as a factor on that on a surface outside which faces the sun.
fn sun_on(point: vec3f, normal: vec3f, in_liquid: bool) -> vec3f {
    let towards_sun = sun_around(in_liquid);
    let cosine = dot(normal, towards_sun);
    if cosine <= 0.0 {
        return vec3f(0.0);
    }
    let start = point + normal * (4.0 * globals.ray_offset);
    let is_behind_liquid =
        in_liquid || nearest_of(globals.water_root, start, globals.sun, no_hit(FAR)).triangle != NO_TRIANGLE;
    // The map does not separate bodies that are nearer than this.
    let reach = select(FAR, 1.5 * layer_height() / towards_sun.y, is_behind_liquid);
    if nearest_of(globals.body_root, start, towards_sun, no_hit(reach)).triangle != NO_TRIANGLE {
        return vec3f(0.0);
    }
    if !is_behind_liquid {
        return vec3f(cosine);
    }
    // From a horizontal surface to this one.
    return mapped_light(point, towards_sun, in_liquid) * (cosine * globals.sun.y / towards_sun.y);
}
