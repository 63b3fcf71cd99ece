// Procedural environment as a function of a ray: sky, sun and floor, as light without tone mapping.
// Background, reflections and refractions use the same functions and therefore agree. Needs
// globals.wgsl.

@group(1) @binding(0) var sunlight_map: texture_2d<f32>;   // fraction of the sunlight on the floor, per colour
@group(1) @binding(1) var sky_map: texture_2d<f32>;        // fraction of the sky that a point of the floor sees
@group(1) @binding(2) var map_sampler: sampler;

fn hash(p: vec2f) -> f32 {
    let q = fract(p * vec2f(0.1031, 0.1030));
    let r = q + dot(q, q.yx + 33.33);
    return fract((r.x + r.y) * r.x * 7.13);
}

fn value_noise(p: vec2f) -> f32 {
    let cell = floor(p);
    let f = fract(p);
    let w = f * f * (3.0 - 2.0 * f);
    let low = mix(hash(cell), hash(cell + vec2f(1.0, 0.0)), w.x);
    let high = mix(hash(cell + vec2f(0.0, 1.0)), hash(cell + vec2f(1.0, 1.0)), w.x);
    return mix(low, high, w.y);
}

fn clouds(direction: vec3f) -> f32 {
    let p = direction.xz / (direction.y + 0.15) * 1.4 + vec2f(3.7, 1.9);
    let density = 0.55 * value_noise(p) + 0.30 * value_noise(2.3 * p) + 0.15 * value_noise(5.1 * p);
    let covered = smoothstep(0.46 - globals.cloud_cover, 0.82 - globals.cloud_cover, density);
    return covered * smoothstep(0.05, 0.35, direction.y);
}

// Height of the distant hills above the horizon, as the sine of the angle.
fn hills(direction: vec3f) -> f32 {
    let around = atan2(direction.z, direction.x);
    let height = 0.030 + 0.014 * sin(3.0 * around + 1.0) + 0.009 * sin(7.0 * around + 4.0) + 0.004 * sin(17.0 * around);
    return globals.hill_height * height;
}

// Light from the sky in a unit direction, with hills at the horizon; below it, the haze of the
// horizon. The disc of the sun is not included: surfaces add its reflection as a highlight.
fn sky(direction: vec3f) -> vec3f {
    let height = max(direction.y, 0.0);
    var colour = mix(globals.horizon, globals.zenith, 1.0 - exp(-4.2 * height));
    if direction.y > 0.05 {
        colour = mix(colour, globals.clouds, globals.cloud_opacity * clouds(direction));
    }
    let from_sun = dot(direction, globals.sun);
    let half_way = 0.5 + 0.5 * from_sun;
    colour += globals.glow * half_way * half_way * half_way * exp(-5.0 * height);
    let glow = max(from_sun, 0.0);
    colour += globals.sun_light * (0.16 * pow(glow, 10.0) + 0.8 * pow(glow, 120.0) + 5.0 * pow(glow, 2400.0));
    let above_hills = direction.y - hills(direction);
    let hill = mix(globals.haze, globals.hills, smoothstep(0.0, 0.03, height));
    return mix(hill, colour, smoothstep(-0.002, 0.002, above_hills));
}

// Lines of a grid of unit squares, averaged over a square of the given width, which prevents
// aliasing: the fraction that is within `half_line` of a line.
fn grid_lines(p: vec2f, half_line: f32, width: f32) -> f32 {
    let w = vec2f(max(width, 1e-4));
    let low = p - 0.5 * w + half_line;
    let high = p + 0.5 * w + half_line;
    // Integral of the indicator of [0, 2 half_line] in each period.
    let a = floor(low) * 2.0 * half_line + min(fract(low), vec2f(2.0 * half_line));
    let b = floor(high) * 2.0 * half_line + min(fract(high), vec2f(2.0 * half_line));
    let covered = (b - a) / w;
    return 1.0 - (1.0 - covered.x) * (1.0 - covered.y);
}

// Fraction of the sunlight that reaches a point of the floor, per colour: less behind bodies and
// liquid, more where the liquid focuses it.
fn sunlight_on_floor(p: vec2f) -> vec3f {
    let uv = (p - globals.shadow_min) / globals.shadow_size;
    let inside = all(uv > vec2f(0.0)) && all(uv < vec2f(1.0));
    let light = textureSampleLevel(sunlight_map, map_sampler, uv, 0.0).rgb;
    return select(vec3f(1.0), light, inside);
}

// Fraction of the sky that a point of the floor sees.
fn sky_on_floor(p: vec2f) -> f32 {
    let uv = (p - globals.shadow_min) / globals.shadow_size;
    let inside = all(uv > vec2f(0.0)) && all(uv < vec2f(1.0));
    return select(1.0, textureSampleLevel(sky_map, map_sampler, uv, 0.0).r, inside);
}

// Fraction of dark squares in a checkerboard of unit squares, averaged over a square of the given
// width.
fn dark_squares(p: vec2f, width: f32) -> f32 {
    let w = vec2f(max(width, 1e-3));
    let sign_integral = 2.0 * (abs(fract(0.5 * (p - 0.5 * w)) - 0.5) - abs(fract(0.5 * (p + 0.5 * w)) - 0.5)) / w;
    return 0.5 - 0.5 * sign_integral.x * sign_integral.y;
}

// Reflectance of the floor at a point. Tiles are slabs of slate with joints. `width`: width of the
// ray in tiles.
fn floor_albedo(p: vec2f, width: f32) -> vec3f {
    let q = p / globals.tile_size;
    if globals.floor_pattern == 3u {
        return globals.floor_tint * 0.07;
    }
    if globals.floor_pattern == 2u {
        return globals.floor_tint * mix(0.105, 0.035, dark_squares(q, width));
    }
    let slab = hash(floor(q) + vec2f(0.5, 0.5));
    // Octaves of noise, each fading before it aliases.
    let coarse = value_noise(2.3 * q) - 0.5;
    let medium = (value_noise(9.0 * q + 5.0) - 0.5) * clamp(1.6 - 9.0 * width, 0.0, 1.0);
    let fine = (value_noise(47.0 * q + 11.0) - 0.5) * clamp(1.6 - 47.0 * width, 0.0, 1.0);
    let tone = 0.07 + 0.011 * (slab - 0.5) + 0.009 * coarse + 0.007 * medium + 0.009 * fine;
    let joint = grid_lines(q, 0.010, width);
    return globals.floor_tint * tone * (1.0 - 0.55 * joint);
}

// Light of the sun (first column) and of the sky (second column) on a point of the floor.
fn light_on_floor(p: vec2f) -> mat2x3f {
    return mat2x3f(globals.sun_light * globals.sun.y * sunlight_on_floor(p), globals.sky_light * sky_on_floor(p));
}

// Light from a point of the floor that a ray hits after `distance`. `spread`: angular width of the
// ray.
fn floor_colour(origin: vec3f, direction: vec3f, distance: f32, spread: f32) -> vec3f {
    let p = (origin + direction * distance).xz;
    let width = distance * spread / (max(-direction.y, 0.02) * globals.tile_size);
    let light = light_on_floor(p);
    let centre = 0.5 * (globals.box_min + globals.box_max).xz;
    let away = length(p - centre) / globals.fade_distance;
    let haze = 1.0 - exp(-away * away);
    return mix(floor_albedo(p, width) * (light[0] + light[1]), globals.haze, haze);
}

// Light from the environment in the unit direction of a ray, without fluid and bodies.
fn environment(origin: vec3f, direction: vec3f, spread: f32) -> vec3f {
    let distance = floor_distance(origin, direction);
    if distance > 0.0 {
        return floor_colour(origin, direction, distance, spread);
    }
    return sky(direction);
}
