// Droplets with traced rays. Needs refracted.wgsl.

@group(3) @binding(0) var<storage, read> droplets: array<vec4u>;

fn light_towards(origin: vec3f, direction: vec3f, spread: f32) -> vec3f {
    return arriving_light(origin, direction, spread);
}
