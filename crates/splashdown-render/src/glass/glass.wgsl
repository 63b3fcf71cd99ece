// Panes of glass around the box: faint reflections on their faces, and tinted edges. Needs
// globals.wgsl, environment.wgsl, optics.wgsl.

// 1: the panes behind the liquid. 0: those in front of it.
override BEHIND: u32 = 0u;
// The faces of the panes that are drawn.
override PART: u32 = 0u;
// The parts of the large faces below the height of the eye, where they mirror the floor, and above it, where they mirror
// the sky; and the narrow faces. With one shader for all, each pixel of a pane took the time of two reflections on a
// software driver.
const MIRRORS_FLOOR = 0u;
const MIRRORS_SKY = 1u;
const NARROW = 2u;

// Absorption of clear glass with little iron, 1/m.
const ABSORPTION = vec3f(2.0, 0.8, 1.2);

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) @interpolate(flat) normal: vec3f,
}

fn is_glass(axis: u32, upper: u32) -> bool {
    return globals.glass[axis] != 0u && ((globals.glass[axis] >> upper) & 1u) == 1u;
}

// Angular width of reflected rays over that of a pixel.
const SPREAD = 4.0;

// Smallest drawn thickness of a pane in pixels. Thinner panes are enlarged and made fainter, because narrow faces would
// be drawn as dashes.
const MIN_THICKNESS = 2.0;

fn drawn_thickness() -> f32 {
    let centre = 0.5 * (globals.box_min + globals.box_max);
    return max(globals.glass_thickness, MIN_THICKNESS * globals.pixel_angle * distance(globals.eye, centre));
}

// The slab of a pane: the panes along x are between those along z.
fn slab_corner(axis: u32, upper: u32, corner: vec3u) -> vec3f {
    let t = drawn_thickness();
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

// The part of a face that is drawn: below or above the eye.
fn drawn_height(y: f32) -> f32 {
    let horizon = select(globals.floor_height, max(globals.eye.y, globals.floor_height), has_floor());
    if PART == MIRRORS_FLOOR {
        return min(y, horizon);
    }
    if PART == MIRRORS_SKY {
        return max(y, horizon);
    }
    return y;
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
    out.world.y = drawn_height(out.world.y);
    out.normal = vec3f(0.0);
    out.normal[along] = select(-1.0, 1.0, side == 1u);
    out.position = globals.clip_from_world * vec4f(out.world, 1.0);
    let is_part = (PART == NARROW) == (along != axis);
    let faces_eye = dot(globals.eye - out.world, out.normal) > 0.0;
    if !is_glass(axis, upper) || !is_part || !faces_eye || is_behind(axis, upper == 1u) != (BEHIND == 1u) {
        out.position = vec4f(2.0, 2.0, 2.0, 1.0);
    }
    return out;
}

// Light that leaves the narrow face of a pane, which one looks into: total reflection at the large faces guides the
// light of the opposite narrow face.
fn guided_light(world: vec3f, from_eye: vec3f, normal: vec3f, cosine: f32) -> vec3f {
    let size = vec3f(globals.box_max.x, globals.box_max.y, globals.box_max.z)
        - vec3f(globals.box_min.x, globals.floor_height, globals.box_min.z);
    let across = dot(abs(normal), size);
    let bent = sqrt(1.0 - (1.0 - cosine * cosine) / (GLASS_INDEX * GLASS_INDEX));
    let light = environment(world - across * normal, from_eye, SPREAD * globals.pixel_angle);
    return light * exp(-ABSORPTION * (across / bent));
}

// Whether the eye is on the inner side of a pane: the pane is behind the liquid.
fn is_behind(axis: u32, upper: bool) -> bool {
    return select(globals.eye[axis] > globals.box_min[axis], globals.eye[axis] < globals.box_max[axis], upper);
}

// Whether a point of a pane behind the liquid is in the corner with another such pane, where one looks into the narrow face
// of one of them.
fn is_in_corner(world: vec3f, normal: vec3f) -> bool {
    let axis = select(0u, 2u, abs(normal.x) > 0.5);
    let t = drawn_thickness();
    let low = world[axis] - globals.box_min[axis];
    let high = globals.box_max[axis] - world[axis];
    let is_low = low >= 0.0 && low < t && is_glass(axis, 0u) && is_behind(axis, false);
    let is_high = high >= 0.0 && high < t && is_glass(axis, 1u) && is_behind(axis, true);
    return is_low || is_high;
}

// Opacity of a corner: the edges of the panes are not polished.
const CORNER_OPACITY = 0.6;

// The light that comes out of the corner of two panes. It has passed through glass along the height of the pane.
fn corner_light(world: vec3f, from_eye: vec3f) -> vec3f {
    let height = globals.box_max.y - globals.floor_height;
    return environment(world, from_eye, SPREAD * globals.pixel_angle) * exp(-ABSORPTION * height);
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    let from_eye = normalize(in.world - globals.eye);
    let cosine = max(-dot(from_eye, in.normal), 0.0);
    let back = reflect(from_eye, in.normal);
    if PART == NARROW {
        let reflection = environment(in.world, back, SPREAD * globals.pixel_angle);
        let one = reflectance(cosine, 1.0 / GLASS_INDEX);
        let guided = guided_light(in.world, from_eye, in.normal, cosine);
        let opacity = globals.glass_thickness / drawn_thickness();
        return vec4f(present(mix(guided, reflection, one)) * opacity, opacity);
    }
    var reflection: vec3f;
    if PART == MIRRORS_FLOOR {
        let down = min(back.y, -1e-5);
        let distance = (in.world.y - globals.floor_height) / -down;
        reflection = floor_colour(in.world, vec3f(back.x, down, back.z), distance, SPREAD * globals.pixel_angle);
    } else {
        reflection = sky(back);
    }
    // Both faces of the pane reflect.
    let mirrored = 1.0 - through_pane(cosine);
    let plain = vec4f(present(reflection) * mirrored, mirrored + (1.0 - mirrored) * 0.012);
    if BEHIND == 1u && is_in_corner(in.world, in.normal) {
        let tinted = vec4f(present(mix(corner_light(in.world, from_eye), reflection, mirrored)), 1.0);
        return mix(plain, tinted, CORNER_OPACITY * globals.glass_thickness / drawn_thickness());
    }
    return plain;
}
