// The words of `counters`; see StepCounters in counters.rs.
const COUNTER_ESCAPED: u32 = 0u;
const COUNTER_NON_FINITE: u32 = 1u;
const COUNTER_CORRECTIONS: u32 = 2u;
const COUNTER_LIMITED: u32 = 3u;
const COUNTER_MAX_SPEED: u32 = 4u;
const COUNTER_MAX_ACCELERATION: u32 = 5u;
const COUNTER_MAX_EXCESS: u32 = 6u;
const COUNTER_DRAINED: u32 = 7u;
const COUNTER_MOVED: u32 = 8u;
const COUNTER_UNCONVERGED: u32 = 9u;
const COUNTER_SHORTEN: u32 = 10u;
const COUNTER_MAX_PRESSURE: u32 = 11u;
const COUNTER_VISCOUS_UNCONVERGED: u32 = 12u;

// Marks of removed particles in the fourth component of a position.
const DEAD_ESCAPED: f32 = 1.0;
const DEAD_NON_FINITE: f32 = 2.0;
const DEAD_DRAINED: f32 = 4.0;

// Tests the bits, because shader compilers may assume that comparisons see no NaN.
fn is_finite(v: vec3<f32>) -> bool {
    let exponents = bitcast<vec3<u32>>(v) & vec3(0x7f800000u);
    return all(exponents != vec3(0x7f800000u));
}
