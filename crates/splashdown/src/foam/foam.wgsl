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
    // 1 if an update is due. If 0, no pass accesses the pool.
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
    // Four times the id, plus the kind.
    tag: u32,
}

// The PCG hash of Jarzynski and Olano, "Hash functions for GPU rendering", JCGT 9 (2020).
fn hash(i: u32) -> u32 {
    let state = i * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// A pseudo-random number in [0, 1), bit-identical on all devices: 24 bits are exact in a float.
fn unit(i: u32) -> f32 {
    return f32(hash(i) >> 8u) * (1.0 / 16777216.0);
}

// The seed of the random numbers of a fluid particle in an update.
fn seed_of(id: u32, step: u32) -> u32 {
    return hash(id ^ hash(step));
}

// The slot of candidate m if a fraction `share` of the candidates is accepted: floor(k f / 4096),
// without overflow, where f are the lower 16 bits of the share, s the upper ones, and k = m / 2^s.
// The slots of consecutive candidates differ by at most one; of several candidates with one slot,
// the last is accepted.
fn place_of(m: u32, share: u32) -> u32 {
    let k = m >> (share >> 16u);
    let part = share & 0xffffu;
    return (k >> 12u) * part + (((k & 4095u) * part) >> 12u);
}

fn ramp(value: f32, least: f32, scale: f32) -> f32 {
    return clamp((value - least) * scale, 0.0, 1.0);
}
