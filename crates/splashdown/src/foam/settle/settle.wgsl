#import gpu/index
#import sph/foam

@group(0) @binding(0) var<storage, read> foam_state: FoamState;
@group(0) @binding(1) var<storage, read> indices: array<u32>;
@group(0) @binding(2) var<storage, read> moved: array<Diffuse>;
@group(0) @binding(3) var<storage, read_write> pool: array<Diffuse>;

@compute @workgroup_size(64)
fn settle(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (foam_state.is_due == 1u && i < foam_state.kept) {
        pool[i] = moved[indices[i]];
    }
}
