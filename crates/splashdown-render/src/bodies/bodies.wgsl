// Bodies: matte, lit by sun and sky. Needs globals.wgsl, environment.wgsl.

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(perspective, centroid) world: vec3f,
    @location(1) @interpolate(perspective, centroid) normal: vec3f,
    @location(2) @interpolate(flat) colour: vec3f,
}

@vertex
fn vertex_main(@location(0) vertex: vec4f, @location(1) normal: vec4f, @location(2) colour: vec4f) -> Varying {
    var out: Varying;
    out.position = globals.clip_from_world * vec4f(vertex.xyz, 1.0);
    out.world = vertex.xyz;
    out.normal = normal.xyz;
    out.colour = colour.rgb;
    return out;
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    let to_eye = normalize(globals.eye - in.world);
    var normal = normalize(in.normal + vec3f(0.0, 1e-6, 0.0));
    // Open meshes are lit on the visible side.
    normal = select(-normal, normal, dot(normal, to_eye) >= 0.0);
    let sun = max(dot(normal, globals.sun), 0.0);
    let above = 0.5 + 0.5 * normal.y;
    // The floor hides part of the sky from points near it.
    let height = max(in.world.y - globals.floor_height, 0.0) / globals.tile_size;
    let open = mix(0.72 + 0.28 * smoothstep(0.0, 1.0, height), 1.0, above);
    let bounced = vec3f(0.20, 0.20, 0.19) * (1.0 - above);
    let light = SUN_LIGHT * sun + (SKY_LIGHT * above + bounced) * open;
    let half_way = normalize(globals.sun + to_eye);
    let shine = 0.10 * pow(max(dot(normal, half_way), 0.0), 40.0) * sun;
    let rim = 0.05 * pow(1.0 - max(dot(normal, to_eye), 0.0), 4.0);
    return vec4f(encode(compress_highlights(in.colour * light + SUN_LIGHT * shine + SKY_LIGHT * rim)), 1.0);
}
