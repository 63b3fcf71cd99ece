#import gpu/index
#import sph/params

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> state: StepState;
@group(0) @binding(2) var<storage, read> sorted_velocities: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> densities: array<vec2<f32>>;

@compute @workgroup_size(64)
fn state_equation(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= state.run_count) {
        return;
    }
    let rho = sorted_velocities[i].w;
    densities[i] = vec2(rho, pressure_at(rho));
}
