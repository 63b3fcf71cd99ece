// Uniforms of every shader of a frame. Mirrors `Globals` in globals.rs; a test compares the two
// layouts.

struct Edge {
    start: vec3f,
    opacity: f32,
    end: vec3f,
    dashes: f32,            // number of dashes along the edge; 0: a solid line
}

struct Globals {
    clip_from_world: mat4x4f,
    eye: vec3f,
    near: f32,
    right: vec3f,           // half the picture's width at unit distance
    pixel_angle: f32,       // angle of one pixel in the middle of the picture, radians
    up: vec3f,              // half the picture's height at unit distance
    encode_srgb: u32,       // 1: the target format does not encode sRGB, so the shader does
    forward: vec3f,         // unit vector
    hill_height: f32,       // factor on the height of the distant hills
    sun: vec3f,             // unit vector towards the sun
    floor_height: f32,
    box_min: vec3f,
    tile_size: f32,
    box_max: vec3f,
    fade_distance: f32,
    shadow_min: vec2f,      // corner of the shadow map on the floor, (x, z)
    shadow_size: vec2f,
    picture_size: vec2f,    // of the whole picture
    line_width: f32,        // pixels
    particle_radius: f32,
    shadow_absorption: vec3f, // per metre of fluid along the sun's ray
    shadow_particle_path: f32, // path length that one particle adds to one texel of the shadow map, m
    quantity: u32,          // 0 speed, 1 density, 2 pressure
    range_low: f32,
    range_scale: f32,       // 1 / (high - low)
    refractive_index: f32,
    liquid_absorption: vec3f, // per metre
    liquid_scattering: f32, // per metre
    liquid_colour: vec3f,
    liquid_roughness: f32,
    splat_radius: f32,      // radius of the spheres of the screen-space surface
    thickness_radius: f32,  // radius of the disc over which a particle's volume is distributed
    particle_thickness: f32, // thickness of the liquid in the middle of such a disc, m
    slice_quantity: u32,    // as `quantity`
    slice_axis: u32,        // normal of the plane: 0 x, 1 y, 2 z
    slice_position: f32,    // along that axis
    slice_support_radius: f32,
    slice_full: f32,        // sum of the kernel weights inside the fluid, for a kernel with W(0) = 1
    slice_low: f32,
    slice_scale: f32,       // 1 / (high - low)
    splat_margin: f32,      // extra pixels on each side of the distance texture
    foam_radius: f32,       // radius of the fluid's particles
    droplet_radius: f32,
    droplet_shutter: f32,   // s; time for which droplets are blurred
    water_root: u32,        // root of the tree of the liquid's triangles
    body_root: u32,         // root of the tree of the bodies' triangles
    foam_light: vec3f,      // light from white foam that lies flat
    foam_shutter: f32,      // s; time for which foam, spray and bubbles are blurred
    ray_shift: vec3f,       // moves every view ray: place in the pixel, and on the lens
    linear_output: u32,     // 1: the target stores linear light, without tone mapping
    glass: vec4u,           // per axis: bit 0: the lower side is a pane of glass, bit 1: the upper one
    zenith: vec3f,          // light of the sky; module sky.rs describes these members
    floor_pattern: u32,     // 0: no floor, 1: tiles, 2: checkerboard, 3: plain
    horizon: vec3f,
    cloud_cover: f32,
    clouds: vec3f,
    cloud_opacity: f32,
    sun_light: vec3f,       // on a surface that faces the sun
    ray_offset: f32,        // m; rays ignore triangles nearer than this
    sky_light: vec3f,       // on a horizontal surface
    contact_distance: f32,  // m; liquid within this distance of the floor or a body touches it
    glow: vec3f,            // near the horizon on the side of the sun
    sample: u32,            // index of the sample of a picture with many samples
    haze: vec3f,            // the distant ground, where floor and hills meet
    sample_count: u32,
    hills: vec3f,
    shutter_time: f32,      // s; time of the sample relative to the frame
    floor_tint: vec3f,      // factor on the reflectance of the floor
    glass_thickness: f32,   // m
    bounced: vec3f,         // light from the floor on surfaces that face it
    sunlit_panes: u32,      // panes that take sunlight: bits 0 and 1 for x, 2 and 3 for z
    body_heights: vec2f,    // of the lowest and the highest point of all bodies
    tile_corner: vec2f,     // of the target in the picture, pixels; even numbers, outside at the left and at the top
    target_size: vec2f,     // of the texture that is drawn into: the picture, or a tile with its border
    tile_stride: vec2f,     // pixels from a tile to the next
    tile_grid: vec2f,       // number of columns and rows of tiles
    tile_border: f32,       // pixels around a tile that do not belong to it
    exit_reach: f32,        // pixels from which the normal of the liquid's far side follows; 0: it does not refract
    edges: array<Edge, 12>,
}

@group(0) @binding(0) var<uniform> globals: Globals;

// Direction of the ray through a pixel of the target, not normalised: its component along `forward` is 1.
fn view_ray(pixel: vec2f) -> vec3f {
    let in_picture = pixel + globals.tile_corner;
    let x = 2.0 * in_picture.x / globals.picture_size.x - 1.0;
    let y = 1.0 - 2.0 * in_picture.y / globals.picture_size.y;
    return globals.forward + globals.ray_shift + x * globals.right + y * globals.up;
}

// The pixel of the picture at a place of the target: the seed of pseudo-random numbers.
fn pixel_of_picture(place: vec2f) -> vec2u {
    return vec2u(vec2i(place + globals.tile_corner));
}

fn has_floor() -> bool {
    return globals.floor_pattern != 0u;
}

// Distance along a ray to the bottom of the tank, or -1 if the ray does not reach it.
fn bottom_distance(origin: vec3f, direction: vec3f) -> f32 {
    let distance = (globals.floor_height - origin.y) / direction.y;
    return select(-1.0, distance, direction.y < -1e-5 && distance > 0.0);
}

// Distance along a ray to the floor, or -1 if the ray does not hit it.
fn floor_distance(origin: vec3f, direction: vec3f) -> f32 {
    return select(-1.0, bottom_distance(origin, direction), has_floor());
}

// Depth buffer value at a distance along `forward`. Reversed depth: 1 at the near plane, 0 at
// infinity.
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

// Converts a linear colour to the encoding of the target.
fn encode(linear: vec3f) -> vec3f {
    if globals.encode_srgb == 1u {
        return srgb_from_linear(linear);
    }
    return linear;
}

// Converts a colour from the encoding of the target to linear.
fn decode(stored: vec3f) -> vec3f {
    if globals.encode_srgb == 1u {
        return linear_from_srgb(stored);
    }
    return stored;
}

// Tone mapping of data colours: compresses values above 0.75 smoothly below 1, leaves all others
// unchanged.
fn compress_highlights(linear: vec3f) -> vec3f {
    let over = max(linear - 0.75, vec3f(0.0));
    return min(linear, vec3f(0.75)) + 0.25 * (1.0 - exp(-over / 0.25));
}

const EXPOSURE = 0.80;

// Filmic tone mapping of light: a rational fit of the curve of the Academy Color Encoding System
// (Narkowicz, "ACES filmic tone mapping curve", 2016).
fn film(light: vec3f) -> vec3f {
    let x = max(light * EXPOSURE, vec3f(0.0));
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), vec3f(0.0), vec3f(1.0));
}

// The light that `film` maps to a value; the inverse of the fit, for values below 1.
fn light_of_film(shown: vec3f) -> vec3f {
    let y = clamp(shown, vec3f(0.0), vec3f(0.98));
    let a = 2.51 - 2.43 * y;
    let b = 0.03 - 0.59 * y;
    return (sqrt(b * b + 0.56 * a * y) - b) / (2.0 * a * EXPOSURE);
}

// Converts light to the colour that is stored.
fn present(light: vec3f) -> vec3f {
    if globals.linear_output == 1u {
        return light;
    }
    return encode(film(light));
}

// Converts a stored colour to light.
fn light_of(stored: vec3f) -> vec3f {
    if globals.linear_output == 1u {
        return stored;
    }
    return light_of_film(decode(stored));
}
