// Narrow-range filter, shared by its passes. Needs globals.wgsl.
//
// N. Truong and C. Yuksel, "A narrow-range filter for screen-space fluid rendering", Proceedings of
// the ACM on Computer Graphics and Interactive Techniques 1(1), 2018. Distances are positive away
// from the eye.

@group(1) @binding(0) var distances: texture_2d<f32>;      // distance along the view direction, liquid fraction
@group(1) @binding(1) var thickness: texture_2d<f32>;      // length of the view ray inside the liquid, half resolution

// Distance of pixels without liquid.
const NO_LIQUID = 1e30;
// Range of the filter, and the distance behind the centre that replaces samples beyond the range,
// in radii of the splats. The authors use a range of 10.5. The smaller range avoids milky rims
// where other liquid lies a short distance behind.
const RANGE = 4.0;
const CLAMPED_OFFSET = 1.0;

struct Filter {
    centre: f32,
    nearest: f32,           // nearer samples belong to liquid in front
    farthest: f32,          // farther samples belong to the rim or to liquid behind
    sum: f32,
    weights: f32,
}

fn filter_begin(centre: f32) -> Filter {
    let range = RANGE * globals.splat_radius;
    return Filter(centre, centre - range, centre + range, centre, 1.0);
}

// The first and the last texel that belong to the picture with its margin. A tile extends beyond them.
fn first_texel() -> vec2i {
    return max(-vec2i(globals.tile_corner), vec2i(0));
}

fn last_texel() -> vec2i {
    let of_picture = vec2i(globals.picture_size + 2.0 * globals.splat_margin - globals.tile_corner);
    return min(of_picture, vec2i(textureDimensions(distances))) - 1;
}

fn load(texel: vec2i) -> vec2f {
    return textureLoad(distances, clamp(texel, first_texel(), last_texel()), 0).rg;
}

// A sample for the filter. A sample outside the picture counts as liquid in front: the filter then
// also skips its mirror image, and the surface continues without a bend.
fn sample_distance(texel: vec2i) -> f32 {
    if any(texel < first_texel()) || any(texel > last_texel()) {
        return 0.0;
    }
    return textureLoad(distances, texel, 0).r;
}

// Adds two samples on opposite sides. Call it from the inside outwards, because the range widens
// with the samples inside it. If one sample is in front, both are skipped: one alone would tilt the
// surface.
fn filter_add(state: ptr<function, Filter>, a: f32, b: f32, weight: f32) {
    let nearest = (*state).nearest;
    let farthest = (*state).farthest;
    let pair = vec2f(a, b);
    if any(pair < vec2f(nearest)) {
        return;
    }
    let range = RANGE * globals.splat_radius;
    let beyond = pair > vec2f(farthest);
    let clamped = select(pair, vec2f((*state).centre + CLAMPED_OFFSET * globals.splat_radius), beyond);
    // Clamped samples lie within the range and cannot widen it.
    (*state).nearest = min(nearest, min(clamped.x, clamped.y) - range);
    (*state).farthest = max(farthest, max(clamped.x, clamped.y) + range);
    (*state).sum += weight * (clamped.x + clamped.y);
    (*state).weights += 2.0 * weight;
}
