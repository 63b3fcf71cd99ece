// Panes of glass around the box: faint reflections on their faces, and tinted edges. Needs
// globals.wgsl, environment.wgsl, optics.wgsl.

// 1: the panes behind the liquid. 0: those in front of it.
override BEHIND: u32 = 0u;

const GLASS_INDEX = 1.5;
// Where the edge of a pane shows the light that it guides, which is green from iron in the glass.
const EDGE_COLOUR = vec3f(0.30, 0.56, 0.47);

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) @interpolate(flat) normal: vec3f,
    @location(2) @interpolate(flat) is_edge: u32,
}

fn is_glass(axis: u32, upper: u32) -> bool {
    return globals.glass[axis] != 0u && ((globals.glass[axis] >> upper) & 1u) == 1u;
}

// The slab of a pane: the panes along x are between those along z.
fn slab_corner(axis: u32, upper: u32, corner: vec3u) -> vec3f {
    let t = globals.glass_thickness;
    var low = globals.box_min;
    var high = globals.box_max;
    low.y = globals.floor_height;
    if upper == 1u {
        low[axis] = globals.box_max[axis];
        high[axis] = globals.box_max[axis] + t;
    } else {
        high[axis] = globals.box_min[axis];
        low[axis] = globals.box_min[axis] - t;
    }
    if axis == 2u {
        low.x -= select(0.0, t, is_glass(0u, 0u));
        high.x += select(0.0, t, is_glass(0u, 1u));
    }
    return select(low, high, corner == vec3u(1u));
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32, @builtin(instance_index) pane: u32) -> Varying {
    let axis = 2u * (pane >> 1u);
    let upper = pane & 1u;
    let face = index / 6u;
    let along = face >> 1u;
    let side = face & 1u;
    // Two triangles, corners 0 1 2 and 2 1 3, packed two bits each.
    let corner = (0xDA4u >> (2u * (index % 6u))) & 3u;
    var place: vec3u;
    place[along] = side;
    place[(along + 1u) % 3u] = corner & 1u;
    place[(along + 2u) % 3u] = corner >> 1u;
    var out: Varying;
    out.world = slab_corner(axis, upper, place);
    out.normal = vec3f(0.0);
    out.normal[along] = select(-1.0, 1.0, side == 1u);
    out.is_edge = select(0u, 1u, along != axis);
    out.position = globals.clip_from_world * vec4f(out.world, 1.0);
    // A pane is behind the liquid if the eye is on its inner side.
    let inner = select(globals.eye[axis] > globals.box_min[axis], globals.eye[axis] < globals.box_max[axis], upper == 1u);
    let faces_eye = dot(globals.eye - out.world, out.normal) > 0.0;
    if !is_glass(axis, upper) || !faces_eye || inner != (BEHIND == 1u) {
        out.position = vec4f(2.0, 2.0, 2.0, 1.0);
    }
    return out;
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    let from_eye = normalize(in.world - globals.eye);
    let cosine = max(-dot(from_eye, in.normal), 0.0);
    // Both faces of the pane reflect.
    let one = reflectance(cosine, 1.0 / GLASS_INDEX);
    let mirrored = 2.0 * one / (1.0 + one);
    let reflection = environment(in.world, reflect(from_eye, in.normal), 4.0 * globals.pixel_angle);
    if in.is_edge == 1u {
        let light = mix(EDGE_COLOUR, vec3f(0.75, 0.88, 0.84), 0.35 * max(in.normal.y, 0.0));
        let opacity = 0.55;
        let colour = mix(light * globals.daylight * (0.55 + 0.35 * max(dot(in.normal, globals.sun), 0.0)), reflection, one);
        return vec4f(present(colour) * opacity, opacity);
    }
    return vec4f(present(reflection) * mirrored, mirrored + (1.0 - mirrored) * 0.012);
}
