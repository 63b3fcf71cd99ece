#import gpu/index
#import sph/state
#import sph/grid

@group(0) @binding(0) var<uniform> grid: Grid;
@group(0) @binding(1) var<storage, read> state: StepState;
@group(0) @binding(2) var<storage, read> cell_counts: array<u32>;
@group(0) @binding(3) var<storage, read_write> pairs: array<vec2<u32>>;

@compute @workgroup_size(64)
fn keys(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= state.run_count) {
        return;
    }
    pairs[i] = vec2(cell_counts[grid.cell_count + 1u + i], i);
}
