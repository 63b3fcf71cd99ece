#import gpu/index
#import sph/params
#import sph/body

override CONTINUITY: u32 = 0u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> state: StepState;
@group(0) @binding(2) var<storage, read> living: array<u32>;
@group(0) @binding(3) var<storage, read> bodies: array<Body>;
@group(0) @binding(4) var<storage, read> contact_list: array<Contact>;
@group(0) @binding(5) var<storage, read> sorted_positions: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> sorted_velocities: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> densities: array<vec2<f32>>;

@compute @workgroup_size(64)
fn boundary_density(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= living[arrayLength(&living) - 2u] || contact_list[2u * i].body == NO_BODY) {
        return;
    }
    var rho = densities[i].x;
    if (CONTINUITY == 1u) {
        let x = sorted_positions[i].xyz;
        let v = sorted_velocities[i];
        var flow = 0.0;
        for (var k = 0u; k < 2u; k++) {
            let b = contact_list[2u * i + k].body;
            if (b != NO_BODY) {
                let wall = bodies[b].velocity + cross(bodies[b].angular_velocity, x - bodies[b].position);
                flow += dot(contact_list[2u * i + k].slope, v.xyz - wall);
            }
        }
        rho -= state.dt * 2.0 * v.w * flow;
    } else {
        let open = (1.0 - contact_list[2u * i].density) * (1.0 - contact_list[2u * i + 1u].density);
        rho += params.rest_density * (1.0 - open);
    }
    densities[i] = vec2(rho, pressure_at(rho));
}
