// Light from bodies, which are matte. Needs globals.wgsl, environment.wgsl, and `sun_on(point, normal, in_liquid)`
// from sunlit.wgsl or lit.wgsl.

// A unit normal on the visible side: open meshes are lit there.
fn visible_normal(outward: vec3f, to_eye: vec3f) -> vec3f {
    let normal = normalize(outward + vec3f(0.0, 1e-6, 0.0));
    return select(-normal, normal, dot(normal, to_eye) >= 0.0);
}

// Light of the sky and of the floor on a point of a body.
fn sky_on(point: vec3f, normal: vec3f) -> vec3f {
    let above = 0.5 + 0.5 * normal.y;
    // The floor hides part of the sky from points near it.
    let height = max(point.y - globals.floor_height, 0.0) / globals.tile_size;
    let open = select(1.0, mix(0.45 + 0.55 * smoothstep(0.0, 1.0, height), 1.0, above), has_floor());
    let bounced = globals.bounced * (1.0 - above);
    return (globals.sky_light * above + bounced) * open;
}

// Light from a point of a body outside the liquid, on which this light of sun and sky falls.
fn dry_light(normal: vec3f, colour: vec3f, to_eye: vec3f, sun: vec3f, sky: vec3f) -> vec3f {
    let half_way = normalize(globals.sun + to_eye);
    let shine = 0.12 * pow(max(dot(normal, half_way), 0.0), 60.0);
    let rim = 0.05 * pow(1.0 - max(dot(normal, to_eye), 0.0), 4.0);
    return colour * (sun + sky) + sun * shine + globals.sky_light * rim;
}

// Light from a point of a body outside the liquid.
fn matte(point: vec3f, outward: vec3f, colour: vec3f, to_eye: vec3f) -> vec3f {
    let normal = visible_normal(outward, to_eye);
    return dry_light(normal, colour, to_eye, globals.sun_light * sun_on(point, normal, false), sky_on(point, normal));
}
