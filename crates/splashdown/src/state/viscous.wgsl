// Mirrors ViscousState in viscous.rs.
struct ViscousState {
    stopped: u32,
    iteration: u32,
    updates: u32,
    alpha: f32,
    beta: f32,
    gamma: f32,
    reference: f32,
    target_residual: f32,
}
