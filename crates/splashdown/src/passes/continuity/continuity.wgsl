#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images
#import sph/candidates
#import sph/correction

#bindings

override BODIES: u32 = 0u; // 1: bodies contribute to the matrices

@compute @workgroup_size(64)
fn continuity(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= active_count()) {
        return;
    }
    let x = sorted_positions[i].xyz;
    let v = sorted_velocities[i].xyz;
    let rho = sorted_velocities[i].w;
    let support = params.support_radius;
    let scale = 1.0 / support;
    let factor = params.summed_mass * scale * scale * scale * scale * scale;
    let soft = 0.01 * support * support;
    let hydrostatic = params.rest_density / (params.sound_speed * params.sound_speed) * body_acceleration(state.time);

    var moment: Symmetric; // -M
    var strain: Symmetric;
    var diffusion = 0.0;
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let own_x = reflected_point(by, x);
        let own_v = by.sign * v;
        let mixed = by.sign.xxy * by.sign.yzz;
        moment.others *= mixed;
        strain.others *= mixed;
        let rows = rows_of_image(x, own_x);
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(rows, row);
            for (var first = range.x; first < range.y; first += CANDIDATES) {
                for (var bits = neighbour_bits(own_x, first, range.y); bits != 0u; bits &= bits - 1u) {
                    let j = first + firstTrailingBit(bits);
                    let p = sorted_positions[j].xyz;
                    let d = own_x - p;
                    let r2 = dot(d, d);
                    let other = sorted_velocities[j];
                    let u = own_v - other.xyz;
                    // The density of an image continues hydrostatically.
                    let psi = other.w - rho + dot(hydrostatic, x - p);
                    let g = kernel_g(sqrt(r2) * scale) * factor / other.w;
                    let gd = g * d;
                    moment.diagonal += gd * d;
                    moment.others += gd.xxy * d.yzz;
                    strain.diagonal += u * gd;
                    strain.others += 0.5 * (u.xxy * gd.yzz + u.yzz * gd.xxy);
                    diffusion += g * psi * r2 / (r2 + soft);
                }
            }
        }
        moment.others *= mixed;
        strain.others *= mixed;
    }
    var whole = Symmetric(-moment.diagonal, -moment.others);
    var open = 1.0;
    var away = 1.0;
    var alone = whole;
    var fraction = 0.0;
    var rest = 0.0;
    if (BODIES == 1u) {
        rest = rest_strain();
        fraction = boundary_matrices[2u * i].w;
    }
    if (fraction > 0.0) {
        // Across the surface of a body the solid is a part of the kernel. Along the surface the fluid alone determines the
        // derivatives, and the correction divides by what the body leaves open.
        let across = Symmetric(boundary_matrices[2u * i].xyz, boundary_matrices[2u * i + 1u].xyz);
        let part = fraction / max(dot(across.diagonal, vec3(1.0)), 1e-20);
        alone = Symmetric(whole.diagonal + across.diagonal, whole.others + across.others);
        whole = Symmetric(alone.diagonal + fraction - part * across.diagonal, alone.others - part * across.others);
        open = max(1.0 - 20.0 * fraction, 0.0);
        away = max(1.0 - 100.0 * fraction, 0.0);
    }
    let corrected = correction_of(whole);
    var divergence = contract(corrected.matrix, strain);
    if (fraction > 0.0) {
        divergence = contract(correction_of(alone).matrix, strain);
    }
    divergence += away * volume_recovery(whole, strain, corrected.determinant);
    let rate = rho * divergence - params.density_diffusion * support * params.sound_speed * diffusion;
    let next = without_tension(rho + state.dt * rate, corrected.determinant);
    densities[i] = vec2(next, pressure_at(next));
    let diagonal = open * corrected.matrix.diagonal + (1.0 - open) / params.lattice_moment;
    corrections[2u * i] = vec4(diagonal, away * shifting(strain, rest, corrected.determinant));
    corrections[2u * i + 1u] = vec4(open * corrected.matrix.others, 0.0);
}
