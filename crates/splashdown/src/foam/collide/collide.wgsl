#import gpu/index
#import sph/foam
#import sph/body
#import sph/body_map

#bindings

@compute @workgroup_size(64)
fn collide(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (foam_state.is_due == 0u || i >= foam_state.count) {
        return;
    }
    var p = foam_pool[i];
    for (var b = 0u; b < arrayLength(&bodies); b++) {
        let away = p.position - bodies[b].position;
        if (dot(away, away) >= bodies[b].radius * bodies[b].radius) {
            continue;
        }
        let y = body_point(b, p.position);
        if (!is_in_map(b, y)) {
            continue;
        }
        let field = field_at(b, y);
        if (field.distance >= 0.0) {
            continue;
        }
        let steepness = max(length(field.distance_gradient), 1e-6);
        let normal = turned(bodies[b].orientation, field.distance_gradient / steepness);
        p.position -= field.distance * normal;
        let arm = p.position - bodies[b].position;
        let relative = p.velocity - bodies[b].velocity - cross(bodies[b].angular_velocity, arm);
        p.velocity -= min(dot(relative, normal), 0.0) * normal;
        if ((p.tag & 3u) == SPRAY) {
            p.lifetime = max(p.lifetime - foam_state.dt, 0.0);
        }
    }
    foam_pool[i] = p;
}
