#import gpu/index
#import sph/state

@group(0) @binding(0) var<storage, read> state: StepState;
@group(0) @binding(1) var<storage, read> cell_rank: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> cell_start: array<u32>;
@group(0) @binding(3) var<storage, read_write> slots: array<u32>;

@compute @workgroup_size(64)
fn scatter(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= state.run_count) {
        return;
    }
    let c = cell_rank[i];
    slots[cell_start[c.x] + c.y] = i;
}
