// The closed sides of the domain; see walls.rs. Needs `params` (Params) and `wall_table` (33 x 33 nodes).
#import sph/planes
#import sph/boundary_law
const WALL_STEPS: u32 = 32u;

struct WallTerms {
    density: f32,
    slope: vec3<f32>,
    plane: vec3<f32>,
    plane_slope: vec3<f32>,
    normal: vec3<f32>,
    distance: vec3<f32>,
}

fn wall_pair(a: f32, b: f32) -> vec4<f32> {
    if (a * a + b * b >= 1.0) {
        return vec4(0.0);
    }
    let x = a * f32(WALL_STEPS);
    let y = b * f32(WALL_STEPS);
    let i = min(u32(x), WALL_STEPS - 1u);
    let j = min(u32(y), WALL_STEPS - 1u);
    let fx = x - f32(i);
    let fy = y - f32(j);
    let k = j * (WALL_STEPS + 1u) + i;
    let low = wall_table[k] * (1.0 - fx) + wall_table[k + 1u] * fx;
    let high = wall_table[k + WALL_STEPS + 1u] * (1.0 - fx) + wall_table[k + WALL_STEPS + 2u] * fx;
    return low * (1.0 - fy) + high * fy;
}

fn wall_open(bit: u32) -> f32 {
    return select(1e30, 0.0, ((params.closed >> bit) & 1u) == 1u);
}

fn wall_density(q: vec3<f32>) -> f32 {
    let d = vec3(wall_plane(q.x).x, wall_plane(q.y).x, wall_plane(q.z).x);
    let pairs = vec3(wall_pair(q.x, q.y).x, wall_pair(q.x, q.z).x, wall_pair(q.y, q.z).x);
    var sum = d.x + d.y + d.z - pairs.x - pairs.y - pairs.z;
    return sum + wall_corner(d, pairs);
}

// The overlap of three solids; see `corner` in walls.rs.
fn wall_corner(d: vec3<f32>, pairs: vec3<f32>) -> f32 {
    if (any(d <= vec3(1e-5)) || any(pairs <= vec3(1e-9))) {
        return 0.0;
    }
    let bounded = min(pairs, min(vec3(d.x, d.x, d.y), vec3(d.y, d.z, d.z)));
    return bounded.x * bounded.y * bounded.z / (d.x * d.y * d.z);
}

// The derivative of the density by minus the distance over H, per axis.
fn wall_slope(q: vec3<f32>, d: vec3<f32>, a: vec3<f32>) -> vec3<f32> {
    // (D, E) of each axis with the two others.
    let p01 = wall_pair(q.x, q.y).yz;
    let p02 = wall_pair(q.x, q.z).yz;
    let p12 = wall_pair(q.y, q.z).yz;
    let p10 = wall_pair(q.y, q.x).yz;
    let p20 = wall_pair(q.z, q.x).yz;
    let p21 = wall_pair(q.z, q.y).yz;
    var slope = a - vec3(p01.y, p12.y, p20.y) - vec3(p02.y, p10.y, p21.y);
    let corner = wall_corner(d, vec3(p01.x, p02.x, p12.x));
    if (corner > 0.0) {
        slope += corner * (vec3(p01.y, p12.y, p20.y) / vec3(p01.x, p12.x, p20.x)
            + vec3(p02.y, p10.y, p21.y) / vec3(p02.x, p10.x, p21.x) - a / d);
    }
    return slope;
}

fn wall_terms(x: vec3<f32>) -> WallTerms {
    let low = x - params.domain_min + vec3(wall_open(0u), wall_open(2u), wall_open(4u));
    let high = params.domain_max - x + vec3(wall_open(1u), wall_open(3u), wall_open(5u));
    var terms: WallTerms;
    terms.normal = select(vec3(-1.0), vec3(1.0), low <= high);
    terms.distance = min(low, high);
    let q = max(terms.distance / params.support_radius, vec3(0.0));
    if (min(q.x, min(q.y, q.z)) >= 1.0) {
        return terms;
    }
    let px = wall_plane_gradient(q.x);
    let py = wall_plane_gradient(q.y);
    let pz = wall_plane_gradient(q.z);
    terms.plane = vec3(px.x, py.x, pz.x);
    terms.plane_slope = vec3(px.y, py.y, pz.y);
    terms.slope = wall_slope(q, terms.plane, terms.plane_slope);
    terms.density = wall_density(max((terms.distance + params.wall_offset) / params.support_radius, vec3(0.0)));
    return terms;
}

// The selected part of the acceleration by neighbours and walls; see `WallTerms::acceleration`.
fn wall_acceleration(
    wall: WallTerms,
    v: vec3<f32>,
    body: vec3<f32>,
    fluid: vec3<f32>,
    pressure_factor: f32,
    dt: f32,
) -> vec3<f32> {
    let scale = 1.0 / params.support_radius;
    let open = vec3(1.0) - wall.plane;
    let others = vec3(open.y * open.z, open.z * open.x, open.x * open.y);
    var a = fluid / others;
    for (var axis = 0u; axis < 3u; axis++) {
        let distance = max(wall.distance[axis], 0.0);
        if (distance >= params.support_radius) {
            continue;
        }
        if ((FORCES & PRESSURE_FORCE) != 0u) {
            var own = pressure_factor * wall.slope[axis] * scale * wall.normal[axis];
            if (pressure_factor > 0.0) {
                own -= (wall.plane[axis] + wall.plane_slope[axis] * scale * distance) * body[axis];
            }
            a[axis] += own / others[axis];
        }
        if ((FORCES & OTHER_FORCES) == 0u) {
            continue;
        }
        if (v[axis] * wall.normal[axis] < 0.0) {
            let q = distance * scale;
            a[axis] -= implicit_rate(approach_damping(q), dt) * v[axis];
        }
        let gradient = wall.plane_slope[axis] * scale;
        let friction = boundary_friction(params.wall_friction, params.viscosity, gradient, distance);
        var along = v;
        along[axis] = 0.0;
        a -= implicit_rate(friction, dt) * along;
    }
    return a;
}
