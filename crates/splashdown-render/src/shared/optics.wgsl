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

// Reflectance of the surface of a liquid for diffuse light from inside, most of which is reflected totally (fit of
// Egan and Hilgeman 1979).
fn internal_reflectance() -> f32 {
    let n = globals.refractive_index;
    return 0.668 + 0.0636 * n + 0.710 / n - 1.440 / (n * n);
}

// Factors on the light of the sun (first column) and of the sky (second column) that a matte surface in the liquid
// sends out of it. Wet surfaces are darker (Lekner and Dorf 1988): light that leaves the liquid spreads over a larger
// solid angle, and of what is reflected back inside, the matte surface absorbs a part.
fn wet(albedo: vec3f) -> mat2x3f {
    let inside = internal_reflectance();
    let repeated = 1.0 / (1.0 - min(albedo, vec3f(1.0)) * inside);
    let spread = 1.0 / (globals.refractive_index * globals.refractive_index);
    return mat2x3f(spread * repeated, (1.0 - inside) * repeated);
}

// Fraction of the light that a pane of glass lets pass, with repeated reflection between its faces. `cosine`: of the
// angle of incidence.
const GLASS_INDEX = 1.5;
fn through_pane(cosine: f32) -> f32 {
    let one = reflectance(cosine, 1.0 / GLASS_INDEX);
    return (1.0 - one) / (1.0 + one);
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
