// One direction of the narrow-range filter; the first two also work out how much of the neighbourhood is liquid.
// Needs globals.wgsl, narrow_range.wgsl.

override STEP_X: f32 = 1.0;
override STEP_Y: f32 = 0.0;
// Reach of the filter, in radii of the splats; the Gaussian's deviation is a third of it.
override REACH: f32 = 3.0;
// 1 where the share of liquid is averaged along this direction, 0 where it is handed on.
override SHARE: u32 = 1u;

const MOST_TAPS = 24.0;
// Reach of the average of the share of liquid, in radii of the splats; the deviation is half of it.
const SHARE_REACH = 1.2;

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(corner * 4.0 - 1.0, 0.0, 1.0);
}

// Pixels of a length seen from a distance.
fn pixels(length: f32, distance: f32) -> f32 {
    return length / (distance * globals.pixel_angle);
}

fn offset(i: f32) -> vec2i {
    return vec2i(round(i * vec2f(STEP_X, STEP_Y)));
}

// The average of the share of liquid around a pixel, with a Gaussian that suits a distance.
fn share_around(here: vec2i, distance: f32) -> f32 {
    // At least the deviation that softens an outline over a pixel.
    let reach = max(pixels(SHARE_REACH * globals.splat_radius, distance), 1.2);
    let taps = ceil(clamp(reach, 1.0, MOST_TAPS));
    let stride = max(reach / taps, 1.0);
    let falloff = -2.0 * stride * stride / (reach * reach);
    var sum = load(here).g;
    var weights = 1.0;
    for (var i = 1.0; i <= taps; i += 1.0) {
        let weight = exp(falloff * i * i);
        sum += weight * (load(here + offset(i * stride)).g + load(here - offset(i * stride)).g);
        weights += 2.0 * weight;
    }
    return sum / weights;
}

// The distance of the nearest liquid in this direction that is near enough to count for a pixel without any.
fn neighbour(here: vec2i) -> f32 {
    for (var i = 1.0; i <= MOST_TAPS; i += 1.0) {
        let distance = min(load(here + offset(i)).r, load(here - offset(i)).r);
        if distance < NOTHING {
            return distance;
        }
    }
    return NOTHING;
}

// Discs of volume reach farther than spheres: where there is none, no sphere is near.
fn liquid_is_near(here: vec2i) -> bool {
    let seen = here - vec2i(i32(globals.splat_margin));
    let last = vec2i(globals.picture_size) - 1;
    return textureLoad(thickness, clamp(seen, vec2i(0), last) / 2, 0).r > 0.0;
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let here = vec2i(position.xy);
    let own = load(here);
    var share = own.g;
    if own.r >= NOTHING {
        if SHARE == 1u && liquid_is_near(here) {
            let distance = neighbour(here);
            if distance < NOTHING {
                share = share_around(here, distance);
            }
        }
        return vec4f(NOTHING, share, 0.0, 0.0);
    }
    if SHARE == 1u {
        share = share_around(here, own.r);
    }
    // Seen from near, the reach is many pixels; then samples stand apart.
    let reach = pixels(REACH * globals.splat_radius, own.r);
    let taps = ceil(clamp(reach, 1.0, MOST_TAPS));
    let stride = max(reach / taps, 1.0);
    let falloff = -4.5 * stride * stride / (reach * reach);
    var state = filter_begin(own.r);
    for (var i = 1.0; i <= taps; i += 1.0) {
        let away = offset(i * stride);
        let weight = exp(falloff * i * i);
        filter_add(&state, sample_distance(here + away), sample_distance(here - away), weight);
    }
    return vec4f(state.sum / state.weights, share, 0.0, 0.0);
}
