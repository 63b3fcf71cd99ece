#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/foam
#import sph/foam_ambient

#bindings

@compute @workgroup_size(64)
fn advect(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (foam_state.is_due == 0u || i >= foam_state.count) {
        return;
    }
    var p = foam_pool[i];
    let dt = foam_state.dt;
    let v = p.velocity;
    let acceleration = body_acceleration(foam_state.time - 0.5 * dt);
    let was_spray = (p.tag & 3u) == SPRAY;
    var x = p.position + dt * v;
    if (was_spray) {
        x += 0.5 * dt * dt * acceleration;
    }
    let near = ambient(x);
    let was_foam = (p.tag & 3u) == FOAM;
    let kind = kind_of(near.neighbours, was_foam);
    var u = v;
    if (kind == SPRAY) {
        u = v + dt * acceleration;
        if (!was_spray) {
            x += 0.5 * dt * dt * acceleration;
        }
    } else {
        if (was_spray) {
            x -= 0.5 * dt * dt * acceleration;
        }
        u = near.velocity;
        if (kind == BUBBLE) {
            let follow = 1.0 - exp(-foam.drag * dt);
            let rise = near.velocity - foam.buoyancy / foam.drag * acceleration;
            u = v + follow * (rise - v);
        }
        x += 0.5 * dt * (u - v);
    }
    var is_in = true;
    var touches = false;
    for (var axis = 0u; axis < 3u; axis++) {
        let low = params.domain_min[axis];
        let high = params.domain_max[axis];
        if (x[axis] <= low) {
            is_in = is_in && ((params.closed >> (2u * axis)) & 1u) == 1u;
            touches = true;
            x[axis] = low;
            u[axis] = max(u[axis], 0.0);
        } else if (x[axis] >= high) {
            is_in = is_in && ((params.closed >> (2u * axis + 1u)) & 1u) == 1u;
            touches = true;
            x[axis] = high;
            u[axis] = min(u[axis], 0.0);
        }
    }
    let ages = kind == FOAM || was_foam || (kind == SPRAY && touches);
    p.lifetime = p.lifetime - select(0.0, dt, ages);
    p.position = x;
    p.velocity = u;
    p.tag = (p.tag & 0xfffffffcu) | kind;
    foam_moved[i] = p;
    foam_alive[i] = select(0u, 1u, is_in && p.lifetime > 0.0);
}
