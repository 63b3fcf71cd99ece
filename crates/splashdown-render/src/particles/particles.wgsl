// Sphere impostors: a triangle around the outline, with the intersection computed per pixel. Needs
// globals.wgsl, sphere.wgsl, quantity.wgsl.

@group(2) @binding(0) var<storage, read> positions: array<vec4f>;   // xyz; w is 0 for active particles
@group(2) @binding(1) var<storage, read> velocities: array<vec4f>;  // xyz, w ignored
@group(2) @binding(2) var<storage, read> densities: array<vec2f>;   // density, pressure
@group(2) @binding(3) var colour_map: texture_2d<f32>;              // 256 x 1

override SAMPLES: u32 = 4u;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) across: vec2f,        // length 1 on the sphere's outline
    @location(1) ray: vec3f,           // from the eye to a point of the triangle
    @location(2) @interpolate(flat) centre: vec4f,  // xyz: centre relative to the eye, w: distance
    @location(3) @interpolate(flat) base: vec3f,    // colour
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    let particle = index / 3u;
    let corner = sphere_corner(positions[particle], globals.particle_radius, index);
    var out: Varying;
    out.position = corner.position;
    out.across = corner.across;
    out.ray = corner.ray;
    out.centre = corner.centre;

    let quantity = quantity_of(globals.quantity, velocities[particle], densities[particle]);
    let place = clamp((quantity - globals.range_low) * globals.range_scale, 0.0, 1.0);
    out.base = textureLoad(colour_map, vec2u(u32(255.0 * place + 0.5), 0u), 0).rgb;
    return out;
}

struct Output {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
    @builtin(sample_mask) covered: u32,
}

// Mask of the pixel's samples that the disc covers. WebGPU defines the positions of four samples,
// here in sixteenths of a pixel.
fn coverage(across: vec2f, right: vec2f, down: vec2f) -> u32 {
    if SAMPLES == 1u {
        return select(0u, 1u, dot(across, across) <= 1.0);
    }
    let a = across + (-2.0 * right - 6.0 * down) / 16.0;
    let b = across + (6.0 * right - 2.0 * down) / 16.0;
    let c = across + (-6.0 * right + 2.0 * down) / 16.0;
    let d = across + (2.0 * right + 6.0 * down) / 16.0;
    let inside = vec4f(dot(a, a), dot(b, b), dot(c, c), dot(d, d)) <= vec4f(1.0);
    return dot(select(vec4u(0u), vec4u(1u, 2u, 4u, 8u), inside), vec4u(1u));
}

@fragment
fn fragment_main(in: Varying) -> Output {
    let covered = coverage(in.across, dpdx(in.across), dpdy(in.across));
    if covered == 0u {
        discard;
    }
    let distance = in.centre.w;
    let s = sphere_entry(in.across, in.ray, distance, globals.particle_radius);
    let normal = (s * in.ray - in.centre.xyz) / globals.particle_radius;

    let to_eye = -in.centre.xyz / distance;
    let sun = max(dot(normal, globals.sun), 0.0);
    let facing = max(dot(normal, to_eye), 0.0);
    // Sky light from above, some light from the floor, and the sun; darker towards the outline, so
    // that neighbouring spheres can be distinguished.
    let light = (0.68 + 0.20 * normal.y + 0.30 * sun) * (0.48 + 0.52 * facing);
    // Blinn-Phong highlight with exponent 32, by repeated squaring.
    let half_way = globals.sun + to_eye;
    let aligned = max(dot(normal, half_way), 0.0) * inverseSqrt(max(dot(half_way, half_way), 1e-6));
    let a4 = aligned * aligned * aligned * aligned;
    let a16 = a4 * a4 * a4 * a4;

    var output: Output;
    output.colour = vec4f(encode(min(in.base * light + 0.012 * light + 0.03 * a16 * a16, vec3f(1.0))), 1.0);
    output.covered = covered;
    output.depth = depth_of(s * dot(in.ray, globals.forward));
    return output;
}
