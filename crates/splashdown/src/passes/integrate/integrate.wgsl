#import gpu/index
#import sph/params
#import sph/grid
#import sph/advance

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> grid: Grid;
@group(0) @binding(2) var<uniform> state: StepState;
@group(0) @binding(3) var<storage, read> sorted_positions: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> sorted_velocities: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> densities: array<vec2<f32>>;
@group(0) @binding(6) var<storage, read> accelerations: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> positions: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> velocities: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> counters: array<atomic<u32>>;
@group(0) @binding(10) var<storage, read_write> cell_counts: array<atomic<u32>>;

override COUNTS: u32 = 1u; // 0 leaves the count for the next step to another pass

@compute @workgroup_size(256)
fn integrate(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    begin_advance(local);
    let i = linear_index(gid, groups, 256u);
    if (i < state.run_count) {
        let cell = advance(i, sorted_positions[i], sorted_velocities[i], densities[i].x, accelerations[i].xyz);
        if (COUNTS == 1u && !is_last_step(state.dt, state.remaining)) {
            count_particle(i, cell);
        }
    }
    end_advance(i, local);
}
