// Droplets without traced rays. Needs environment.wgsl, picture_behind.wgsl.

@group(2) @binding(0) var<storage, read> droplets: array<vec4u>;
@group(2) @binding(1) var scene_colour: texture_2d_array<f32>; // the picture without the liquid, a layer per tile
@group(2) @binding(2) var solid: texture_2d_array<f32>;        // relative distance of the nearest body
@group(2) @binding(3) var scene_sampler: sampler;

// The environment; in front of a body, the place of the picture that the ray meets at the distance of the body.
fn light_towards(origin: vec3f, direction: vec3f, spread: f32) -> vec3f {
    let ahead = body_ahead(origin, direction);
    if ahead < 0.0 {
        return environment(origin, direction, spread);
    }
    return scene_at(origin + direction * ahead).rgb;
}
