// Marks the pixels that the stored surface covers, in a depth buffer. Needs fullscreen.wgsl,
// stored.wgsl.

@fragment
fn fragment_main(@builtin(position) position: vec4f) {
    if covered_samples(vec2u(position.xy)) == 0u {
        discard;
    }
}
