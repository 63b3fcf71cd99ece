// Distance to the nearest body, which ends the liquid's thickness behind it. Needs globals.wgsl,
// eye_distance.wgsl.

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    return vec4f(relative_distance(in.from_eye), 0.0, 0.0, 0.0);
}
