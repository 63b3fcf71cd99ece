// Mirrors types.rs.
const PROBE_PRESSURE: u32 = 0u;
const PROBE_HEIGHT: u32 = 1u;
const PROBE_FORCE: u32 = 2u;
const PROBE_FLOW: u32 = 3u;
const PROBE_BODY: u32 = 5u;
const PROBE_VALUES: u32 = 6u;
const PROBE_POSE: u32 = 13u;
const PROBE_ROW: u32 = 20u;
const ACCOUNT_NEXT: u32 = 0u;
const ACCOUNT_ROWS: u32 = 1u;
const ACCOUNT_TIME: u32 = 2u;
const ACCOUNT_SUMS: u32 = 3u;
const ACCOUNT_WORDS: u32 = 9u;

struct ProbePoint {
    position: vec3<f32>,
    kind: u32,
    normal: vec3<f32>,
    interval: f32,
    along: vec3<f32>,
    half_along: f32,
    across: vec3<f32>,
    half_across: f32,
    body: u32,
    first_row: u32,
    most_rows: u32,
    unused: u32,
}
