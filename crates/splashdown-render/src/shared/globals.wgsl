// What every shader of a frame reads. The Rust twin is `Globals` in globals.rs; a test compares the two layouts.

struct Edge {
    start: vec3f,
    opacity: f32,
    end: vec3f,
    dashes: f32,            // dashes along the edge; 0 draws a full line
}

struct Globals {
    clip_from_world: mat4x4f,
    eye: vec3f,
    near: f32,
    right: vec3f,           // half the picture's width at unit distance
    pixel_angle: f32,       // radians seen by one pixel in the middle of the picture
    up: vec3f,              // half the picture's height at unit distance
    encode_srgb: u32,       // 1 where the target does not encode by itself
    forward: vec3f,         // unit length
    liquid_film: f32,       // share of the liquid's own colour even where it is thin
    sun: vec3f,             // unit vector towards the sun
    floor_height: f32,
    box_min: vec3f,
    tile_size: f32,
    box_max: vec3f,
    fade_distance: f32,
    shadow_min: vec2f,      // corner of the shadow map on the floor, (x, z)
    shadow_size: vec2f,
    picture_size: vec2f,
    line_width: f32,        // pixels
    particle_radius: f32,
    shadow_absorption: vec3f, // per metre of fluid along the sun's ray
    shadow_particle_path: f32, // metres of fluid that one particle adds to one texel of the shadow map
    quantity: u32,          // 0 speed, 1 density, 2 pressure
    range_low: f32,
    range_scale: f32,       // 1 / (high - low)
    refractive_index: f32,
    liquid_absorption: vec3f, // per metre
    liquid_scattering: f32, // per metre
    liquid_colour: vec3f,
    liquid_roughness: f32,
    splat_radius: f32,      // of the spheres that the liquid is merged from
    amount_radius: f32,     // of the disc that a particle's volume is spread over
    amount: f32,            // metres of liquid in the middle of such a disc
    slice_quantity: u32,    // as `quantity`
    slice_axis: u32,        // the plane is perpendicular to: 0 x, 1 y, 2 z
    slice_position: f32,    // along that axis
    slice_support_radius: f32,
    slice_full: f32,        // sum of the kernel's weights inside the fluid, where its middle is 1
    slice_low: f32,
    slice_scale: f32,       // 1 / (high - low)
    splat_margin: f32,      // pixels by which the distances' picture is wider on each side
    foam_radius: f32,       // half the spacing of the particles that foam
    edges: array<Edge, 12>,
}

@group(0) @binding(0) var<uniform> globals: Globals;

// Direction of the ray through a pixel, not normalised: its component along `forward` is 1.
fn view_ray(pixel: vec2f) -> vec3f {
    let x = 2.0 * pixel.x / globals.picture_size.x - 1.0;
    let y = 1.0 - 2.0 * pixel.y / globals.picture_size.y;
    return globals.forward + x * globals.right + y * globals.up;
}

// Depth buffer value at a distance along `forward`: reversed, 1 at the near plane and 0 at infinity.
fn depth_of(distance: f32) -> f32 {
    return globals.near / distance;
}

fn srgb_from_linear(c: vec3f) -> vec3f {
    let high = 1.055 * pow(max(c, vec3f(0.0)), vec3f(1.0 / 2.4)) - 0.055;
    return select(high, 12.92 * c, c <= vec3f(0.0031308));
}

fn linear_from_srgb(c: vec3f) -> vec3f {
    let high = pow((c + 0.055) / 1.055, vec3f(2.4));
    return select(high, c / 12.92, c <= vec3f(0.04045));
}

// Linear colour to what the target stores.
fn encode(linear: vec3f) -> vec3f {
    if globals.encode_srgb == 1u {
        return srgb_from_linear(linear);
    }
    return linear;
}

// What the target stores back to linear colour.
fn decode(stored: vec3f) -> vec3f {
    if globals.encode_srgb == 1u {
        return linear_from_srgb(stored);
    }
    return stored;
}

// Bends everything above 0.75 softly below 1, so that highlights keep their shape; leaves the rest as it is.
fn soften(linear: vec3f) -> vec3f {
    let over = max(linear - 0.75, vec3f(0.0));
    return min(linear, vec3f(0.75)) + 0.25 * (1.0 - exp(-over / 0.25));
}
