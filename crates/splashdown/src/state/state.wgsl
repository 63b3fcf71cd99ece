// Mirrors StepState in step.rs.
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
    iterations: u32,
    most_iterations: u32,
    residual: f32,
    compression: f32,
    viscous_iterations: u32,
    most_viscous_iterations: u32,
    viscous_residual: f32,
    frame_start: f32,
    body_speed: f32,
}

const COMPLETE: u32 = 1u;
const SUSPENDED: u32 = 2u;
const HELD: u32 = 3u;

// True if the step completes its frame. Both numbers are stored, so that all passes agree.
fn is_last_step(dt: f32, remaining: f32) -> bool {
    return dt >= remaining;
}
