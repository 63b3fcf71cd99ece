// Sphere impostors: the corners of a triangle around the outline, and the intersection of a ray with
// the sphere. Derivation: particles/mod.rs. Needs globals.wgsl.

struct SphereCorner {
    position: vec4f,        // in clip space; outside the clip volume if the particle is not drawn
    across: vec2f,          // length 1 on the sphere's outline
    ray: vec3f,             // from the eye to the corner of the triangle
    centre: vec4f,          // xyz: centre relative to the eye, w: distance from the eye
}

// `particle`: xyz is the position; w is 0 for active particles, and only these are drawn. Three
// vertices make a triangle around the disc: it has 1.3 times the area of a square, but a square has twice the triangles,
// and the pixels along its diagonal are drawn twice where they are drawn in blocks.
fn sphere_corner(particle: vec4f, radius: f32, index: u32) -> SphereCorner {
    // The corners of the equilateral triangle around the unit circle.
    let corner = index % 3u;
    let side = vec2f(1.7320508 * (f32(corner) - 1.0), select(-1.0, 2.0, corner == 1u));

    let centre = particle.xyz - globals.eye;
    let distance_squared = dot(centre, centre);
    var out: SphereCorner;
    // Also false for NaN and infinity, and for a sphere that contains the eye: these are not drawn.
    if !(distance_squared > 1.02 * radius * radius && distance_squared < 1e30 && particle.w == 0.0) {
        out.position = vec4f(2.0, 2.0, 2.0, 1.0);
        return out;
    }
    let distance = sqrt(distance_squared);
    let axis = centre / distance;
    // The cone tangent to the sphere intersects the plane through its centre in a circle of this
    // radius.
    let outline = distance * radius * inverseSqrt(distance_squared - radius * radius);
    let u = normalize(cross(axis, globals.up + 0.001 * globals.right));
    let v = cross(u, axis);
    // One extra pixel on every side, so that the triangle covers partially covered pixels.
    let reach = 1.0 + distance * globals.pixel_angle / outline;
    out.across = side * reach;
    out.ray = centre + (u * side.x + v * side.y) * (outline * reach);
    out.centre = vec4f(centre, distance);
    out.position = globals.clip_from_world * vec4f(globals.eye + out.ray, 1.0);
    return out;
}

// Parameter s where `ray` enters the sphere, |s ray - centre| = radius, in a form without
// cancellation.
fn sphere_entry(across: vec2f, ray: vec3f, distance: f32, radius: f32) -> f32 {
    let rise = radius * sqrt(max(1.0 - dot(across, across), 0.0));
    return distance * (distance - rise) / dot(ray, ray);
}
