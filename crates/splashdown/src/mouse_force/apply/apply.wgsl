#import gpu/index
#import sph/state
#import sph/grid
#import sph/mouse_force

#bindings

fn across(u: vec3<f32>) -> vec3<f32> {
    return u - mouse_force.direction * dot(mouse_force.direction, u);
}

@compute @workgroup_size(64)
fn apply(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (mouse_force.rate == 0.0 || i >= min(cell_start[grid.cell_count], state.run_count)) {
        return;
    }
    let d = across(sorted_positions[i].xyz - mouse_force.origin);
    let inside = 1.0 - dot(d, d) / (mouse_force.radius * mouse_force.radius);
    if (inside > 0.0) {
        let pull = mouse_force.rate * inside * inside * across(mouse_force.velocity - sorted_velocities[i].xyz);
        accelerations[i] += vec4(pull, 0.0);
    }
}
