// Lights the smoothed distances and lays them over the picture. Needs globals.wgsl, environment.wgsl, liquid.wgsl.

@group(2) @binding(3) var distances: texture_2d<f32>;      // distance along the view's direction, share of liquid around

const NOTHING = 1e30;
// Share of liquid around a pixel at the outline, and the deviation of the average, in radii of the splats. A straight edge has
// a share of 0.5; the middle of a single drop has 0.69.
const OUTLINE = 0.56;
const SHARE_DEVIATION = 0.65;

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(corner * 4.0 - 1.0, 0.0, 1.0);
}

fn sample_distance(texel: vec2i) -> f32 {
    let size = vec2i(textureDimensions(distances));
    if any(texel < vec2i(0)) || any(texel >= size) {
        return NOTHING;
    }
    return textureLoad(distances, texel, 0).r;
}

// Where the liquid is in a pixel, from the eye.
fn place(texel: vec2i, distance: f32) -> vec3f {
    return view_ray(vec2f(texel) + 0.5) * distance;
}

// The surface's slope along an axis of the picture. Over an edge one of the two differences is large and wrong, so
// the smaller one counts there; elsewhere both do.
fn slope(texel: vec2i, axis: vec2i, here: vec3f) -> vec3f {
    let ahead = sample_distance(texel + axis);
    let behind = sample_distance(texel - axis);
    let forth = place(texel + axis, ahead) - here;
    let back = here - place(texel - axis, behind);
    let middle = dot(here, globals.forward);
    let rise = abs(ahead - middle);
    let fall = abs(behind - middle);
    if max(rise, fall) > 2.0 * min(rise, fall) + globals.splat_radius {
        return select(back, forth, rise < fall);
    }
    return 0.5 * (forth + back);
}

struct Output {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> Output {
    let pixel = vec2i(position.xy);
    let own = textureLoad(distances, pixel, 0);
    let distance = own.r;
    if distance >= NOTHING {
        discard;
    }
    // The outline is where the share of liquid around falls below a bound. That trims the spheres' bumps; and as the share
    // falls over known pixels, it also says how much of the pixel is inside.
    let deviation = max(SHARE_DEVIATION * globals.splat_radius / (distance * globals.pixel_angle), 0.6);
    let covered = clamp((own.g - OUTLINE) * 2.5 * deviation + 0.5, 0.0, 1.0);
    if covered == 0.0 {
        discard;
    }
    let here = place(pixel, distance);
    let across = slope(pixel, vec2i(1, 0), here);
    let down = slope(pixel, vec2i(0, 1), here);
    var normal = cross(down, across);
    normal = select(normal, -normal, dot(normal, here) > 0.0);
    let colour = liquid_colour(globals.eye + here, normal, liquid_path(position.xy));
    return Output(vec4f(colour, covered), clamp(depth_of(distance), 0.0, 1.0));
}
