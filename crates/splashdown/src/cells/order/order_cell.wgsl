#import gpu/index
#import sph/state

@group(0) @binding(0) var<storage, read> state: StepState;
@group(0) @binding(1) var<storage, read> cell_rank: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> cell_start: array<u32>;
@group(0) @binding(3) var<storage, read> slots: array<u32>;
@group(0) @binding(4) var<storage, read> ids: array<u32>;
@group(0) @binding(5) var<storage, read_write> order: array<u32>;

// Nobody asks for the order of the dead behind the last cell. Past this many they stay as they arrived: they may be
// all particles, and comparing each with each would hang the device.
const MOST_DEAD_IN_ORDER: u32 = 1024u;

@compute @workgroup_size(64)
fn order_cell(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= state.run_count) {
        return;
    }
    let cell = cell_rank[i].x;
    let begin = cell_start[cell];
    let end = cell_start[cell + 1u];
    // The dead have the last cell but one entry; a device may pad the buffer by one. The cells before it are ghosts.
    if (cell + 4u > arrayLength(&cell_start) && end - begin > MOST_DEAD_IN_ORDER) {
        order[begin + cell_rank[i].y] = i;
        return;
    }
    let id = ids[i];
    var place = begin;
    for (var k = begin; k < end; k++) {
        place += u32(ids[slots[k]] < id);
    }
    order[place] = i;
}
