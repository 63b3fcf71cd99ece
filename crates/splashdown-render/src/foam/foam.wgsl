// Foam and spray as groups of bubbles and drops, and bubbles under water, on white billboards. Needs globals.wgsl, environment.wgsl,
// sphere.wgsl.

// Two rows per particle: position and lifetime, velocity and tag. Declared as integers, because a
// tag loaded as a float may be flushed to zero as a denormal.
@group(2) @binding(0) var<storage, read> diffuse: array<vec4u>;

// Bit k is set if kind k is drawn.
override KINDS: u32 = 7u;

const SPRAY = 0u;
const FOAM = 1u;
const BUBBLE = 2u;
// Particles fade out over the last seconds of their lifetime.
const FADE_TIME = 0.5;
// Least foreshortening of foam, which lies in the surface of the liquid.
const FLATTEST = 0.35;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) across: vec2f,        // length 1 on the outline; turned by a random angle
    @location(1) @interpolate(flat) appearance: vec4f,    // opacity, brightness, kind, pixels per radius
}

// Pseudo-random number in [0, 1) from a particle's tag.
fn random(tag: u32) -> f32 {
    let mixed = (tag >> 2u) * 2654435769u;
    return f32(mixed >> 16u) / 65536.0;
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    var particle = bitcast<vec4f>(diffuse[2u * (index / 6u)]);
    let velocity = bitcast<vec3f>(diffuse[2u * (index / 6u) + 1u].xyz);
    particle += vec4f(velocity * globals.shutter_time, 0.0);
    let tag = diffuse[2u * (index / 6u) + 1u].w;
    let kind = tag & 3u;
    let variation = random(tag);
    // In particle radii.
    var size = 1.2;
    var nearer = 0.0;
    if kind == FOAM {
        size = 1.5;
        // The depth offset prevents the surface from cutting the patches in two.
        nearer = 2.5 * globals.foam_radius;
    } else if kind == BUBBLE {
        size = 0.32;
    }
    let opacity = clamp(particle.w / FADE_TIME, 0.0, 1.0);
    let radius = size * (0.6 + 0.8 * variation) * globals.foam_radius;
    var corner = sphere_corner(vec4f(particle.xyz, 0.0), radius, index);
    if kind == FOAM && corner.position.w > 0.0 {
        let axis = corner.centre.xyz / corner.centre.w;
        let above = normalize(globals.up - dot(globals.up, axis) * axis);
        let offset = corner.ray - corner.centre.xyz;
        let flat_part = max(abs(axis.y), FLATTEST) - 1.0;
        let place = globals.eye + corner.ray + above * (flat_part * dot(offset, above));
        corner.position = globals.clip_from_world * vec4f(place, 1.0);
    }
    var out: Varying;
    out.position = corner.position;
    if out.position.w > 2.0 * nearer {
        out.position.z *= out.position.w / (out.position.w - nearer);
    }
    if ((KINDS >> kind) & 1u) == 0u {
        out.position = vec4f(2.0, 2.0, 2.0, 1.0);
    }
    let angle = 6.2831853 * fract(61.0 * variation);
    let turn = vec2f(cos(angle), sin(angle));
    out.across = vec2f(dot(turn, corner.across), turn.x * corner.across.y - turn.y * corner.across.x);
    let pixel = globals.pixel_angle * distance(particle.xyz, globals.eye) / radius;
    out.appearance = vec4f(opacity, 0.88 + 0.12 * variation, f32(kind), pixel);
    return out;
}

// How much of the light behind a drop at `centre` still arrives. Drops below a pixel would flicker; they are enlarged and
// made fainter.
fn past_drop(across: vec2f, centre: vec2f, radius: f32, opacity: f32, pixel: f32) -> f32 {
    let drawn = max(radius, 0.7 * pixel);
    let faint = opacity * radius * radius / (drawn * drawn);
    let inside = 1.0 - dot(across - centre, across - centre) / (drawn * drawn);
    return 1.0 - faint * smoothstep(0.0, 0.7, inside);
}

// Opacity of a group of drops or bubbles in the unit circle; `scale` is the size of its members.
fn group(across: vec2f, scale: f32, opacity: f32, pixel: f32) -> f32 {
    var past = past_drop(across, vec2f(0.05, -0.08), 1.5 * scale, opacity, pixel);
    past *= past_drop(across, vec2f(0.45, 0.30), 1.0 * scale, opacity, pixel);
    past *= past_drop(across, vec2f(-0.38, 0.47), 1.2 * scale, opacity, pixel);
    past *= past_drop(across, vec2f(-0.60, -0.12), 0.8 * scale, opacity, pixel);
    past *= past_drop(across, vec2f(-0.25, -0.62), 1.1 * scale, opacity, pixel);
    past *= past_drop(across, vec2f(0.38, -0.52), 0.7 * scale, opacity, pixel);
    past *= past_drop(across, vec2f(0.75, -0.10), 0.6 * scale, opacity, pixel);
    past *= past_drop(across, vec2f(0.12, 0.78), 0.7 * scale, opacity, pixel);
    return 1.0 - past;
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    let inside = 1.0 - dot(in.across, in.across);
    if inside <= 0.0 {
        discard;
    }
    let pixel = in.appearance.w;
    let kind = u32(in.appearance.z + 0.5);
    var cover = 0.0;
    if kind == SPRAY {
        cover = group(in.across, 0.08, 0.85, pixel);
    } else if kind == FOAM {
        cover = 0.05 * inside + group(in.across, 0.16, 0.45, pixel);
    } else {
        // A bright rim.
        cover = 0.30 * smoothstep(0.0, 0.15, inside) * (1.0 - 0.6 * smoothstep(0.2, 0.7, inside));
        let radius = max(1.0, 0.7 * pixel);
        cover /= radius * radius;
    }
    let light = 0.86 * (globals.sky_light + 0.72 * globals.sun_light * max(globals.sun.y, 0.0));
    return vec4f(present(in.appearance.y * light), in.appearance.x * cover);
}
