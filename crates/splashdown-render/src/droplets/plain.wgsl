// Droplets without traced rays. Needs environment.wgsl, picture_behind.wgsl.

@group(2) @binding(0) var<storage, read> droplets: array<vec4u>;
@group(2) @binding(1) var scene_colour: texture_2d_array<f32>; // the picture without the liquid, a layer per tile
@group(2) @binding(2) var solid: texture_2d<f32>;              // relative distance of the nearest body
@group(2) @binding(3) var scene_sampler: sampler;

// Relative distances above this one are those of pixels without a body.
const NO_BODY = 50000.0;

// The environment; in front of a body, the place of the picture that the ray meets at the distance of the body.
fn light_towards(origin: vec3f, direction: vec3f, spread: f32) -> vec3f {
    let from_eye = origin - globals.eye;
    let clip = globals.clip_from_world * vec4f(origin, 1.0);
    let uv = clip.xy / max(clip.w, globals.near) * vec2f(0.5, -0.5) + 0.5;
    let size = vec2f(textureDimensions(solid));
    let distance = textureLoad(solid, vec2u(clamp(uv * size, vec2f(0.0), size - 1.0)), 0).r;
    let middle = 0.5 * (globals.box_min + globals.box_max);
    let ahead = distance + length(middle - globals.eye) - length(from_eye);
    // A body nearer than the droplet hides it here, and is not behind it.
    if distance > NO_BODY || ahead <= 0.0 || dot(direction, from_eye) <= 0.0 {
        return environment(origin, direction, spread);
    }
    return scene_at(origin + direction * ahead);
}
