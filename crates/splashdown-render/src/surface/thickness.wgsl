// Length of the view ray inside the liquid: distances to back faces minus distances to front faces,
// summed by blending. Needs globals.wgsl, eye_distance.wgsl.

@group(1) @binding(0) var solid: texture_2d<f32>;   // relative distance of the nearest body

@fragment
fn fragment_main(in: Varying, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    // On every ray a closed surface has as many front faces as back faces, so the constant
    // subtracted by relative_distance cancels. Liquid behind a body is invisible: its front and
    // back faces both take the distance of the body, and cancel.
    let behind = textureLoad(solid, vec2u(in.position.xy), 0).r;
    let distance = min(relative_distance(in.from_eye), behind);
    return vec4f(select(distance, -distance, front), 0.0, 0.0, 0.0);
}
