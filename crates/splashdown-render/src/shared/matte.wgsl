// Light from bodies, which are matte. Needs globals.wgsl, environment.wgsl, and
// `sunlight_at(position, normal)` from trace.wgsl or lit.wgsl.

fn matte(world: vec3f, outward: vec3f, colour: vec3f, to_eye: vec3f) -> vec3f {
    var normal = normalize(outward + vec3f(0.0, 1e-6, 0.0));
    // Open meshes are lit on the visible side.
    normal = select(-normal, normal, dot(normal, to_eye) >= 0.0);
    let sun = max(dot(normal, globals.sun), 0.0) * sunlight_at(world, normal);
    let above = 0.5 + 0.5 * normal.y;
    // The floor hides part of the sky from points near it.
    let height = max(world.y - globals.floor_height, 0.0) / globals.tile_size;
    let open = select(1.0, mix(0.45 + 0.55 * smoothstep(0.0, 1.0, height), 1.0, above), has_floor());
    let bounced = globals.bounced * (1.0 - above);
    let light = globals.sun_light * sun + (globals.sky_light * above + bounced) * open;
    let half_way = normalize(globals.sun + to_eye);
    let shine = 0.12 * pow(max(dot(normal, half_way), 0.0), 60.0) * sun;
    let rim = 0.05 * pow(1.0 - max(dot(normal, to_eye), 0.0), 4.0);
    return colour * light + globals.sun_light * shine + globals.sky_light * rim;
}
