#import gpu/index
#import sph/params
#import sph/body
#import sph/symmetric

override CONTINUITY: u32 = 0u;

#bindings

@compute @workgroup_size(64)
fn boundary_density(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= cell_start[arrayLength(&cell_start) - 2u] || contacts[2u * i].body == NO_BODY) {
        return;
    }
    var rho = densities[i].x;
    if (CONTINUITY == 1u) {
        let x = sorted_positions[i].xyz;
        let v = sorted_velocities[i];
        let matrix = Symmetric(corrections[2u * i].xyz, corrections[2u * i + 1u].xyz);
        var flow = 0.0;
        for (var k = 0u; k < 2u; k++) {
            let b = contacts[2u * i + k].body;
            if (b != NO_BODY) {
                let wall = bodies[b].velocity + cross(bodies[b].angular_velocity, x - bodies[b].position);
                let n = direction(contacts[2u * i + k], 1.0 / params.support_radius);
                flow += along(matrix, n) * dot(contacts[2u * i + k].slope, v.xyz - wall);
            }
        }
        rho = bounded_density(rho - state.dt * 2.0 * v.w * flow);
    } else {
        rho += params.rest_density * min(contacts[2u * i].density + contacts[2u * i + 1u].density, 1.0);
    }
    densities[i] = vec2(rho, pressure_at(rho));
}
