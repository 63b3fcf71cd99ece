// The nearest sphere in each pixel: its distance along the view direction, and 1 for liquid. Needs
// globals.wgsl, sphere.wgsl.

@group(1) @binding(0) var<storage, read> positions: array<vec4f>;   // xyz; w is 0 for active particles

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) across: vec2f,        // length 1 on the sphere's outline
    @location(1) ray: vec3f,           // from the eye to a point of the triangle
    @location(2) @interpolate(flat) distance: f32,  // from the eye to the centre
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    let corner = sphere_corner(positions[index / 3u], globals.splat_radius, index);
    // The texture extends beyond the picture by a margin, so that smoothing has data outside the
    // border.
    let shrink = globals.target_size / (globals.target_size + 2.0 * globals.splat_margin);
    let position = vec4f(corner.position.xy * shrink, corner.position.zw);
    return Varying(position, corner.across, corner.ray, corner.centre.w);
}

struct Output {
    @location(0) distance: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment_main(in: Varying) -> Output {
    if dot(in.across, in.across) > 1.0 {
        discard;
    }
    let s = sphere_entry(in.across, in.ray, in.distance, globals.splat_radius);
    let distance = s * dot(in.ray, globals.forward);
    return Output(vec4f(distance, 1.0, 0.0, 0.0), depth_of(distance));
}
