#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/foam
#import sph/foam_ambient

#bindings

const SPREAD: f32 = 0.1;

@compute @workgroup_size(64)
fn emit(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (foam_state.is_due == 0u || foam_state.born == 0u || i >= active_count()) {
        return;
    }
    let first = foam_starts[i];
    let last = foam_starts[i + 1u];
    if (first == last) {
        return;
    }
    let v = sorted_velocities[i].xyz;
    let speed = length(v);
    let along = v / max(speed, 1e-20);
    // Any perpendicular direction; the y axis is suitable unless the motion is parallel to it.
    let e1 = normalize(cross(along, select(vec3(0.0, 1.0, 0.0), vec3(1.0, 0.0, 0.0), abs(along.y) > 0.9)));
    let e2 = cross(along, e1);
    let seed = seed_of(sorted_ids[i], foam_state.step);
    for (var m = first; m < last; m++) {
        let place = place_of(m, foam_state.share);
        if (place_of(m + 1u, foam_state.share) == place) {
            continue;
        }
        let s = seed + 4u * (m - first);
        let r = sqrt(unit(s + 1u));
        let angle = 6.2831853 * unit(s + 2u);
        let across = r * (cos(angle) * e1 + sin(angle) * e2);
        var x = sorted_positions[i].xyz + params.particle_spacing * across + (unit(s + 3u) - 0.5) * foam_state.dt * v;
        x = clamp(x, params.domain_min, params.domain_max);
        let lifetime = foam.lifetime_least + foam.lifetime_range * unit(s + 4u);
        let kind = kind_of(ambient(x).neighbours, false);
        let number = foam_state.next_id - foam_state.born + place;
        foam_pool[foam_state.kept + place] = Diffuse(x, lifetime, v + SPREAD * speed * across, (number << 2u) | kind);
    }
}
