// Length of the view ray inside the liquid, summed over particles by blending. Needs globals.wgsl,
// sphere.wgsl.

@group(1) @binding(0) var solid: texture_2d<f32>;   // relative distance of the nearest body
@group(2) @binding(0) var<storage, read> positions: array<vec4f>;   // xyz; w is 0 for active particles

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) across: vec2f,        // length 1 on the sphere's outline
    @location(1) @interpolate(flat) distance: f32,  // from the eye to the centre
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    let corner = sphere_corner(positions[index / 3u], globals.thickness_radius, index);
    return Varying(corner.position, corner.across, corner.centre.w);
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    let inside = max(1.0 - dot(in.across, in.across), 0.0);
    // Liquid behind a body is invisible.
    let middle = 0.5 * (globals.box_min + globals.box_max);
    let solid_distance = textureLoad(solid, vec2u(in.position.xy), 0).r + length(middle - globals.eye);
    let radius = globals.thickness_radius;
    let seen = clamp((solid_distance - in.distance) / (2.0 * radius) + 0.5, 0.0, 1.0);
    // Weight (1 - q^2)^2 with a mean of 1/3 over the disc; the integral is the volume of the
    // particle.
    return vec4f(globals.particle_thickness * inside * inside * seen, 0.0, 0.0, 0.0);
}
