// Path length in liquid between the sun and each point of the floor (x), and number of faces there (y), from a closed
// mesh. The surface writes the first, bodies the second. Needs globals.wgsl.

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) height: f32,
}

@vertex
fn vertex_main(@location(0) vertex: vec4f) -> Varying {
    let height = vertex.y - globals.floor_height;
    let on_floor = vertex.xz - globals.sun.xz * (height / globals.sun.y);
    let uv = (on_floor - globals.shadow_min) / globals.shadow_size;
    var out: Varying;
    out.position = vec4f(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.5, 1.0);
    out.height = height / globals.sun.y;
    return out;
}

@fragment
fn fragment_main(in: Varying, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    // As seen from the sun, liquid begins at front faces and ends at back faces.
    return vec4f(select(-in.height, in.height, front), 1.0, 0.0, 0.0);
}
