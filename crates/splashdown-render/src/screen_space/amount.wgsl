// How much liquid a view ray crosses, summed over particles by blending. Needs globals.wgsl, sphere.wgsl.

@group(1) @binding(0) var solid: texture_2d<f32>;   // distance of the nearest solid, from the middle of the box
@group(2) @binding(0) var<storage, read> positions: array<vec4f>;   // xyz, and w: 0 in play

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) across: vec2f,        // length 1 on the sphere's outline
    @location(1) @interpolate(flat) distance: f32,  // from the eye to the centre
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    let corner = sphere_corner(positions[index / 6u], globals.amount_radius, index);
    return Varying(corner.position, corner.across, corner.centre.w);
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    let inside = max(1.0 - dot(in.across, in.across), 0.0);
    // Liquid behind a solid is not seen.
    let middle = 0.5 * (globals.box_min + globals.box_max);
    let solid_distance = textureLoad(solid, vec2u(in.position.xy), 0).r + length(middle - globals.eye);
    let radius = globals.amount_radius;
    let seen = clamp((solid_distance - in.distance) / (2.0 * radius) + 0.5, 0.0, 1.0);
    // A disc of weight (1 - q^2)^2, whose mean over the disc is 1/3; all of it together is the particle's volume.
    return vec4f(globals.amount * inside * inside * seen, 0.0, 0.0, 0.0);
}
