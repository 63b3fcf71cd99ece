// Foam, spray and bubbles as soft white discs that face the eye. Needs globals.wgsl, environment.wgsl, sphere.wgsl.

// Two rows per particle: place and lifetime, velocity and tag. As whole numbers, because a tag read as a float may be
// taken for zero.
@group(2) @binding(0) var<storage, read> diffuse: array<vec4u>;

// Bit k: kind k is drawn.
override KINDS: u32 = 7u;

const SPRAY = 0u;
const FOAM = 1u;
const BUBBLE = 2u;
// In its last moments foam fades, in seconds.
const FADING = 0.5;
// Discs are at least this wide, in pixels, and the fainter for it: smaller ones would flicker.
const LEAST_RADIUS = 0.7;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) across: vec2f,        // length 1 on the outline
    @location(1) @interpolate(flat) look: vec3f,    // opacity, brightness, kind
}

// In [0, 1), by the particle's tag.
fn random(tag: u32) -> f32 {
    let mixed = (tag >> 2u) * 2654435769u;
    return f32(mixed >> 16u) / 65536.0;
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    let place = bitcast<vec4f>(diffuse[2u * (index / 6u)]);
    let tag = diffuse[2u * (index / 6u) + 1u].w;
    let kind = tag & 3u;
    let chance = random(tag);
    var opacity = 0.85;
    var size = 0.26;
    var nearer = 0.0;
    if kind == FOAM {
        opacity = 0.42;
        size = 0.62;
        // It lies in the surface, which is not to cut it in two.
        nearer = 2.5 * globals.foam_radius;
    } else if kind == BUBBLE {
        opacity = 0.30;
        size = 0.32;
    }
    opacity *= clamp(place.w / FADING, 0.0, 1.0);
    var radius = size * (0.6 + 0.8 * chance) * globals.foam_radius;
    let least = LEAST_RADIUS * globals.pixel_angle * distance(place.xyz, globals.eye);
    if radius < least {
        opacity *= radius * radius / (least * least);
        radius = least;
    }
    let corner = sphere_corner(vec4f(place.xyz, 0.0), radius, index);
    var out: Varying;
    out.position = corner.position;
    if out.position.w > 2.0 * nearer {
        out.position.z *= out.position.w / (out.position.w - nearer);
    }
    if ((KINDS >> kind) & 1u) == 0u {
        out.position = vec4f(2.0, 2.0, 2.0, 1.0);
    }
    out.across = corner.across;
    out.look = vec3f(opacity, 0.88 + 0.12 * chance, f32(kind));
    return out;
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    let inside = 1.0 - dot(in.across, in.across);
    if inside <= 0.0 {
        discard;
    }
    // Drops are round, foam is a blur, and a bubble's rim shines.
    var shape = smoothstep(0.0, 0.6, inside);
    if u32(in.look.z + 0.5) == FOAM {
        shape = inside;
    } else if u32(in.look.z + 0.5) == BUBBLE {
        shape = smoothstep(0.0, 0.15, inside) * (1.0 - 0.6 * smoothstep(0.2, 0.7, inside));
    }
    let light = SKY_LIGHT + 0.62 * SUN_LIGHT * max(globals.sun.y, 0.0);
    return vec4f(encode(soften(in.look.y * light)), in.look.x * shape);
}
