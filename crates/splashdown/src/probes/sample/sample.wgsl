#import gpu/index
#import sph/params
#import sph/grid
#import sph/probe

#bindings

const PI: f32 = 3.14159265;
const WETTED: f32 = 0.1;
const COLUMN: f32 = 1.5;

// Sums of the lanes: weight, weighted pressure, weighted offset from the probe, weighted acceleration.
var<workgroup> weights: array<vec2<f32>, 64>;
var<workgroup> offsets: array<vec3<f32>, 64>;
var<workgroup> drives: array<vec3<f32>, 64>;

@compute @workgroup_size(64)
fn sample(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let k = linear_group(group, groups);
    if (k >= arrayLength(&probes) || state.run_count == 0u) {
        return;
    }
    let probe = probes[k];
    if (probe.kind > PROBE_HEIGHT) {
        return;
    }
    let support = params.support_radius * select(1.0, COLUMN, probe.kind == PROBE_HEIGHT);
    let end = probe.position + select(0.0, probe.half_along, probe.kind == PROBE_HEIGHT) * probe.normal;
    let first = indices_of(min(probe.position, end) - support);
    let last = indices_of(max(probe.position, end) + support);
    let height = last.y - first.y + 1u;
    let rows = height * (last.z - first.z + 1u);
    var weight = vec2(0.0);
    var offset = vec3(0.0);
    var drive = vec3(0.0);
    for (var row = lane; row < rows; row += 64u) {
        let line = ((first.z + row / height) * grid.size_y + first.y + row % height) * grid.size_x;
        let stop = cell_start[line + last.x + 1u];
        for (var j = cell_start[line + first.x]; j < stop; j++) {
            let p = sorted_positions[j];
            var d = p.xyz - probe.position;
            if (probe.kind == PROBE_HEIGHT) {
                let up = dot(d, probe.normal);
                // Fluid below the base of the column does not count.
                if (up < 0.0) {
                    continue;
                }
                d -= up * probe.normal;
            }
            let q = length(d) / support;
            if (q >= 1.0 || p.w != 0.0) {
                continue;
            }
            let s = 1.0 - q;
            let w = s * s * s * s * (1.0 + 4.0 * q);
            weight += w * vec2(1.0, densities[j].y);
            offset += w * d;
            drive += w * accelerations[j].xyz;
        }
    }
    weights[lane] = weight;
    offsets[lane] = offset;
    drives[lane] = drive;
    for (var half = 32u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if (lane < half) {
            weights[lane] += weights[lane + half];
            offsets[lane] += offsets[lane + half];
            drives[lane] += drives[lane + half];
        }
    }
    if (lane > 0u) {
        return;
    }
    let volume = params.particle_spacing * params.particle_spacing * params.particle_spacing;
    let total = weights[0].x;
    var value = 0.0;
    if (probe.kind == PROBE_HEIGHT) {
        value = 7.0 * volume * total / (PI * support * support);
    } else if (total > 0.0) {
        let wet = 21.0 * volume * total / (2.0 * PI * support * support * support);
        let gradient = params.rest_density * (body_acceleration(state.time) - drives[0] / total);
        let pressure = weights[0].y / total - dot(gradient, offsets[0] / total);
        value = pressure * min(wet / WETTED, 1.0);
    }
    probe_values[k * PROBE_VALUES] = value;
}
