// Spheres as impostors: the corners of a quad around the outline, and where a ray hits. How it works is told in
// particles/mod.rs. Needs globals.wgsl.

struct SphereCorner {
    position: vec4f,        // in clip space; outside of it where there is nothing to draw
    across: vec2f,          // length 1 on the sphere's outline
    ray: vec3f,             // from the eye to the quad
    centre: vec4f,          // from the eye, and its distance
}

// `particle`: its place, and a w that is not 0 where it is no longer, or not yet, in play. Six vertices make a quad.
fn sphere_corner(particle: vec4f, radius: f32, index: u32) -> SphereCorner {
    // Two triangles, corners 0 1 2 and 2 1 3, packed two bits each.
    let corner = (0xDA4u >> (2u * (index % 6u))) & 3u;
    let side = vec2f(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0;

    let centre = particle.xyz - globals.eye;
    let distance_squared = dot(centre, centre);
    var out: SphereCorner;
    // Also false for NaN and infinity, so that a broken particle is not drawn, and for one that holds the eye.
    if !(distance_squared > 1.02 * radius * radius && distance_squared < 1e30 && particle.w == 0.0) {
        out.position = vec4f(2.0, 2.0, 2.0, 1.0);
        return out;
    }
    let distance = sqrt(distance_squared);
    let axis = centre / distance;
    // The plane through the centre cuts the cone that touches the sphere in a circle of this radius.
    let outline = distance * radius * inverseSqrt(distance_squared - radius * radius);
    let u = normalize(cross(axis, globals.up + 0.001 * globals.right));
    let v = cross(u, axis);
    // One pixel more on every side for the soft edge.
    let reach = 1.0 + distance * globals.pixel_angle / outline;
    out.across = side * reach;
    out.ray = centre + (u * side.x + v * side.y) * (outline * reach);
    out.centre = vec4f(centre, distance);
    out.position = globals.clip_from_world * vec4f(globals.eye + out.ray, 1.0);
    return out;
}

// The share of `ray` at which it enters the sphere: |s ray - centre| = radius, written so that nothing cancels.
fn sphere_entry(across: vec2f, ray: vec3f, distance: f32, radius: f32) -> f32 {
    let rise = radius * sqrt(max(1.0 - dot(across, across), 0.0));
    return distance * (distance - rise) / dot(ray, ray);
}
