// Where a point of a body lies in the maps of the sunlight on bodies. Needs globals.wgsl.
//
// A point is projected to the floor along the sunlight: in the liquid along that below a still surface, outside along
// that of the sun. Surfaces that light reaches there rarely lie behind each other; layers by height separate those that
// do.

// Layers of each of the two maps, in a square of 4 x 4 tiles: first those of bodies in the liquid, then those outside.
const LAYERS = 8.0;
const TILES = 4.0;

// Direction to the sun below a still surface of the liquid.
fn sun_in_liquid() -> vec3f {
    let across = globals.sun.xz / globals.refractive_index;
    return vec3f(across.x, sqrt(1.0 - dot(across, across)), across.y);
}

fn sun_around(in_liquid: bool) -> vec3f {
    return select(globals.sun, sun_in_liquid(), in_liquid);
}

// Place on the map, from 0 to 1.
fn place_on_map(point: vec3f, towards_sun: vec3f) -> vec2f {
    let on_floor = point.xz - towards_sun.xz * ((point.y - globals.floor_height) / towards_sun.y);
    return (on_floor - globals.shadow_min) / globals.shadow_size;
}

fn layer_height() -> f32 {
    return max((globals.body_heights.y - globals.body_heights.x) / LAYERS, 1e-6);
}

// Height in layers above the lowest body.
fn height_in_layers(height: f32) -> f32 {
    return (height - globals.body_heights.x) / layer_height();
}
