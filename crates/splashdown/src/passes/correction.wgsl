#import sph/symmetric
// The correction of kernel gradients; see correction.rs. Needs `params`.

struct Correction {
    matrix: Symmetric,
    determinant: f32,
}

fn correction_of(m: Symmetric) -> Correction {
    let d = m.diagonal;
    let o = m.others;
    let diagonal = d.yxx * d.zzy - o.zyx * o.zyx;
    let others = vec3(o.y * o.z - o.x * d.z, o.x * o.z - o.y * d.y, o.x * o.y - o.z * d.x);
    let determinant = d.x * diagonal.x + o.x * others.x + o.y * others.y;
    let scale = 1.0 / max(determinant, 1.0);
    let missing = 1.0 - clamp(determinant, 0.0, 1.0);
    return Correction(Symmetric(scale * diagonal + missing, scale * others), determinant);
}

fn shifting(strain: Symmetric, rest_strain: f32, determinant: f32) -> f32 {
    let complete = clamp((determinant - 0.45) / 0.45, 0.0, 1.0);
    let deformation = max(sqrt(contract(strain, strain)) - rest_strain, 0.0);
    return complete * 4.0 * params.support_radius * params.support_radius * deformation;
}

fn rest_strain() -> f32 {
    let narrow = clamp(3.0 - params.support_radius / params.particle_spacing, 0.0, 1.0);
    return narrow * 0.1 * sqrt(length(params.gravity) / params.support_radius);
}

fn volume_recovery(m: Symmetric, strain: Symmetric, determinant: f32) -> f32 {
    let excess = dot(m.diagonal, vec3(1.0)) / (3.0 * params.lattice_moment) - 1.0;
    let complete = clamp(12.5 * (determinant - 0.82), 0.0, 1.0);
    return 4.0 * sqrt(contract(strain, strain)) * (max(excess, 0.0) + complete * min(excess, 0.0));
}

fn without_tension(density: f32, determinant: f32) -> f32 {
    let deficit = min(density - params.rest_density, 0.0);
    return density - (1.0 - clamp(4.0 * determinant, 0.0, 1.0)) * deficit;
}
