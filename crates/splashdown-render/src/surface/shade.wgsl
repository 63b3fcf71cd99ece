// Shades the stored surface once per pixel. Needs globals.wgsl, fullscreen.wgsl, environment.wgsl,
// optics.wgsl, liquid.wgsl, stored.wgsl.

// Samples of a pixel are shaded together if the cosine between their normals is above this value, an
// angle of one degree, and if their depths differ by less than this ratio. A surface at a grazing
// angle changes its depth by up to three per cent within a pixel.
const SAME_DIRECTION = 0.9998;
const SAME_DEPTH = 0.03;

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let ray = view_ray(position.xy);
    let covered = covered_samples(pixel);
    var colour = vec3f(0.0);
    var left = covered;
    while left != 0u {
        let first = firstTrailingBit(left);
        left &= left - 1u;
        let first_normal = normal_of_code(stored_code(pixel, first));
        let first_depth = stored_depth(pixel, first);
        var normal = first_normal;
        var depth = first_depth;
        var count = 1.0;
        for (var sample = first + 1u; sample < SAMPLES; sample++) {
            let other_normal = normal_of_code(stored_code(pixel, sample));
            let other_depth = stored_depth(pixel, sample);
            let is_same = dot(other_normal, first_normal) > SAME_DIRECTION
                && abs(other_depth - first_depth) < SAME_DEPTH * first_depth;
            if ((left >> sample) & 1u) == 1u && is_same {
                left &= ~(1u << sample);
                normal += other_normal;
                depth += other_depth;
                count += 1.0;
            }
        }
        let world = globals.eye + ray * (globals.near * count / depth);
        colour += count * liquid_colour(position.xy, world, normal);
    }
    return vec4f(colour / f32(max(countOneBits(covered), 1u)), 1.0);
}
