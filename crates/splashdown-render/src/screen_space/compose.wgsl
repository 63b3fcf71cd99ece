// Shades the smoothed distances and blends them over the picture. Needs globals.wgsl,
// environment.wgsl, liquid.wgsl, fullscreen.wgsl.

@group(2) @binding(4) var distances: texture_2d<f32>;      // distance along the view direction, liquid fraction

const NO_LIQUID = 1e30;
// Liquid fraction at the outline, and the standard deviation of its average, in radii of the
// splats. The fraction is 0.5 at a straight edge and 0.75 in the middle of a single drop.
const OUTLINE = 0.66;
const FRACTION_DEVIATION = 0.6;

fn sample_distance(texel: vec2i) -> f32 {
    let shifted = texel + vec2i(i32(globals.splat_margin));
    let corner = vec2i(globals.tile_corner);
    let end = min(vec2i(globals.picture_size + 2.0 * globals.splat_margin) - corner, vec2i(textureDimensions(distances)));
    if any(shifted < max(-corner, vec2i(0))) || any(shifted >= end) {
        return NO_LIQUID;
    }
    return textureLoad(distances, shifted, 0).r;
}

// Position of the liquid in a pixel, relative to the eye.
fn position_at(texel: vec2i, distance: f32) -> vec3f {
    return view_ray(vec2f(texel) + 0.5) * distance;
}

// Slope of the surface along an axis of the picture, from the differences to both sides. At an edge
// one of them is large and wrong, so the larger difference has the smaller weight. Switching
// between the two would produce dotted rims.
fn slope(texel: vec2i, axis: vec2i, here: vec3f) -> vec3f {
    let ahead = sample_distance(texel + axis);
    let behind = sample_distance(texel - axis);
    let middle = dot(here, globals.forward);
    let least = 0.2 * globals.splat_radius;
    let rise = max(abs(ahead - middle), least);
    let fall = max(abs(behind - middle), least);
    // Squared ratio of the smaller to the larger difference: 1 if both are equal, near 0 at an
    // edge.
    let ratio_ahead = min(fall / rise, 1.0);
    let ratio_behind = min(rise / fall, 1.0);
    let weight_ahead = ratio_ahead * ratio_ahead;
    let weight_behind = ratio_behind * ratio_behind;
    // NO_LIQUID is clamped, so that its product with a zero weight is zero.
    let forth = position_at(texel + axis, min(ahead, 2.0 * middle)) - here;
    let back = here - position_at(texel - axis, min(behind, 2.0 * middle));
    return (weight_ahead * forth + weight_behind * back) / (weight_ahead + weight_behind);
}

struct Output {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> Output {
    let pixel = vec2i(position.xy);
    let own = textureLoad(distances, pixel + vec2i(i32(globals.splat_margin)), 0);
    let distance = own.r;
    if distance >= NO_LIQUID {
        discard;
    }
    // The outline is the level set of the liquid fraction at a threshold, which removes the bumps
    // of the spheres. The fraction falls linearly over a known number of pixels, so it also gives
    // the coverage.
    let deviation = max(FRACTION_DEVIATION * globals.splat_radius / (distance * globals.pixel_angle), 0.6);
    let covered = clamp((own.g - OUTLINE) * 2.5 * deviation + 0.5, 0.0, 1.0);
    if covered == 0.0 {
        discard;
    }
    let here = position_at(pixel, distance);
    let across = slope(pixel, vec2i(1, 0), here);
    let down = slope(pixel, vec2i(0, 1), here);
    var normal = cross(down, across);
    normal = select(normal, -normal, dot(normal, here) > 0.0);
    let colour = liquid_colour(position.xy, globals.eye + here, normal);
    return Output(vec4f(colour, covered), clamp(depth_of(distance), 0.0, 1.0));
}
