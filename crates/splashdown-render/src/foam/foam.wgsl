// Foam and spray as groups of bubbles and drops, and bubbles under water, on white billboards.
// Needs globals.wgsl, environment.wgsl, sphere.wgsl.

@group(2) @binding(0) var<storage, read> diffuse: array<vec4u>;

// Bit k is set if kind k is drawn.
override KINDS: u32 = 7u;

const SPRAY = 0u;
const FOAM = 1u;
const BUBBLE = 2u;
// Particles fade out over the last seconds of their lifetime.
const FADE_TIME = 0.5;
// Smallest radii of a billboard and of a member of a group, in pixels. Above sqrt(1/2) a disc always
// contains the middle of a pixel.
const MIN_BILLBOARD = 1.2;
const MIN_RADIUS = 0.8;
// Least foreshortening of foam, which lies in the surface of the liquid.
const FLATTEST = 0.35;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) across: vec2f,        // length 1 on the outline; turned by a random angle
    @location(1) @interpolate(flat) appearance: vec3f,    // opacity, variation, kind
    // Opacity of a member of a group, and one over the square of its radius in radii of the group.
    @location(2) @interpolate(flat) members: vec2f,
    @location(3) @interpolate(flat) colour: vec3f,
}

// Pseudo-random number in [0, 1) from a particle's tag.
fn random(tag: u32) -> f32 {
    let mixed = (tag >> 2u) * 2654435769u;
    return f32(mixed >> 16u) / 65536.0;
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    var particle = bitcast<vec4f>(diffuse[2u * (index / 3u)]);
    let velocity = bitcast<vec3f>(diffuse[2u * (index / 3u) + 1u].xyz);
    particle += vec4f(velocity * globals.shutter_time, 0.0);
    let tag = diffuse[2u * (index / 3u) + 1u].w;
    let kind = tag & 3u;
    let variation = random(tag);
    // In particle radii.
    var size = 1.0;
    var member = 0.12;
    var opaque = 0.85;
    var nearer = 0.0;
    if kind == FOAM {
        size = 1.2;
        member = 0.24;
        opaque = 0.45;
        // The depth offset prevents the surface from cutting the patches in two.
        nearer = 2.5 * globals.foam_radius;
    } else if kind == BUBBLE {
        size = 0.32;
        member = 1.0;
        opaque = 0.30;
    }
    let from_eye = particle.xyz - globals.eye;
    let away = length(from_eye);
    // Height over width on the screen.
    let flatness = select(1.0, max(abs(from_eye.y) / away, FLATTEST), kind == FOAM);
    // What is below a pixel would flicker; it is enlarged and made fainter.
    let pixel = globals.pixel_angle * away / flatness;
    let own_radius = size * (0.6 + 0.8 * variation) * globals.foam_radius;
    let radius = max(own_radius, MIN_BILLBOARD * pixel);
    let fainter = own_radius * own_radius / (radius * radius);
    // Also zero for NaN, which would remain in a layer of floats.
    let opacity = select(0.0, fainter * clamp(particle.w / FADE_TIME, 0.0, 1.0), particle.w > 0.0);
    var corner = sphere_corner(vec4f(particle.xyz, 0.0), radius, index);
    if kind == FOAM && corner.centre.w > 0.0 {
        let axis = corner.centre.xyz / corner.centre.w;
        let above = normalize(globals.up - dot(globals.up, axis) * axis);
        let offset = corner.ray - corner.centre.xyz;
        let place = globals.eye + corner.ray + above * ((flatness - 1.0) * dot(offset, above));
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
    let drawn = max(member, MIN_RADIUS * pixel / radius);
    out.members = vec2f(opaque * member * member, 1.0) / (drawn * drawn);
    out.appearance = vec3f(opacity, variation, f32(kind));
    let light = 0.86 * (globals.sky_light + 0.72 * globals.sun_light * max(globals.sun.y, 0.0));
    out.colour = present((0.88 + 0.12 * variation) * light);
    return out;
}

// How much of the light from behind passes a drop at `centre`.
fn past_drop(across: vec2f, centre: vec2f, members: vec2f) -> f32 {
    let offset = across - centre;
    return 1.0 - members.x * saturate(1.4 - 1.4 * members.y * dot(offset, offset));
}

// Opacity of a group of drops or bubbles in the unit circle. Equal groups would look like flakes of
// snow: `variation` moves the members in and out.
fn group(across: vec2f, members: vec2f, variation: f32) -> f32 {
    let near = 0.6 + 0.5 * variation;
    let far = 1.1 - 0.5 * variation;
    var past = past_drop(across, near * vec2f(0.50, 0.30), members);
    past *= past_drop(across, far * vec2f(-0.22, 0.60), members);
    past *= past_drop(across, near * vec2f(-0.62, -0.22), members);
    past *= past_drop(across, far * vec2f(0.36, -0.55), members);
    past *= past_drop(across, vec2f(0.02, -0.08), members);
    return 1.0 - past;
}

// The colour times the opacity, and the opacity.
@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    let inside = 1.0 - dot(in.across, in.across);
    if inside <= 0.0 {
        discard;
    }
    let kind = u32(in.appearance.z + 0.5);
    var cover: f32;
    if kind == BUBBLE {
        // A bright rim.
        cover = in.members.x * smoothstep(0.0, 0.15, inside) * (1.0 - 0.6 * smoothstep(0.2, 0.7, inside));
    } else {
        cover = group(in.across, in.members, in.appearance.y);
    }
    let opacity = in.appearance.x * cover;
    return vec4f(in.colour * opacity, opacity);
}
