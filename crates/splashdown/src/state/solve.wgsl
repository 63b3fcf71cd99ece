// Mirrors SolveState in solve.rs.
struct SolveState {
    stopped: u32,
    iteration: u32,
    beta: f32,
    relaxation: f32,
    change: f32,
    best: f32,
    warm_start: f32,
    scale: f32,
    renewal: f32,
    dt_ratio: f32,
    advanced_part: f32,
    mean_excess: f32,
}

// Marks a particle whose motion a nozzle determines, instead of a pressure.
const NO_PRESSURE: f32 = -1e30;
