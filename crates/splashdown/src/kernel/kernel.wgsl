// The kernels of kernel/mod.rs: W = kernel_w(q) / H^3, grad W = kernel_g(q) / H^5 * (x_i - x_j).
override KERNEL: u32 = 0u;

const PI: f32 = 3.14159265358979;
const SMALLEST_Q: f32 = 1e-4;
// BLEND_SHARE of kernel/mod.rs.
const BLEND_SHARE: f32 = 0.35;

fn kernel_w(q: f32) -> f32 {
    let t = max(1.0 - q, 0.0);
    if (KERNEL == 0u) {
        let t2 = t * t;
        return 21.0 / (2.0 * PI) * t2 * t2 * (1.0 + 4.0 * q);
    }
    if (KERNEL == 1u) {
        return 8.0 / PI * select(2.0 * t * t * t, 6.0 * q * q * (q - 1.0) + 1.0, q <= 0.5);
    }
    if (KERNEL == 2u) {
        let s = max(1.0 - q * q, 0.0);
        return 315.0 / (64.0 * PI) * s * s * s;
    }
    if (KERNEL == 4u) {
        let three = (1.0 - BLEND_SHARE) * 21.0 / (2.0 * PI) * t * (1.0 + 4.0 * q);
        return t * t * t * (three + BLEND_SHARE * 105.0 / (16.0 * PI) * (1.0 + 3.0 * q));
    }
    return 15.0 / PI * t * t * t;
}

fn kernel_g(q: f32) -> f32 {
    let t = max(1.0 - q, 0.0);
    if (KERNEL == 0u) {
        return -210.0 / PI * t * t * t;
    }
    if (KERNEL == 1u) {
        return 48.0 / PI * select(-t * t / max(q, 0.5), 3.0 * q - 2.0, q <= 0.5);
    }
    if (KERNEL == 2u) {
        return poly6_g(q);
    }
    if (KERNEL == 4u) {
        return -t * t * ((1.0 - BLEND_SHARE) * 210.0 / PI * t + BLEND_SHARE * 315.0 / (4.0 * PI));
    }
    return -45.0 / PI * t * t / max(q, SMALLEST_Q);
}

fn poly6_laplacian(q: f32) -> f32 {
    return -945.0 / (32.0 * PI) * max(1.0 - q * q, 0.0) * (3.0 - 7.0 * q * q);
}

fn poly6_g(q: f32) -> f32 {
    let s = max(1.0 - q * q, 0.0);
    return -945.0 / (32.0 * PI) * s * s;
}

fn viscosity_laplacian(q: f32) -> f32 {
    return 45.0 / PI * max(1.0 - q, 0.0);
}
