// Mirrors types.rs.
const SPRAY: u32 = 0u;
const FOAM: u32 = 1u;
const BUBBLE: u32 = 2u;
const MOST_BORN: f32 = 64.0;

struct FoamParams {
    capacity: u32,
    interval: f32,
    trapped_air: f32,
    wave_crest: f32,
    trapped_air_least: f32,
    trapped_air_scale: f32,
    wave_crest_least: f32,
    wave_crest_scale: f32,
    energy_least: f32,
    energy_scale: f32,
    lifetime_least: f32,
    lifetime_range: f32,
    buoyancy: f32,
    drag: f32,
    spray_below: f32,
    bubble_above: f32,
    bubble_again_above: f32,
}

struct FoamState {
    time: f32,
    dt: f32,
    // 1 if there is something to do, 0 if not: then no pass touches the pool.
    is_due: u32,
    has_begun: u32,
    step: u32,
    count: u32,
    kept: u32,
    born: u32,
    share: u32,
    next_id: u32,
    refused: u32,
    wanted: u32,
}

struct Diffuse {
    position: vec3<f32>,
    lifetime: f32,
    velocity: vec3<f32>,
    // The number, times four, and the kind.
    tag: u32,
}

// The PCG hash of Jarzynski and Olano, "Hash functions for GPU rendering", JCGT 9 (2020).
fn hash(i: u32) -> u32 {
    let state = i * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// In [0, 1), the same bits everywhere: 24 bits fit a float.
fn unit(i: u32) -> f32 {
    return f32(hash(i) >> 8u) * (1.0 / 16777216.0);
}

// The random numbers of a particle of the fluid in a step of the foam begin here.
fn seed_of(id: u32, step: u32) -> u32 {
    return hash(id ^ hash(step));
}

// Where the m-th of those that want to be born goes if a `share` of them finds room: k f / 4096, rounded down,
// without overflow, where f are the share's lower 16 bits, s the upper ones, and k is m / 2^s. Two that follow
// one another are at most one apart; of several at one place the last is born.
fn place_of(m: u32, share: u32) -> u32 {
    let k = m >> (share >> 16u);
    let part = share & 0xffffu;
    return (k >> 12u) * part + (((k & 4095u) * part) >> 12u);
}

fn ramp(value: f32, least: f32, scale: f32) -> f32 {
    return clamp((value - least) * scale, 0.0, 1.0);
}
