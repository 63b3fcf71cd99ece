// Where sunlight meets the floor and bodies: each pixel follows one ray of the sun through panes and liquid and stores
// where it arrives. Needs globals.wgsl, fullscreen.wgsl, optics.wgsl, trace.wgsl, sun_layers.wgsl.

override SIDE: u32 = 512u;

// Surfaces that a ray crosses before its light counts as lost.
const CROSSINGS = 6;

// Fraction of the light of a ray that the panes of the tank let pass up to a distance.
fn through_tank(origin: vec3f, direction: vec3f, limit: f32) -> f32 {
    var light = 1.0;
    for (var pane = 0u; pane < 4u; pane++) {
        let axis = 2u * (pane >> 1u);
        let upper = pane & 1u;
        let is_glass = ((globals.sunlit_panes >> pane) & 1u) == 1u;
        let plane = select(globals.box_min[axis], globals.box_max[axis], upper == 1u);
        let distance = (plane - origin[axis]) / direction[axis];
        let place = origin + distance * direction;
        let other = 2u - axis;
        let is_beside = place[other] < globals.box_min[other] || place[other] > globals.box_max[other];
        if is_glass && distance > 0.0 && distance < limit && place.y < globals.box_max.y && !is_beside {
            light *= through_pane(abs(direction[axis]));
        }
    }
    return light;
}

const LOST = vec4f(-1.0, -1.0, 0.0, 0.0);

fn is_on_map(place: vec2f) -> bool {
    return all(place > vec2f(0.0)) && all(place < vec2f(1.0));
}

fn on_floor(point: vec3f, path: f32, light: f32) -> vec4f {
    let place = (point.xz - globals.shadow_min) / globals.shadow_size;
    return select(LOST, vec4f(place, path, light), is_on_map(place));
}

// The first coordinate also stores the layer: twice its number, counted from 1, is added.
fn on_body(point: vec3f, in_liquid: bool, path: f32, light: f32) -> vec4f {
    let place = place_on_map(point, sun_around(in_liquid));
    let layer = clamp(floor(height_in_layers(point.y)), 0.0, LAYERS - 1.0) + select(LAYERS, 0.0, in_liquid);
    return select(LOST, vec4f(place.x + 2.0 * (layer + 1.0), place.y, path, light), is_on_map(place));
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let side = vec2f(f32(SIDE));
    // A different place in the texel for every sample.
    let shift = fract(f32(globals.sample) * vec2f(0.7548777, 0.5698403));
    let uv = (floor(position.xy) + fract(shift + 0.5)) / side;
    let aim = globals.shadow_min + uv * globals.shadow_size;
    let start_height = globals.box_max.y - globals.floor_height;
    let up = (start_height + 1e-3 * start_height) / globals.sun.y;
    var origin = vec3f(aim.x, globals.floor_height, aim.y) + globals.sun * up;
    var direction = -globals.sun;
    var inside = false;
    var path = 0.0;
    var light = 1.0;
    for (var crossing = 0; crossing < CROSSINGS; crossing++) {
        let hit = nearest_hit(origin, direction);
        let to_floor = floor_distance(origin, direction);
        if hit.triangle == NO_TRIANGLE || (to_floor > 0.0 && to_floor < hit.distance) {
            if to_floor < 0.0 {
                return LOST;
            }
            light *= through_tank(origin, direction, to_floor);
            path += select(0.0, to_floor, inside);
            return on_floor(origin + direction * to_floor, path, light);
        }
        let place = origin + direction * hit.distance;
        let found = struck(hit);
        path += select(0.0, hit.distance, inside);
        light *= through_tank(origin, direction, hit.distance);
        if found.is_body {
            return on_body(place, inside, path, light);
        }
        let leaving = dot(direction, found.face) > 0.0;
        if leaving && place.y - globals.floor_height < globals.contact_distance && found.face.y < 0.0 {
            return on_floor(place, path, light);
        }
        if leaving {
            let beyond = touched_body(place, direction);
            if beyond.triangle != NO_TRIANGLE {
                return on_body(place + direction * beyond.distance, true, path, light);
            }
        }
        let normal = facing_normal(select(found.normal, -found.normal, leaving), -direction);
        let ratio = select(1.0 / globals.refractive_index, globals.refractive_index, leaving);
        let mirrored = reflectance(-dot(direction, normal), ratio);
        if mirrored >= 1.0 {
            direction = reflect(direction, normal);
            inside = leaving;
        } else {
            light *= 1.0 - mirrored;
            direction = refract(direction, normal, ratio);
            inside = !leaving;
        }
        origin = place;
    }
    return LOST;
}
