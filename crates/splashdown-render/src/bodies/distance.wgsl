// Distance of the nearest body. Liquid behind it does not count for the thickness. Needs
// globals.wgsl, eye_distance.wgsl.

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    return vec4f(relative_distance(in.from_eye), 0.0, 0.0, 0.0);
}
