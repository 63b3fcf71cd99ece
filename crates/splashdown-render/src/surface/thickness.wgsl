// How much liquid a view ray crosses: distances to back faces minus distances to front faces, summed by blending.
// Needs globals.wgsl.

@group(1) @binding(0) var solid: texture_2d<f32>;   // distance of the nearest solid, from the middle of the box

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) from_eye: vec3f,
}

@vertex
fn vertex_main(@location(0) vertex: vec4f) -> Varying {
    var out: Varying;
    out.position = globals.clip_from_world * vec4f(vertex.xyz, 1.0);
    out.from_eye = vertex.xyz - globals.eye;
    return out;
}

@fragment
fn fragment_main(in: Varying, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    // A closed surface has as many fronts as backs on every ray, so a constant cancels; with distances taken from the
    // middle of the box, half floats suffice.
    let middle = 0.5 * (globals.box_min + globals.box_max);
    // Liquid behind a solid is not seen: its front and its back both count as the solid, and cancel.
    let behind = textureLoad(solid, vec2u(in.position.xy), 0).r;
    let distance = min(length(in.from_eye) - length(middle - globals.eye), behind);
    return vec4f(select(distance, -distance, front), 0.0, 0.0, 0.0);
}
