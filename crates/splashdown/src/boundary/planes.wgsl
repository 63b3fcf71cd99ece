// The integrals of one plane; see half_space.rs. WALL_KERNEL selects the kernels.
override WALL_KERNEL: u32 = 0u;

// (D, A) of the density's kernel.
fn wall_plane(q: f32) -> vec2<f32> {
    if (q >= 1.0) {
        return vec2(0.0);
    }
    let t = 1.0 - q;
    if (WALL_KERNEL == 0u) {
        let t5 = t * t * t * t * t;
        return vec2(0.5 * t5 * t * (3.0 * q * q + 3.0 * q + 1.0), 1.5 * t5 * (8.0 * q * q + 5.0 * q + 1.0));
    }
    let q2 = q * q;
    if (WALL_KERNEL == 1u) {
        if (q >= 0.5) {
            let t4 = t * t * t * t;
            return vec2(8.0 / 15.0 * t4 * t * (2.0 * q + 1.0), 1.6 * t4 * (4.0 * q + 1.0));
        }
        let d = 0.5 - 1.4 * q + q2 * q * (8.0 / 3.0 + q2 * (-24.0 / 5.0 + 16.0 / 5.0 * q));
        return vec2(d, 1.4 + q2 * (-8.0 + q2 * (24.0 - 96.0 / 5.0 * q)));
    }
    if (WALL_KERNEL == 3u) {
        // BLEND_SHARE of kernel/mod.rs is 0.35.
        let t4 = t * t * t * t;
        let d = 0.5 * t * (1.0 + q * (3.0 + 3.0 * q)) * (1.0 - 0.35) + (2.625 + t * (0.9375 * t - 3.0625)) * 0.35;
        let a = 1.5 * t * (1.0 + q * (5.0 + 8.0 * q)) * (1.0 - 0.35) + (13.125 + t * (6.5625 * t - 18.375)) * 0.35;
        return vec2(t4 * t * d, t4 * a);
    }
    let s = 1.0 - q2;
    let inner = 16.0 / 5.0 + t * (-16.0 / 3.0 + t * (24.0 / 7.0 + t * (t / 9.0 - 1.0)));
    return vec2(315.0 / 256.0 * t * t * t * t * t * inner, 315.0 / 256.0 * s * s * s * s);
}

// (D, A) of the gradient's kernel.
fn wall_plane_gradient(q: f32) -> vec2<f32> {
    if (WALL_KERNEL != 2u) {
        return wall_plane(q);
    }
    if (q >= 1.0) {
        return vec2(0.0);
    }
    let t = 1.0 - q;
    let t4 = t * t * t * t;
    return vec2(t4 * t * (1.5 - t), 1.5 * t4 * (1.0 + 4.0 * q));
}
