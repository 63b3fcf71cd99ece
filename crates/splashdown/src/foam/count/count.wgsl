#import gpu/index
#import sph/grid
#import sph/foam

@group(0) @binding(0) var<uniform> grid: Grid;
@group(0) @binding(1) var<uniform> foam: FoamParams;
@group(0) @binding(2) var<storage, read> foam_state: FoamState;
@group(0) @binding(3) var<storage, read> cell_start: array<u32>;
@group(0) @binding(4) var<storage, read> sorted_ids: array<u32>;
@group(0) @binding(5) var<storage, read> potentials: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> counts: array<u32>;

@compute @workgroup_size(64)
fn count_born(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (foam_state.is_due == 0u || i >= cell_start[grid.cell_count]) {
        return;
    }
    let p = potentials[i];
    let trapped = foam.trapped_air * ramp(p.x, foam.trapped_air_least, foam.trapped_air_scale);
    let crest = foam.wave_crest * ramp(p.y, foam.wave_crest_least, foam.wave_crest_scale);
    let expected = ramp(p.z, foam.energy_least, foam.energy_scale) * (trapped + crest) * foam_state.dt;
    counts[i] = u32(min(expected, MOST_BORN) + unit(seed_of(sorted_ids[i], foam_state.step)));
}
