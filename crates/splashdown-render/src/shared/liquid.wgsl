// Shading of the liquid's surface: Fresnel blend of reflection and refraction, used for the mesh
// and the screen-space fluid. Needs globals.wgsl, environment.wgsl.

@group(2) @binding(0) var scene_colour: texture_2d<f32>;   // the picture without the liquid
@group(2) @binding(1) var thickness: texture_2d<f32>;      // length of the view ray inside the liquid, m
@group(2) @binding(2) var scene_sampler: sampler;

// Reflectance of a smooth dielectric for unpolarised light from outside (Fresnel equations).
// `cosine`: of the angle of incidence.
fn fresnel(cosine: f32) -> f32 {
    let n = globals.refractive_index;
    let inside = sqrt(max(1.0 - (1.0 - cosine * cosine) / (n * n), 0.0));
    let s = (cosine - n * inside) / (cosine + n * inside);
    let p = (inside - n * cosine) / (inside + n * cosine);
    return 0.5 * (s * s + p * p);
}

// Specular highlight of the sun on a slightly rough surface (GGX with its usual visibility term).
fn sun_highlight(normal: vec3f, to_eye: vec3f, facing: f32) -> f32 {
    let half_way = normalize(globals.sun + to_eye);
    let nh = max(dot(normal, half_way), 0.0);
    let nl = max(dot(normal, globals.sun), 0.0);
    let a = globals.liquid_roughness * globals.liquid_roughness;
    let d = nh * nh * (a * a - 1.0) + 1.0;
    let spread = a * a / (3.14159265 * d * d);
    let visibility = 0.5 / (mix(2.0 * nl * facing, nl + facing, a) + 1e-4);
    return spread * visibility * nl * fresnel(max(dot(half_way, to_eye), 0.0));
}

// Length in metres of the view ray inside the liquid.
fn liquid_path(pixel: vec2f) -> f32 {
    return max(textureSampleLevel(thickness, scene_sampler, pixel / globals.picture_size, 0.0).r, 0.0);
}

// Colour of the liquid at the surface point `world`, with `path` metres of liquid behind it. The
// normal may have any length; a zero normal is replaced by the direction to the eye.
fn liquid_colour(world: vec3f, outward: vec3f, path: f32) -> vec3f {
    let from_eye = world - globals.eye;
    let to_eye = -from_eye / max(length(from_eye), 1e-6);
    let length_squared = dot(outward, outward);
    var normal = select(to_eye, outward * inverseSqrt(max(length_squared, 1e-20)), length_squared > 1e-20);
    // Interpolated normals may face away from the eye near the outline; clamp them to a grazing
    // angle.
    let lean = dot(normal, to_eye);
    normal = normalize(normal + to_eye * max(0.03 - lean, 0.0));
    let facing = max(dot(normal, to_eye), 0.0);

    let mirrored = reflect(-to_eye, normal);
    // A real sky is brighter than a floor under it. The background is drawn darker, so compensate
    // here.
    let reflection = 1.5 * environment(world, mirrored, 6.0 * globals.pixel_angle);

    let bent = refract(-to_eye, normal, 1.0 / globals.refractive_index);
    let leaving = globals.clip_from_world * vec4f(world + bent * path, 1.0);
    let uv = clamp(leaving.xy / max(leaving.w, globals.near) * vec2f(0.5, -0.5) + 0.5, vec2f(0.001), vec2f(0.999));
    let behind = decode(textureSampleLevel(scene_colour, scene_sampler, uv, 0.0).rgb);

    // Absorption along the path (Beer-Lambert), and light scattered back by the liquid itself.
    let transmittance = exp(-globals.liquid_absorption * path);
    let turbidity = 1.0 - (1.0 - globals.liquid_film) * exp(-globals.liquid_scattering * path);
    let sun_facing = 0.5 + 0.5 * dot(normal, globals.sun);
    let glow = globals.liquid_colour * (SKY_LIGHT * (0.6 + 0.4 * normal.y) + SUN_LIGHT * 0.45 * sun_facing);
    let transmitted = mix(behind * transmittance, glow, turbidity);

    let reflectance = fresnel(facing);
    var colour = mix(transmitted, reflection, reflectance);
    colour += SUN_LIGHT * min(3.0 * sun_highlight(normal, to_eye, facing), 4.0);
    return encode(compress_highlights(colour));
}
