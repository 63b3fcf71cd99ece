// Reactions of bodies, summed in 64-bit fixed point; see reaction.rs. Needs `params`, `bodies` and `sums` (atomic).

fn add(word: u32, value: f32) {
    // A million of the largest terms still fit into the sum.
    let units = round(clamp(value, -1e12, 1e12));
    let high = floor(units / 4294967296.0);
    let low = u32(units - high * 4294967296.0);
    let before = atomicAdd(&sums[word], low);
    let carry = select(0u, 1u, before > 0xffffffffu - low);
    atomicAdd(&sums[word + 1u], bitcast<u32>(i32(high)) + carry);
}

fn react(b: u32, point: vec3<f32>, force: vec3<f32>) {
    let quantum = 1e-5 * params.particle_mass;
    let torque = cross(point - bodies[b].position, force);
    for (var axis = 0u; axis < 3u; axis++) {
        add(SUM_WORDS * b + 2u * axis, force[axis] / quantum);
        add(SUM_WORDS * b + 6u + 2u * axis, torque[axis] / (quantum * params.support_radius));
    }
}
