// The friction of closed sides; see wall_friction.rs. Needs `params`.
#import sph/planes
#import sph/boundary_law

// The acceleration of a particle with velocity v.
fn wall_friction(x: vec3<f32>, v: vec3<f32>, dt: f32) -> vec3<f32> {
    var a = vec3(0.0);
    if (params.wall_friction == 0.0) {
        return a;
    }
    for (var axis = 0u; axis < 3u; axis++) {
        var distance = 1e30;
        if (((params.closed >> (2u * axis)) & 1u) == 1u) {
            distance = x[axis] - params.domain_min[axis];
        }
        if (((params.closed >> (2u * axis + 1u)) & 1u) == 1u) {
            distance = min(distance, params.domain_max[axis] - x[axis]);
        }
        distance = max(distance, 0.0);
        let q = distance / params.support_radius;
        if (q >= 1.0) {
            continue;
        }
        let gradient = wall_plane_gradient(q).y / params.support_radius;
        let rate = boundary_friction(params.wall_friction, params.viscosity, gradient, distance);
        var along = v;
        along[axis] = 0.0;
        a -= implicit_rate(rate, dt) * along;
    }
    return a;
}
