// The cubic spline without its factor, by the distance in units of the support radius; see spline.rs.
fn spline(q: f32) -> f32 {
    let a = max(1.0 - q, 0.0);
    let b = max(0.5 - q, 0.0);
    return a * a * a - 4.0 * (b * b * b);
}

fn spline4(q: vec4<f32>) -> vec4<f32> {
    let a = max(vec4<f32>(1.0) - q, vec4<f32>(0.0));
    let b = max(vec4<f32>(0.5) - q, vec4<f32>(0.0));
    return a * a * a - 4.0 * (b * b * b);
}
