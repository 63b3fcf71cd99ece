#import gpu/index
#import sph/state

@group(0) @binding(0) var<storage, read> state: StepState;
@group(0) @binding(1) var<storage, read> order: array<u32>;
@group(0) @binding(2) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> velocities: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> ids: array<u32>;
@group(0) @binding(5) var<storage, read_write> sorted_positions: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> sorted_velocities: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> sorted_ids: array<u32>;

@compute @workgroup_size(64)
fn reorder(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let k = linear_index(gid, groups, 64u);
    if (k >= state.run_count) {
        return;
    }
    let i = order[k];
    sorted_positions[k] = positions[i];
    sorted_velocities[k] = velocities[i];
    sorted_ids[k] = ids[i];
}
