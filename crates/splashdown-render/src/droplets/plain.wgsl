// Droplets without traced rays. Needs environment.wgsl.

@group(2) @binding(0) var<storage, read> droplets: array<vec4u>;

fn light_towards(origin: vec3f, direction: vec3f, spread: f32) -> vec3f {
    return environment(origin, direction, spread);
}
