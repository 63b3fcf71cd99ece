// Procedural environment as a function of a ray: sky, sun and floor. Background and reflections use
// the same functions and therefore agree. Needs globals.wgsl.

@group(1) @binding(0) var shadow_map: texture_2d<f32>;
@group(1) @binding(1) var shadow_sampler: sampler;

const SUN_LIGHT = vec3f(1.0, 0.95, 0.86);
const SKY_LIGHT = vec3f(0.46, 0.52, 0.60);
const HORIZON = vec3f(0.66, 0.76, 0.85);

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
    return smoothstep(0.48, 0.80, density) * smoothstep(0.04, 0.30, direction.y);
}

// Colour of the sky in a unit direction; below the horizon, the colour of the horizon.
fn sky(direction: vec3f) -> vec3f {
    let height = max(direction.y, 0.0);
    var colour = mix(HORIZON, vec3f(0.25, 0.47, 0.76), smoothstep(0.0, 0.36, height));
    colour = mix(colour, vec3f(0.08, 0.21, 0.50), smoothstep(0.30, 1.0, height));
    if direction.y > 0.04 {
        colour = mix(colour, vec3f(0.95, 0.96, 0.97), 0.75 * clouds(direction));
    }
    let glow = max(dot(direction, globals.sun), 0.0);
    return colour + SUN_LIGHT * (0.25 * pow(glow, 24.0) + 1.5 * pow(glow, 600.0));
}

// Checkerboard averaged over a square of the given width (in tiles), which prevents aliasing; 0.5
// far away.
fn checker(p: vec2f, width: f32) -> f32 {
    let w = vec2f(max(width, 1e-4));
    let a = abs(fract((p - 0.5 * w) * 0.5) - 0.5);
    let b = abs(fract((p + 0.5 * w) * 0.5) - 0.5);
    let wave = 2.0 * (a - b) / w;
    return 0.5 - 0.5 * wave.x * wave.y;
}

// Fraction of the sunlight that reaches a point of the floor through the fluid.
fn sunlight_on_floor(p: vec2f) -> vec3f {
    let uv = (p - globals.shadow_min) / globals.shadow_size;
    let path = textureSampleLevel(shadow_map, shadow_sampler, uv, 0.0).r;
    let inside = select(0.0, 1.0, all(uv > vec2f(0.0)) && all(uv < vec2f(1.0)));
    return exp(-globals.shadow_absorption * max(path, 0.0) * inside);
}

// Colour of the floor where a ray of unit direction hits it after `distance`. `spread`: angular
// width of the ray.
fn floor_colour(origin: vec3f, direction: vec3f, distance: f32, spread: f32) -> vec3f {
    let p = (origin + direction * distance).xz;
    let width = distance * spread / (max(-direction.y, 0.02) * globals.tile_size);
    let albedo = mix(vec3f(0.385, 0.395, 0.41), vec3f(0.455, 0.465, 0.475), checker(p / globals.tile_size, width));
    let light = SUN_LIGHT * globals.sun.y * sunlight_on_floor(p) + SKY_LIGHT;
    let centre = 0.5 * (globals.box_min + globals.box_max).xz;
    let away = length(p - centre) / globals.fade_distance;
    let fog = 1.0 - exp(-away * away);
    return mix(albedo * light, HORIZON, fog);
}

// Distance along a ray to the floor, or -1 if the ray does not hit it.
fn floor_distance(origin: vec3f, direction: vec3f) -> f32 {
    let distance = (globals.floor_height - origin.y) / direction.y;
    return select(-1.0, distance, direction.y < -1e-5 && distance > 0.0);
}

// Colour of the environment in the unit direction of a ray, without the fluid.
fn environment(origin: vec3f, direction: vec3f, spread: f32) -> vec3f {
    let distance = floor_distance(origin, direction);
    if distance > 0.0 {
        return floor_colour(origin, direction, distance, spread);
    }
    return sky(direction);
}
