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
}

// The length of a step: what is left of the frame is split evenly, so that no tiny step is left over.
fn step_length(stable: f32, remaining: f32) -> f32 {
    if (remaining >= 2.0 * stable) {
        return stable;
    }
    return select(0.5 * remaining, remaining, remaining <= stable);
}

// True of the step that completes its frame. Both numbers are stored, so all passes decide alike.
fn is_last_step(dt: f32, remaining: f32) -> bool {
    return dt >= remaining;
}
