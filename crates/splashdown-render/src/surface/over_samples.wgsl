// Writes the shaded liquid into the samples that it covers. Needs fullscreen.wgsl, stored.wgsl.

@group(2) @binding(0) var liquid: texture_2d<f32>;

struct Output {
    @location(0) colour: vec4f,
    @builtin(sample_mask) covered: u32,
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> Output {
    let pixel = vec2u(position.xy);
    let covered = covered_samples(pixel);
    if covered == 0u {
        discard;
    }
    return Output(textureLoad(liquid, pixel, 0), covered);
}
