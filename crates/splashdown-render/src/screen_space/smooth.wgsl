// One direction of the narrow-range filter. The first two passes also compute the liquid fraction:
// the weighted fraction of neighbouring pixels that contain liquid. Needs globals.wgsl,
// narrow_range.wgsl, fullscreen.wgsl.

override STEP_X: f32 = 1.0;
override STEP_Y: f32 = 0.0;
// Radius of the filter, in radii of the splats; the standard deviation of the Gaussian is a third
// of it.
override REACH: f32 = 3.0;
// 1: averages the liquid fraction along this direction. 0: copies it.
override AVERAGE_FRACTION: u32 = 1u;

const MAX_TAPS = 24.0;
// Radius of the average of the liquid fraction, in radii of the splats; the standard deviation is
// half of it.
const FRACTION_REACH = 1.2;

// Projected length in pixels at a distance.
fn pixels(length: f32, distance: f32) -> f32 {
    return length / (distance * globals.pixel_angle);
}

fn offset(i: f32) -> vec2i {
    return vec2i(round(i * vec2f(STEP_X, STEP_Y)));
}

// Gaussian average of the liquid fraction around a pixel; the width follows from the distance.
fn average_fraction(here: vec2i, distance: f32) -> f32 {
    // The minimum smooths the outline over one pixel.
    let reach = max(pixels(FRACTION_REACH * globals.splat_radius, distance), 1.2);
    let taps = ceil(clamp(reach, 1.0, MAX_TAPS));
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

// Distance of the nearest liquid along this direction within the filter radius, for a pixel without
// liquid.
fn neighbour(here: vec2i) -> f32 {
    for (var i = 1.0; i <= MAX_TAPS; i += 1.0) {
        let distance = min(load(here + offset(i)).r, load(here - offset(i)).r);
        if distance < NO_LIQUID {
            return distance;
        }
    }
    return NO_LIQUID;
}

// True if the thickness is positive. The discs of the thickness are larger than the spheres, so
// where this is false no sphere is near.
fn liquid_is_near(here: vec2i) -> bool {
    let corner = vec2i(globals.tile_corner);
    let in_picture = here - vec2i(i32(globals.splat_margin)) + corner;
    let seen = clamp(in_picture, vec2i(0), vec2i(globals.picture_size) - 1) - corner;
    return textureLoad(thickness, clamp(seen, vec2i(0), vec2i(globals.target_size) - 1) / 2, 0).r > 0.0;
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let here = vec2i(position.xy);
    let own = load(here);
    var fraction = own.g;
    if own.r >= NO_LIQUID {
        if AVERAGE_FRACTION == 1u && liquid_is_near(here) {
            let distance = neighbour(here);
            if distance < NO_LIQUID {
                fraction = average_fraction(here, distance);
            }
        }
        return vec4f(NO_LIQUID, fraction, 0.0, 0.0);
    }
    if AVERAGE_FRACTION == 1u {
        fraction = average_fraction(here, own.r);
    }
    // At close range the radius spans many pixels; samples are then more than one pixel apart.
    let reach = pixels(REACH * globals.splat_radius, own.r);
    let taps = ceil(clamp(reach, 1.0, MAX_TAPS));
    let stride = max(reach / taps, 1.0);
    let falloff = -4.5 * stride * stride / (reach * reach);
    var state = filter_begin(own.r);
    for (var i = 1.0; i <= taps; i += 1.0) {
        let away = offset(i * stride);
        let weight = exp(falloff * i * i);
        filter_add(&state, sample_distance(here + away), sample_distance(here - away), weight);
    }
    return vec4f(state.sum / state.weights, fraction, 0.0, 0.0);
}
