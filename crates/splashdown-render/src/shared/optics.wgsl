// Reflection at the surface of a liquid. Needs globals.wgsl.

// Reflectance of a smooth dielectric for unpolarised light (Fresnel equations); 1 in total internal
// reflection. `cosine`: of the angle of incidence; `ratio`: refractive index of the side from which
// the light comes, divided by that of the other side.
fn reflectance(cosine: f32, ratio: f32) -> f32 {
    let sine2 = ratio * ratio * (1.0 - cosine * cosine);
    if sine2 >= 1.0 {
        return 1.0;
    }
    let other = sqrt(1.0 - sine2);
    let s = (ratio * cosine - other) / (ratio * cosine + other);
    let p = (cosine - ratio * other) / (cosine + ratio * other);
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
    return spread * visibility * nl * reflectance(max(dot(half_way, to_eye), 0.0), 1.0 / globals.refractive_index);
}

// Fraction of a path of this length in metres over which the own colour of a turbid liquid replaces what
// is behind it.
fn turbidity(path: f32) -> f32 {
    return 1.0 - exp(-globals.liquid_scattering * path);
}

// Light that a turbid liquid scatters towards the eye below a point of its surface. Light also enters
// beside that point, so that the sides away from the sun are not black.
fn scattered_light(normal: vec3f) -> vec3f {
    let from_sky = 0.6 + 0.4 * normal.y;
    let from_sun = 0.5 + 0.5 * dot(normal, globals.sun);
    return globals.liquid_colour * (globals.sky_light * from_sky + globals.sun_light * from_sun);
}

// A unit normal on the side of the eye. Interpolated normals may face away from it near the outline;
// they are clamped to a grazing angle. A zero normal is replaced by the direction to the eye.
fn facing_normal(outward: vec3f, to_eye: vec3f) -> vec3f {
    let length_squared = dot(outward, outward);
    let normal = select(to_eye, outward * inverseSqrt(max(length_squared, 1e-20)), length_squared > 1e-20);
    let lean = dot(normal, to_eye);
    return normalize(normal + to_eye * max(0.03 - lean, 0.0));
}
