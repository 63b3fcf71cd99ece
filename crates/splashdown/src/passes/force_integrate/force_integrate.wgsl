#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/walls
#import sph/forces
#import sph/advance

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> grid: Grid;
@group(0) @binding(2) var<uniform> state: StepState;
@group(0) @binding(3) var<uniform> wall_table: array<vec4<f32>, 1089>;
@group(0) @binding(4) var<storage, read> cell_start: array<u32>;
@group(0) @binding(5) var<storage, read> sorted_positions: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> sorted_velocities: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> densities: array<vec2<f32>>;
@group(0) @binding(8) var<storage, read_write> positions: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> velocities: array<vec4<f32>>;
@group(0) @binding(10) var<storage, read_write> counters: array<atomic<u32>>;
@group(0) @binding(11) var<storage, read_write> cell_counts: array<atomic<u32>>;

// Surface tension needs one buffer more than there may be; scenes with it go the other way.
const HAS_TENSION: bool = false;

fn tension_between(i: u32, j: u32, d: vec3<f32>, q: f32, rho_i: f32, rho_j: f32) -> vec3<f32> {
    return vec3(0.0);
}

@compute @workgroup_size(64)
fn force_integrate(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    begin_advance(local);
    let i = linear_index(gid, groups, 64u);
    if (i < state.run_count) {
        let p = sorted_positions[i];
        let v = sorted_velocities[i];
        let own = densities[i];
        var a = vec3(0.0);
        if (i < living()) {
            a = acceleration_of(i, p.xyz, v.xyz, own);
        }
        let cell = advance(i, p, v, own.x, a);
        if (!is_last_step(state.dt, state.remaining)) {
            count_particle(i, cell);
        }
    }
    end_advance(i, local);
}
