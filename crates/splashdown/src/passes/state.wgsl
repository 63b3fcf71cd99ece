// Mirrors StepState in passes/mod.rs.
struct StepState {
    dt: f32,
    stable_dt: f32,
    time: f32,
    remaining: f32,
    done: u32,
    run_count: u32,
    steps: u32,
    too_small: u32,
    max_speed: f32,
    max_acceleration: f32,
    density_error: f32,
    frame_duration: f32,
}
