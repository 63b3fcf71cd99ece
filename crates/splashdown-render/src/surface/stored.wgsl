// The stored surface. Needs normal_code.wgsl, and one_sample.wgsl or four_samples.wgsl.

// The samples of a pixel that it covers, as bits.
fn covered_samples(pixel: vec2u) -> u32 {
    var covered = 0u;
    for (var sample = 0u; sample < SAMPLES; sample++) {
        if any(stored_code(pixel, sample) != NO_SURFACE) {
            covered |= 1u << sample;
        }
    }
    return covered;
}
