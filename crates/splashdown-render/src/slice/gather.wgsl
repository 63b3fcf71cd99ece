// Sums of W and W q over the particles near a plane, by blending. Each particle is drawn as the
// disc in which the plane intersects the support of its kernel. Needs globals.wgsl, quantity.wgsl.

@group(1) @binding(0) var<storage, read> positions: array<vec4f>;   // xyz; w is 0 for active particles
@group(1) @binding(1) var<storage, read> velocities: array<vec4f>;  // xyz, w ignored
@group(1) @binding(2) var<storage, read> densities: array<vec2f>;   // density, pressure

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) away: vec2f,          // offset from the particle within the plane, in support radii
    @location(1) @interpolate(flat) height: f32,    // of the particle above the plane, in support radii
    @location(2) @interpolate(flat) value: f32,     // 0 and 1 at the ends of the colour map
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    let particle = index / 6u;
    // Two triangles, corners 0 1 2 and 2 1 3, packed two bits each.
    let corner = (0xDA4u >> (2u * (index % 6u))) & 3u;
    let side = vec2f(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0;
    let axis = globals.slice_axis;
    var position = positions[particle];
    var out: Varying;
    out.height = (position[axis] - globals.slice_position) / globals.slice_support_radius;
    // Also false for NaN.
    if !(abs(out.height) < 1.0 && position.w == 0.0) {
        out.position = vec4f(2.0, 2.0, 2.0, 1.0);
        return out;
    }
    out.away = side * sqrt(1.0 - out.height * out.height);
    let reach = out.away * globals.slice_support_radius;
    position[axis] = globals.slice_position;
    position[(axis + 1u) % 3u] += reach.x;
    position[(axis + 2u) % 3u] += reach.y;
    out.position = globals.clip_from_world * vec4f(position.xyz, 1.0);
    let quantity = quantity_of(globals.slice_quantity, velocities[particle], densities[particle]);
    // Limits the value to what 16-bit floats resolve. The limit is far outside the colour map, so
    // that averages near its ends remain correct.
    out.value = clamp((quantity - globals.slice_low) * globals.slice_scale, -8.0, 8.0);
    return out;
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    // Wendland C2 kernel, scaled to W(0) = 1.
    let q = min(sqrt(dot(in.away, in.away) + in.height * in.height), 1.0);
    let rest = 1.0 - q;
    let weight = rest * rest * rest * rest * (1.0 + 4.0 * q);
    return vec4f(weight * in.value, weight, 0.0, 0.0);
}
