// Foam, spray and bubbles as soft white billboards. Needs globals.wgsl, environment.wgsl,
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
// Smallest radius of a disc in pixels. Smaller discs would flicker; they are enlarged and made
// fainter.
const MIN_RADIUS = 0.7;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) across: vec2f,        // length 1 on the outline
    @location(1) @interpolate(flat) appearance: vec3f,    // opacity, brightness, kind
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
    var opacity = 0.85;
    var size = 0.26;
    var nearer = 0.0;
    if kind == FOAM {
        opacity = 0.40;
        size = 0.50;
        // Foam lies in the surface; the depth offset prevents the surface from cutting its discs.
        nearer = 2.5 * globals.foam_radius;
    } else if kind == BUBBLE {
        opacity = 0.30;
        size = 0.32;
    }
    opacity *= clamp(particle.w / FADE_TIME, 0.0, 1.0);
    var radius = size * (0.6 + 0.8 * variation) * globals.foam_radius;
    let least = MIN_RADIUS * globals.pixel_angle * distance(particle.xyz, globals.eye);
    if radius < least {
        opacity *= radius * radius / (least * least);
        radius = least;
    }
    let corner = sphere_corner(vec4f(particle.xyz, 0.0), radius, index);
    var out: Varying;
    out.position = corner.position;
    if out.position.w > 2.0 * nearer {
        out.position.z *= out.position.w / (out.position.w - nearer);
    }
    if ((KINDS >> kind) & 1u) == 0u {
        out.position = vec4f(2.0, 2.0, 2.0, 1.0);
    }
    out.across = corner.across;
    out.appearance = vec3f(opacity, 0.88 + 0.12 * variation, f32(kind));
    return out;
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    let inside = 1.0 - dot(in.across, in.across);
    if inside <= 0.0 {
        discard;
    }
    // Drops have a sharp outline, foam is blurred, bubbles have a bright rim.
    var shape = smoothstep(0.0, 0.6, inside);
    if u32(in.appearance.z + 0.5) == FOAM {
        shape = inside;
    } else if u32(in.appearance.z + 0.5) == BUBBLE {
        shape = smoothstep(0.0, 0.15, inside) * (1.0 - 0.6 * smoothstep(0.2, 0.7, inside));
    }
    let light = 0.86 * (globals.sky_light + 0.72 * globals.sun_light * max(globals.sun.y, 0.0));
    return vec4f(present(in.appearance.y * light), in.appearance.x * shape);
}
