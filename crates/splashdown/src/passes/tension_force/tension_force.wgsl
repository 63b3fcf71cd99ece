#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images
#import sph/symmetric

#bindings

override CORRECTED: u32 = 0u;

// As `CLOSE` and `REPULSION` in mod.rs.
const CLOSE = 0.25;
const REPULSION = 4.0;

// The weight of a normal: 0 where it is too short to have a direction, 1 at the surface.
fn normal_weight(normal: vec3<f32>) -> f32 {
    return clamp((length(normal) - params.weakest_normal) / (1.5 * params.weakest_normal), 0.0, 1.0);
}

fn direction(normal: vec3<f32>) -> vec3<f32> {
    return normal / max(length(normal), 1e-12);
}

fn correction_of(j: u32) -> Symmetric {
    if (CORRECTED == 1u) {
        return Symmetric(corrections[2u * j].xyz, corrections[2u * j + 1u].xyz);
    }
    return Symmetric(vec3(1.0), vec3(0.0));
}

// For the lower side of each axis a value that falls from 1 at the side to 0 at the support radius; 0 where it is open.
fn nearness_low(x: vec3<f32>) -> vec3<f32> {
    let near = vec3(1.0) - (x - params.domain_min) / params.support_radius;
    return clamp(near, vec3(0.0), vec3(1.0)) * vec3<f32>((vec3(params.closed) >> vec3(0u, 2u, 4u)) & vec3(1u));
}

// The same for the upper sides.
fn nearness_high(x: vec3<f32>) -> vec3<f32> {
    let near = vec3(1.0) - (params.domain_max - x) / params.support_radius;
    return clamp(near, vec3(0.0), vec3(1.0)) * vec3<f32>((vec3(params.closed) >> vec3(1u, 3u, 5u)) & vec3(1u));
}

@compute @workgroup_size(64)
fn tension_force(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= active_count()) {
        return;
    }
    let own_weight = normal_weight(normals[i].xyz);
    if (own_weight == 0.0) {
        return;
    }
    let u = direction(smooth_normals[i].xyz);
    let own = correction_of(i);
    let x = sorted_positions[i].xyz;
    let scale = 1.0 / params.support_radius;
    let reach = params.support_radius * params.support_radius;
    var turn = 0.0;
    var extent = 0.0;
    var gradient = vec3(0.0);
    // The part of the gradient by close neighbours.
    var close = vec3(0.0);
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let own_x = reflected_point(by, x);
        let own_u = by.sign * u;
        let own_correction = Symmetric(own.diagonal, by.sign.xxy * by.sign.yzz * own.others);
        gradient *= by.sign;
        close *= by.sign;
        let rows = rows_of_image(x, own_x);
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(rows, row);
            for (var j = range.x; j < range.y; j++) {
                let d = own_x - sorted_positions[j].xyz;
                let r2 = dot(d, d);
                if (r2 >= reach) {
                    continue;
                }
                let q = sqrt(r2) * scale;
                let g = kernel_g(q);
                let other = correction_of(j);
                let both = Symmetric(
                    own_correction.diagonal + other.diagonal,
                    own_correction.others + other.others,
                );
                let own_gradient = g * applied(both, d);
                gradient += own_gradient;
                close += max(1.0 - q / CLOSE, 0.0) * own_gradient;
                let n = smooth_normals[j].xyz;
                let weighted = g * normal_weight(n);
                let along = dot(d, own_u);
                turn += weighted * dot(direction(n) - own_u, d);
                extent += weighted * (r2 - along * along);
            }
        }
        gradient *= by.sign;
        close *= by.sign;
    }
    let limit = params.largest_curvature;
    let inner = clamp(2.0 * turn / min(extent, -1e-3 * reach), -limit, limit);
    let curvature = inner / max(1.0 + 0.5 * params.interface_depth * inner, 0.25);
    // The force of each side acts along it.
    let near = params.wetting * (nearness_low(x) + nearness_high(x));
    let along = near - vec3(near.x + near.y + near.z);
    let repulsion = select(0.0, REPULSION * abs(curvature), params.is_implicit == 1u) * close;
    let force = (vec3(curvature) + along) * gradient - repulsion;
    accelerations[i] += vec4(params.tension_factor * own_weight * force, 0.0);
}
