// How a liquid looks where the eye meets it: Fresnel between a mirrored and a refracted world. The mesh and the
// screen-space fluid share it. Needs globals.wgsl, environment.wgsl.

@group(2) @binding(0) var scene_colour: texture_2d<f32>;   // the picture without the liquid
@group(2) @binding(1) var thickness: texture_2d<f32>;      // metres of liquid along the view ray
@group(2) @binding(2) var scene_sampler: sampler;

// Unpolarised reflectance of a smooth dielectric seen from outside at the given cosine.
fn fresnel(cosine: f32) -> f32 {
    let n = globals.refractive_index;
    let inside = sqrt(max(1.0 - (1.0 - cosine * cosine) / (n * n), 0.0));
    let s = (cosine - n * inside) / (cosine + n * inside);
    let p = (inside - n * cosine) / (inside + n * cosine);
    return 0.5 * (s * s + p * p);
}

// Sun on a slightly rough water surface (GGX with its usual visibility term).
fn glint(normal: vec3f, to_eye: vec3f, facing: f32) -> f32 {
    let half_way = normalize(globals.sun + to_eye);
    let nh = max(dot(normal, half_way), 0.0);
    let nl = max(dot(normal, globals.sun), 0.0);
    let a = globals.liquid_roughness * globals.liquid_roughness;
    let d = nh * nh * (a * a - 1.0) + 1.0;
    let spread = a * a / (3.14159265 * d * d);
    let visibility = 0.5 / (mix(2.0 * nl * facing, nl + facing, a) + 1e-4);
    return spread * visibility * nl * fresnel(max(dot(half_way, to_eye), 0.0));
}

// Metres of liquid on the view ray through a point of the picture.
fn liquid_path(pixel: vec2f) -> f32 {
    return max(textureSampleLevel(thickness, scene_sampler, pixel / globals.picture_size, 0.0).r, 0.0);
}

// What the eye sees of liquid whose surface it meets at `world`, with `path` metres of liquid
// behind. The normal may have any length, and none stands for the direction to the eye.
fn liquid_colour(world: vec3f, outward: vec3f, path: f32) -> vec3f {
    let from_eye = world - globals.eye;
    let to_eye = -from_eye / max(length(from_eye), 1e-6);
    let length_squared = dot(outward, outward);
    var normal = select(to_eye, outward * inverseSqrt(max(length_squared, 1e-20)), length_squared > 1e-20);
    // Interpolated normals may lean away from the eye near the outline; bring them back to a grazing view.
    let lean = dot(normal, to_eye);
    normal = normalize(normal + to_eye * max(0.03 - lean, 0.0));
    let facing = max(dot(normal, to_eye), 0.0);

    let mirrored = reflect(-to_eye, normal);
    // A real sky is brighter than a floor under it; the background is drawn darker for the eye's sake.
    let reflection = 1.5 * environment(world, mirrored, 6.0 * globals.pixel_angle);

    let bent = refract(-to_eye, normal, 1.0 / globals.refractive_index);
    let leaving = globals.clip_from_world * vec4f(world + bent * path, 1.0);
    let uv = clamp(leaving.xy / max(leaving.w, globals.near) * vec2f(0.5, -0.5) + 0.5, vec2f(0.001), vec2f(0.999));
    let behind = decode(textureSampleLevel(scene_colour, scene_sampler, uv, 0.0).rgb);

    // Beer-Lambert on the way through, and the light that the liquid itself sends back.
    let clear = exp(-globals.liquid_absorption * path);
    let murk = 1.0 - (1.0 - globals.liquid_film) * exp(-globals.liquid_scattering * path);
    let sunny = 0.5 + 0.5 * dot(normal, globals.sun);
    let glow = globals.liquid_colour * (SKY_LIGHT * (0.6 + 0.4 * normal.y) + SUN_LIGHT * 0.45 * sunny);
    let transmitted = mix(behind * clear, glow, murk);

    let share = fresnel(facing);
    var colour = mix(transmitted, reflection, share);
    colour += SUN_LIGHT * min(3.0 * glint(normal, to_eye, facing), 4.0);
    return encode(soften(colour));
}
