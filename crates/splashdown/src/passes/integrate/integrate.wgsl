#import gpu/index
#import sph/params
#import sph/tally

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> state: StepState;
@group(0) @binding(2) var<storage, read> sorted_positions: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> sorted_velocities: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> densities: array<vec2<f32>>;
@group(0) @binding(5) var<storage, read> accelerations: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> positions: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> velocities: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> tally: array<atomic<u32>>;

// Maxima of the workgroup by their bits: speed, acceleration, excess of density.
var<workgroup> highest: array<atomic<u32>, 3>;

fn is_closed(bit: u32) -> bool {
    return ((params.closed >> bit) & 1u) == 1u;
}

fn raise(k: u32, value: f32) {
    atomicMax(&highest[k], bitcast<u32>(value));
}

fn advance(i: u32) {
    let p = sorted_positions[i];
    var v = sorted_velocities[i];
    if (p.w != 0.0) {
        positions[i] = p;
        velocities[i] = v;
        return;
    }
    let dt = state.dt;
    let a = accelerations[i];
    let rho = densities[i].x;
    v = vec4(v.xyz + dt * a.xyz, rho);
    let step = length(v.xyz) * dt;
    let most = 0.5 * params.particle_spacing;
    if (step > most) {
        v = vec4(v.xyz * (most / step), v.w);
        atomicAdd(&tally[TALLY_LIMITED], 1u);
    }
    let near = 0.25 * params.particle_spacing;
    for (var axis = 0u; axis < 3u; axis++) {
        if (is_closed(2u * axis)) {
            v[axis] = max(v[axis], -max(p[axis] - params.domain_min[axis] - near, 0.0) / dt);
        }
        if (is_closed(2u * axis + 1u)) {
            v[axis] = min(v[axis], max(params.domain_max[axis] - p[axis] - near, 0.0) / dt);
        }
    }
    var x = p.xyz + dt * v.xyz;
    // `max` and `min` may take the other operand of a NaN, so the acceleration is asked too.
    if (!is_finite(x) || !is_finite(a.xyz) || !is_finite(vec3(v.w))) {
        positions[i] = vec4(p.xyz, DEAD_NON_FINITE);
        velocities[i] = vec4(0.0, 0.0, 0.0, params.rest_density);
        atomicAdd(&tally[TALLY_NON_FINITE], 1u);
        return;
    }
    for (var axis = 0u; axis < 3u; axis++) {
        if ((is_closed(2u * axis) && x[axis] < params.domain_min[axis])
            || (is_closed(2u * axis + 1u) && x[axis] > params.domain_max[axis])) {
            x[axis] = clamp(x[axis], params.domain_min[axis], params.domain_max[axis]);
            v[axis] = 0.0;
            atomicAdd(&tally[TALLY_CORRECTIONS], 1u);
        }
    }
    positions[i] = vec4(x, 0.0);
    velocities[i] = v;
    raise(0u, length(v.xyz));
    raise(1u, length(a.xyz));
    raise(2u, max(rho / params.rest_density - 1.0, 0.0));
}

@compute @workgroup_size(256)
fn integrate(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    if (local < 3u) {
        atomicStore(&highest[local], 0u);
    }
    workgroupBarrier();
    let i = linear_index(gid, groups, 256u);
    if (i < state.run_count) {
        advance(i);
    }
    workgroupBarrier();
    if (local < 3u) {
        atomicMax(&tally[TALLY_MAX_SPEED + local], atomicLoad(&highest[local]));
    }
}
