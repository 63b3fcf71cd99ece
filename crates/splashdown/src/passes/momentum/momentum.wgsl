#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/walls

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> grid: Grid;
@group(0) @binding(2) var<storage, read> state: StepState;
@group(0) @binding(3) var<storage, read> cell_start: array<u32>;
@group(0) @binding(4) var<storage, read> sorted_positions: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> sorted_velocities: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> densities: array<vec2<f32>>;
@group(0) @binding(7) var<storage, read> normals: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> wall_table: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> accelerations: array<vec4<f32>>;

// Akinci's cohesion kernel times H^3; both branches meet at q = 1/2.
fn cohesion(q: f32) -> f32 {
    let t = (1.0 - q) * q;
    let t3 = t * t * t;
    return 32.0 / PI * select(t3, 2.0 * t3 - 1.0 / 64.0, q <= 0.5);
}

@compute @workgroup_size(64)
fn momentum(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= living()) {
        return;
    }
    let x = sorted_positions[i].xyz;
    let v = sorted_velocities[i].xyz;
    let rho = densities[i].x;
    let pressure = densities[i].y;
    let specific = pressure / (rho * rho);
    let body = body_acceleration(state.time);
    let cell = cell_of(x);

    let support = params.support_radius;
    let scale = 1.0 / support;
    let scale5 = scale * scale * scale * scale * scale;
    let reach = support * support;
    let soft = 0.01 * reach;
    let mass = params.particle_mass;
    let volume = mass / params.rest_density;
    let laminar = 10.0 * params.viscosity * volume;
    let artificial = params.artificial_viscosity * params.sound_speed * 0.5 * support * volume;
    let tension = params.surface_tension > 0.0;
    var own_normal = vec3(0.0);
    if (tension) {
        own_normal = normals[i].xyz;
    }

    var a = vec3(0.0);
    for (var row = 0u; row < 9u; row++) {
        let range = row_range(cell, row);
        for (var j = range.x; j < range.y; j++) {
            let d = x - sorted_positions[j].xyz;
            let r2 = dot(d, d);
            if (r2 >= reach || j == i) {
                continue;
            }
            let q = sqrt(r2) * scale;
            let g = kernel_g(q) * scale5;
            let other = densities[j];
            let vx = dot(v - sorted_velocities[j].xyz, d);
            let rub = vx / (r2 + soft) * (laminar + select(0.0, artificial, vx < 0.0));
            a += (g * (rub - mass * (specific + other.y / (other.x * other.x)))) * d;
            if (tension) {
                let k = -params.surface_tension * 2.0 * params.rest_density / (rho + other.x);
                let pull = mass * scale * scale * scale * scale * cohesion(q) / max(q, SMALLEST_Q);
                a += k * (pull * d + own_normal - normals[j].xyz);
            }
        }
    }

    let push = params.rest_density * specific + pressure / params.rest_density;
    a = wall_acceleration(wall_terms(x), v, body, a, push, state.dt);
    accelerations[i] = vec4(a + body, 0.0);
}
