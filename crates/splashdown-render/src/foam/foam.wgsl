// Foam and spray as groups of bubbles and drops, and bubbles under water, on white billboards.
// Needs globals.wgsl, environment.wgsl.

@group(2) @binding(0) var<storage, read> diffuse: array<vec4u>;

// Bit k is set if kind k is drawn.
override KINDS: u32 = 7u;

const SPRAY = 0u;
const FOAM = 1u;
const BUBBLE = 2u;
// Particles fade out over the last seconds of their lifetime.
const FADE_TIME = 0.5;
// Smallest radii of a group, of its members and of a bubble, in pixels. What is smaller would flicker; it is
// enlarged and made fainter.
const MIN_GROUP = 2.0;
const MIN_MEMBER = 1.0;
const MIN_BUBBLE = 1.2;
// Least foreshortening of foam, which lies in the surface of the liquid. Its bubbles stand out of it.
const FLATTEST = 0.42;
// Longest way while the shutter is open, in radii of a billboard.
const LONGEST = 60.0;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) across: vec2f,        // in radii of the billboard; the motion is along x
    // Half the length of the motion, opacity of the veil of drops that are too small to be drawn, and kind.
    @location(1) @interpolate(flat) appearance: vec3f,
    @location(2) @interpolate(flat) colour: vec3f,
    // Members of the group: place, one over the square of the radius, opacity.
    @location(3) @interpolate(flat) member_0: vec4f,
    @location(4) @interpolate(flat) member_1: vec4f,
    @location(5) @interpolate(flat) member_2: vec4f,
    @location(6) @interpolate(flat) member_3: vec4f,
}

// Pseudo-random bits: the generator PCG (O'Neill 2014) as a hash (Jarzynski and Olano 2020).
fn random_bits(seed: u32) -> u32 {
    let state = seed * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// What remains of the opacity of a disc of a radius that moves by `way` in both directions: the light is spread
// over a larger area. For the profile (1 - q)^2 of `past`.
fn thinned(way: f32, radius: f32) -> f32 {
    return radius / (radius + 2.037 * way);
}

struct Sizes {
    billboard: f32,    // m
    pixel: f32,        // m
    way: f32,          // m
}

// A member of a group: `smallest` is the radius in m of the most frequent members.
fn member(seed: u32, smallest: f32, opaque: f32, sizes: Sizes) -> vec4f {
    let bits = random_bits(seed);
    let ranges = vec3u(2047u, 2047u, 1023u);
    let unit = vec3f(vec3u(bits, bits >> 11u, bits >> 22u) & ranges) / vec3f(ranges);
    // Many small and few large: the number of members above a radius falls with its square.
    let own = smallest * inverseSqrt(0.03 + 0.97 * unit.z);
    let drawn = min(max(own, MIN_MEMBER * sizes.pixel), sizes.billboard);
    let side = 2.0 * unit.xy - 1.0;
    // The square onto the circle.
    let place = side * sqrt(1.0 - 0.5 * side.yx * side.yx) * (1.0 - drawn / sizes.billboard);
    let opacity = opaque * (own * own) / (drawn * drawn) * thinned(sizes.way, drawn);
    let ratio = sizes.billboard / drawn;
    return vec4f(place, ratio * ratio, opacity);
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    var particle = bitcast<vec4f>(diffuse[2u * (index / 3u)]);
    let velocity = bitcast<vec3f>(diffuse[2u * (index / 3u) + 1u].xyz);
    particle += vec4f(velocity * globals.shutter_time, 0.0);
    let tag = diffuse[2u * (index / 3u) + 1u].w;
    let kind = tag & 3u;
    let seed = random_bits(tag >> 2u);
    let variation = f32(seed >> 16u) / 65536.0;
    let centre = particle.xyz - globals.eye;
    let away = length(centre);
    let axis = centre / away;
    // Height over width on the screen.
    let flatness = select(1.0, max(abs(axis.y), FLATTEST), kind == FOAM);
    // In radii of the particles of the fluid. Many small groups and few large ones.
    let few = variation * variation;
    var size = 0.55 + 0.75 * few;
    var smallest = 0.085;
    var opaque = 0.9;
    var veil = 0.02;
    var nearer = 0.0;
    if kind == FOAM {
        size = 0.65 + 0.85 * few;
        smallest = 0.14;
        opaque = 0.65;
        veil = 0.13;
        // The depth offset prevents the surface from cutting the patches in two.
        nearer = 2.5 * globals.foam_radius;
    } else if kind == BUBBLE {
        size = 0.2 * inverseSqrt(0.1 + 0.9 * variation);
        veil = 0.3;
    }
    let pixel = globals.pixel_angle * away / flatness;
    let own_radius = size * globals.foam_radius;
    let radius = max(own_radius, select(MIN_GROUP, MIN_BUBBLE, kind == BUBBLE) * pixel);

    // The plane of the billboard, and the way of the particle in it while the shutter is open.
    let u = normalize(cross(axis, globals.up + 0.001 * globals.right));
    let v = cross(u, axis);
    let half_way = 0.5 * globals.foam_shutter * vec2f(dot(velocity, u), dot(velocity, v) / flatness);
    let way = length(half_way);
    let is_moving = way > 1e-3 * radius;
    let along = select(vec2f(1.0, 0.0), half_way / way, is_moving);
    let streak = select(0.0, min(way / radius, LONGEST), is_moving);

    // The triangle around the strip of half-length `streak` and radius 1, with a side along the motion.
    let corner = f32(index % 3u);
    let base = 2.0 * streak + sqrt(streak * streak + 3.0);
    let side = vec2f(base * (corner - 1.0), select(-1.0, 2.0, corner == 1.0));
    let offset = radius * (along * side.x + vec2f(-along.y, along.x) * side.y);

    var out: Varying;
    out.position = globals.clip_from_world
        * vec4f(globals.eye + centre + u * offset.x + v * (flatness * offset.y), 1.0);
    if out.position.w > 2.0 * nearer {
        out.position.z *= out.position.w / (out.position.w - nearer);
    }
    // Also false for NaN and infinity, and near the eye: these are not drawn. NaN would remain in a layer of floats.
    let is_drawn = away > 1.1 * radius && away < 1e15 && particle.w > 0.0 && dot(velocity, velocity) < 1e20;
    if !is_drawn || ((KINDS >> kind) & 1u) == 0u {
        out.position = vec4f(2.0, 2.0, 2.0, 1.0);
    }
    out.across = side;
    let fading = select(0.0, clamp(particle.w / FADE_TIME, 0.0, 1.0), is_drawn);
    let sizes = Sizes(radius, pixel, streak * radius);
    smallest *= globals.foam_radius;
    opaque *= fading;
    out.member_0 = member(seed + 1u, smallest, opaque, sizes);
    out.member_1 = member(seed + 2u, smallest, opaque, sizes);
    out.member_2 = member(seed + 3u, smallest, opaque, sizes);
    out.member_3 = member(seed + 4u, smallest, opaque, sizes);
    let fainter = own_radius * own_radius / (radius * radius) * thinned(streak, 1.0);
    out.appearance = vec3f(streak, veil * fading * fainter, f32(kind));
    var light = globals.foam_light;
    if kind == SPRAY {
        // Drops scatter sunlight mostly forwards.
        let forward = 0.5 + 0.5 * dot(axis, globals.sun);
        light = 0.86 * globals.sky_light + globals.sun_light * (0.4 + 0.4 * forward * forward * forward * forward);
    }
    out.colour = present((0.8 + 0.2 * variation) * light);
    return out;
}

// Square of the distance from the way of a point, in radii.
fn beside_way(offset: vec2f, streak: f32) -> f32 {
    let over = max(abs(offset.x) - streak, 0.0);
    return over * over + offset.y * offset.y;
}

// How much of the light from behind passes a member.
fn past(across: vec2f, member: vec4f, streak: f32) -> f32 {
    let inside = max(1.0 - member.z * beside_way(across - member.xy, streak), 0.0);
    return 1.0 - member.w * inside * inside;
}

// The colour times the opacity, and the opacity.
@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    let streak = in.appearance.x;
    let inside = 1.0 - beside_way(in.across, streak);
    if inside <= 0.0 {
        discard;
    }
    var opacity: f32;
    if u32(in.appearance.z + 0.5) == BUBBLE {
        // A bright rim, which motion blurs.
        let rim = 0.6 / (1.0 + 2.0 * streak);
        opacity = in.appearance.y * smoothstep(0.0, 0.15, inside) * (1.0 - rim * smoothstep(0.2, 0.7, inside));
    } else {
        var behind = 1.0 - in.appearance.y * inside * inside;
        behind *= past(in.across, in.member_0, streak);
        behind *= past(in.across, in.member_1, streak);
        behind *= past(in.across, in.member_2, streak);
        behind *= past(in.across, in.member_3, streak);
        opacity = 1.0 - behind;
    }
    return vec4f(in.colour * opacity, opacity);
}
