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
    let open = mix(0.45 + 0.55 * smoothstep(0.0, 1.0, height), 1.0, above);
    let bounced = vec3f(0.42, 0.41, 0.38) * (1.0 - above);
    let light = SUN_LIGHT * sun + (SKY_LIGHT * above + bounced) * open;
    let half_way = normalize(globals.sun + to_eye);
    let shine = 0.12 * pow(max(dot(normal, half_way), 0.0), 60.0) * sun;
    let rim = 0.05 * pow(1.0 - max(dot(normal, to_eye), 0.0), 4.0);
    return colour * light + SUN_LIGHT * shine + SKY_LIGHT * rim;
}
