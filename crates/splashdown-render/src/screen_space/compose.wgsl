// Lights the smoothed distances and lays them over the picture. Needs globals.wgsl, environment.wgsl, liquid.wgsl.

@group(2) @binding(3) var distances: texture_2d<f32>;      // distance along the view's direction, share of liquid around

const NOTHING = 1e30;
// Share of liquid around a pixel at the outline, and the deviation of the average, in radii of the splats. A
// straight edge has a share of 0.5; the middle of a single drop has 0.75.
const OUTLINE = 0.66;
const SHARE_DEVIATION = 0.6;

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(corner * 4.0 - 1.0, 0.0, 1.0);
}

fn sample_distance(texel: vec2i) -> f32 {
    let place = texel + vec2i(i32(globals.splat_margin));
    let size = vec2i(textureDimensions(distances));
    if any(place < vec2i(0)) || any(place >= size) {
        return NOTHING;
    }
    return textureLoad(distances, place, 0).r;
}

// Where the liquid is in a pixel, from the eye.
fn place(texel: vec2i, distance: f32) -> vec3f {
    return view_ray(vec2f(texel) + 0.5) * distance;
}

// The surface's slope along an axis of the picture, from the differences to both sides. Over an edge one of
// them is large and wrong, so each counts the less the larger it is; a switch from one to the other would leave
// dotted rims.
fn slope(texel: vec2i, axis: vec2i, here: vec3f) -> vec3f {
    let ahead = sample_distance(texel + axis);
    let behind = sample_distance(texel - axis);
    let middle = dot(here, globals.forward);
    let least = 0.2 * globals.splat_radius;
    let rise = max(abs(ahead - middle), least);
    let fall = max(abs(behind - middle), least);
    // Squares of the smaller over the larger: 1 where both are alike, 0 for the one at an edge.
    let share_ahead = min(fall / rise, 1.0);
    let share_behind = min(rise / fall, 1.0);
    let weight_ahead = share_ahead * share_ahead;
    let weight_behind = share_behind * share_behind;
    // Nothing is so far away that its difference could not be multiplied by 0.
    let forth = place(texel + axis, min(ahead, 2.0 * middle)) - here;
    let back = here - place(texel - axis, min(behind, 2.0 * middle));
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
    if distance >= NOTHING {
        discard;
    }
    // The outline is where the share of liquid around falls below a bound. That trims the spheres' bumps; and
    // as the share falls over known pixels, it also says how much of the pixel is inside.
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
