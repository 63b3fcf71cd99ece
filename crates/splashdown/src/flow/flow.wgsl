// Mirrors Nozzle and SinkShape in types.rs, and the words of EmissionSchedule.
struct Nozzle {
    back: vec3<f32>,
    speed: f32,
    direction: vec3<f32>,
    length: f32,
    across: vec3<f32>,
    start: f32,
    up: vec3<f32>,
    end: f32,
    half_across: f32,
    half_up: f32,
    first_point: u32,
    points: u32,
    most: u32,
    disc: u32,
    interval: f32,
    wobble: f32,
    share_across: f32,
    share_up: f32,
    stretching: f32,
    submerged_at: f32,
}

struct SinkShape {
    low: vec3<f32>,
    kind: u32,
    high: vec3<f32>,
    cell_size: f32,
    nodes: vec3<u32>,
    first_node: u32,
}

const SCHEDULE_PHASE: u32 = 0u;
const SCHEDULE_EMITTED: u32 = 1u;
const SCHEDULE_REFUSED: u32 = 2u;
const SCHEDULE_LAYER: u32 = 3u;
const SCHEDULE_SLOT: u32 = 4u;
const SCHEDULE_ID: u32 = 5u;
const SCHEDULE_DISTANCE: u32 = 6u;
const SCHEDULE_BLOCKED: u32 = 7u;
const SCHEDULE_COUNTED: u32 = 8u;
const SCHEDULE_BESIDE: u32 = 9u;
const SCHEDULE_WORDS: u32 = 10u;
