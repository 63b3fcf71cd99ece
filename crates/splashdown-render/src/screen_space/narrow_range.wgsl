// The narrow-range filter's weights, shared by its passes. Needs globals.wgsl.
//
// N. Truong and C. Yuksel, "A narrow-range filter for screen-space fluid rendering", Proceedings of the ACM on Computer
// Graphics and Interactive Techniques 1(1), 2018. Distances grow away from the eye here.

@group(1) @binding(0) var distances: texture_2d<f32>;      // distance along the view's direction, share of liquid around
@group(1) @binding(1) var thickness: texture_2d<f32>;      // metres of liquid along the view ray, in half resolution

// Where there is no liquid.
const NOTHING = 1e30;
// Range of the filter, and how far behind the middle a sample beyond the range is taken to be, in radii of the
// splats. The authors' range is 10.5; less of it keeps milky rims off liquid that has other liquid not far
// behind it.
const RANGE = 4.0;
const PUSH = 1.0;

struct Filter {
    middle: f32,
    nearest: f32,           // samples nearer than this belong to liquid in front
    farthest: f32,          // samples farther than this are the rim or liquid behind
    sum: f32,
    weights: f32,
}

fn filter_begin(middle: f32) -> Filter {
    let range = RANGE * globals.splat_radius;
    return Filter(middle, middle - range, middle + range, middle, 1.0);
}

fn load(texel: vec2i) -> vec2f {
    let last = vec2i(textureDimensions(distances)) - 1;
    return textureLoad(distances, clamp(texel, vec2i(0), last), 0).rg;
}

// As a sample of the filter: outside of the texture it counts as liquid in front, so that its mirror image is
// left out too and the surface goes on as it comes.
fn sample_distance(texel: vec2i) -> f32 {
    let size = vec2i(textureDimensions(distances));
    if any(texel < vec2i(0)) || any(texel >= size) {
        return 0.0;
    }
    return textureLoad(distances, texel, 0).r;
}

// Adds two samples that lie opposite to each other; from the inside outward, because the range widens with what
// it holds. Where one of them is in front, both are left out: with one alone the surface would tilt.
fn filter_add(state: ptr<function, Filter>, a: f32, b: f32, weight: f32) {
    let nearest = (*state).nearest;
    let farthest = (*state).farthest;
    let pair = vec2f(a, b);
    if any(pair < vec2f(nearest)) {
        return;
    }
    let range = RANGE * globals.splat_radius;
    let beyond = pair > vec2f(farthest);
    let taken = select(pair, vec2f((*state).middle + PUSH * globals.splat_radius), beyond);
    // Clamped samples lie within the range and cannot widen it.
    (*state).nearest = min(nearest, min(taken.x, taken.y) - range);
    (*state).farthest = max(farthest, max(taken.x, taken.y) + range);
    (*state).sum += weight * (taken.x + taken.y);
    (*state).weights += 2.0 * weight;
}
