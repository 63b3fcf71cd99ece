#import gpu/index
#import sph/params
#import sph/step_counters
#import sph/kernel
#import sph/planes
#import sph/images
#import sph/body
#import sph/body_map

#bindings

fn no_contact() -> Contact {
    return Contact(vec3(0.0), 0.0, vec3(0.0), 1e30, 0.0, 1e30, NO_BODY, 0u);
}

// The distance of SolidDistance (boundary/half_space.rs) without its offsets, and its derivative.
fn stretched_distance(distance: f32) -> vec2<f32> {
    // `stretched_from` of state/params.rs.
    let beyond = distance - select(0.25 * params.particle_spacing, 0.0, params.is_implicit == 1u);
    if (beyond > 0.0) {
        return vec2(distance + (params.solid_stretch - 1.0) * beyond, params.solid_stretch);
    }
    return vec2(distance, 1.0);
}

// (D, A) of a plane wall; q is negative behind the wall.
fn plane_through(q: f32) -> vec2<f32> {
    let plane = wall_plane_gradient(abs(q));
    return select(plane, vec2(1.0 - plane.x, plane.y), q < 0.0);
}

fn density_through(q: f32) -> f32 {
    let d = wall_plane(abs(q)).x;
    return select(d, 1.0 - d, q < 0.0);
}

// The q at which a plane wall has this kernel fraction.
fn q_of_fraction(kernel_fraction: f32) -> f32 {
    var low = -1.0;
    var high = 1.0;
    for (var k = 0u; k < 16u; k++) {
        let middle = 0.5 * (low + high);
        if (plane_through(middle).x > kernel_fraction) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return 0.5 * (low + high);
}

// The distances inside the nearer closed side of each axis.
fn insides(x: vec3<f32>) -> vec3<f32> {
    var distances = vec3(1e30);
    for (var axis = 0u; axis < 3u; axis++) {
        if (((params.closed >> (2u * axis)) & 1u) == 1u) {
            distances[axis] = x[axis] - params.domain_min[axis];
        }
        if (((params.closed >> (2u * axis + 1u)) & 1u) == 1u) {
            distances[axis] = min(distances[axis], params.domain_max[axis] - x[axis]);
        }
    }
    return distances;
}

fn least_inside(x: vec3<f32>) -> f32 {
    let distances = insides(x);
    return min(distances.x, min(distances.y, distances.z));
}

// The part of a cell of one spacing around a point that lies inside the closed sides.
fn part_inside(x: vec3<f32>) -> f32 {
    let parts = clamp(insides(x) / params.particle_spacing + 0.5, vec3(0.0), vec3(1.0));
    return parts.x * parts.y * parts.z;
}

// The sum over boundary particles around a point of the mesh's frame: minus the gradient of their kernel fraction
// (xyz), and the fraction (w). What lies outside the domain does not count.
fn sampled(b: u32, y: vec3<f32>) -> vec4<f32> {
    let scale = 1.0 / params.support_radius;
    let scale3 = scale * scale * scale;
    let size = vec3<i32>(vec3(bodies[b].samples_x, bodies[b].samples_y, bodies[b].samples_z));
    let home = vec3<i32>(floor((y - bodies[b].field_min) * scale));
    let low = max(home - vec3(1), vec3(0));
    let high = min(home + vec3(1), size - vec3(1));
    var sum = vec4(0.0);
    let orientation = bodies[b].orientation;
    let at = bodies[b].position + turned(orientation, y - bodies[b].center);
    // Boundary particles within the support of this point may lie outside.
    let is_cut = least_inside(at) <= params.support_radius + 0.5 * params.particle_spacing;
    for (var z = low.z; z <= high.z; z++) {
        for (var yy = low.y; yy <= high.y; yy++) {
            for (var x = low.x; x <= high.x; x++) {
                let cell = bodies[b].first_sample_cell + u32((z * size.y + yy) * size.x + x);
                let range = bitcast<vec2<u32>>(maps[cell]);
                for (var k = range.x; k < range.y; k++) {
                    let xy = maps[2u * k];
                    let zv = maps[2u * k + 1u];
                    let d = y - vec3(xy, zv.x);
                    let q = length(d) * scale;
                    if (q < 1.0) {
                        var volume = zv.y * scale3;
                        if (is_cut) {
                            let sample = vec3(xy, zv.x) - bodies[b].center;
                            volume *= part_inside(bodies[b].position + turned(orientation, sample));
                        }
                        sum += volume * vec4(-kernel_g(q) * scale * scale * d, kernel_w(q));
                    }
                }
            }
        }
    }
    return sum;
}

fn contact_with(b: u32, x: vec3<f32>) -> Contact {
    let away = x - bodies[b].position;
    if (dot(away, away) >= bodies[b].radius * bodies[b].radius) {
        return no_contact();
    }
    let orientation = bodies[b].orientation;
    let y = body_point(b, x);
    if (!is_in_map(b, y)) {
        return no_contact();
    }
    let field = field_at(b, y);
    let support = params.support_radius;
    if (min(field.distance, field.effective) >= support) {
        return no_contact();
    }
    var contact = no_contact();
    contact.body = b;
    contact.distance = field.distance;
    contact.normal = turned(orientation, field.distance_gradient / max(length(field.distance_gradient), 1e-6));
    if (bodies[b].way == BODY_PARTICLES) {
        let sum = sampled(b, y);
        contact.kernel_fraction = min(sum.w, 1.0);
        contact.density = contact.kernel_fraction;
        contact.slope = turned(orientation, sum.xyz);
        contact.effective = support * q_of_fraction(contact.kernel_fraction);
    } else {
        var effective = vec4(field.effective_gradient, field.effective);
        if (params.is_implicit == 1u) {
            effective = effective_at(b, y);
        }
        let distance = stretched_distance(effective.w);
        let slope = distance.y * plane_through((distance.x + params.slope_offset) / support).y;
        contact.kernel_fraction = plane_through(effective.w / support).x;
        contact.slope = turned(orientation, slope / support * effective.xyz);
        contact.effective = effective.w;
        contact.density = density_through((distance.x + params.solid_offset) / support);
    }
    return contact;
}

// The contact with the part of a body inside the domain, and with its images behind walls; see cpu.rs.
fn completed(b: u32, x: vec3<f32>) -> Contact {
    let contact = contact_with(b, x);
    if (contact.body == NO_BODY || bodies[b].is_complete != 0u) {
        return contact;
    }
    if (bodies[b].way == BODY_PARTICLES) {
        return completed_particles(contact, b, x);
    }
    return completed_map(contact, b, x);
}

fn completed_particles(own: Contact, b: u32, x: vec3<f32>) -> Contact {
    var contact = own;
    for (var left = reflections_near(x) & ~1u; left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let image = contact_with(b, reflected_point(by, x));
        contact.kernel_fraction += image.kernel_fraction;
        contact.slope += by.sign * image.slope;
    }
    contact.kernel_fraction = min(contact.kernel_fraction, 1.0);
    contact.density = contact.kernel_fraction;
    contact.effective = params.support_radius * q_of_fraction(contact.kernel_fraction);
    return contact;
}

fn is_plane(by: Reflection) -> bool {
    return by.sign.x + by.sign.y + by.sign.z > 0.5;
}

fn completed_map(own: Contact, b: u32, x: vec3<f32>) -> Contact {
    var contact = own;
    let support = params.support_radius;
    let most = max(contact.kernel_fraction, plane_through(contact.distance / support).x);
    let distance = contact.distance - 1e-3 * params.particle_spacing;
    var is_outside = false;
    for (var left = reflections_near(x) & ~1u; left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let behind = reflected_point(by, x);
        let through = length(x - behind);
        let inwards = (x - behind) / max(through, 1e-20);
        let is_behind = is_plane(by) && dot(inwards, contact.normal) > 0.9 && 2.0 * distance > through;
        is_outside = is_outside || is_behind;
        let image = contact_with(b, behind);
        if (image.body == NO_BODY) {
            continue;
        }
        var part = 0.0;
        if (is_plane(by) && contact.distance > 0.0 && image.distance < 0.0) {
            let beyond = -image.distance / max(through - contact.distance, 0.1 * params.particle_spacing);
            part = select(clamp(beyond, 0.0, 1.0), 1.0, 2.0 * contact.distance > through);
            contact.kernel_fraction -= part;
            contact.density -= part;
        } else if (image.kernel_fraction > 0.0) {
            part = clamp((most - contact.kernel_fraction) / image.kernel_fraction, 0.0, 1.0);
        }
        contact.kernel_fraction += part * image.kernel_fraction;
        contact.density += part * image.density;
        contact.slope += part * (by.sign * image.slope);
    }
    if (is_outside || contact.kernel_fraction <= 0.0) {
        contact.kernel_fraction = 0.0;
        contact.density = 0.0;
        contact.slope = vec3(0.0);
    }
    contact.density = max(contact.density, 0.0);
    if (contact.kernel_fraction != own.kernel_fraction) {
        contact.effective = support * q_of_fraction(contact.kernel_fraction);
    }
    return contact;
}

// The second contact, limited so that both bodies fill at most their union; see cpu.rs.
fn limited(first: Contact, second: Contact) -> Contact {
    var contact = second;
    if (second.body == NO_BODY
        || (bodies[first.body].kind == BODY_STATIC && bodies[second.body].kind == BODY_STATIC)) {
        return contact;
    }
    let support = params.support_radius;
    let one = max(plane_through(first.distance / support).x, first.kernel_fraction);
    let two = max(plane_through(second.distance / support).x, second.kernel_fraction);
    let cosine = dot(first.normal, second.normal);
    let across = one * two;
    let both = select((1.0 + cosine) * across, across + cosine * (min(one, two) - across), cosine > 0.0);
    let room = one + two - both - first.kernel_fraction;
    if (contact.kernel_fraction > room) {
        let part = max(room / contact.kernel_fraction, 0.0);
        contact.kernel_fraction *= part;
        contact.density *= part;
        contact.slope *= part;
        contact.effective = support * q_of_fraction(contact.kernel_fraction);
    }
    return contact;
}

@compute @workgroup_size(64)
fn boundary_lookup(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= cell_start[arrayLength(&cell_start) - 2u]) {
        return;
    }
    var x = sorted_positions[i].xyz;
    var first = no_contact();
    var second = no_contact();
    for (var b = 0u; b < arrayLength(&bodies); b++) {
        let contact = completed(b, x);
        let rank = min(contact.distance, contact.effective);
        if (rank < min(first.distance, first.effective)) {
            second = first;
            first = contact;
        } else if (rank < min(second.distance, second.effective)) {
            second = contact;
        }
    }
    second = limited(first, second);
    contacts[2u * i] = first;
    contacts[2u * i + 1u] = second;
    let inside = min(first.distance, second.distance);
    if (inside < 0.0) {
        let deeper = first.distance <= second.distance;
        let normal = select(second.normal, first.normal, deeper);
        x += min(-inside, 0.1 * params.particle_spacing) * normal;
        sorted_positions[i] = vec4(clamp(x, params.domain_min, params.domain_max), sorted_positions[i].w);
        atomicAdd(&counters[COUNTER_CORRECTIONS], 1u);
    }
}
