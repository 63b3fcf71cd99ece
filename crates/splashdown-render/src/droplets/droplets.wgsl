// Droplets as spheres that are blurred by their motion. Needs globals.wgsl, environment.wgsl, optics.wgsl, sphere.wgsl, and
// plain.wgsl or traced.wgsl: two rows per droplet, position and velocity; the fourth components are not read.

// 1: only pixels that a droplet covers all the time; 0: only the others.
override OPAQUE: u32 = 1u;

// Times at which a streak is shaded.
const TIMES = 3;
// Smallest radius in pixels. Smaller droplets would flicker; they are enlarged and made fainter.
const MIN_RADIUS = 0.7;
// Coverage from which a pixel is opaque.
const WHOLE = 0.99;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) across: vec2f,        // place in the plane through the centre, in radii; the motion is along x
    @location(1) ray: vec3f,           // from the eye
    @location(2) @interpolate(flat) centre: vec4f,  // xyz: relative to the eye, w: distance
    @location(3) @interpolate(flat) along: vec4f,   // xyz: unit vector of the motion, w: half the streak in radii
    @location(4) @interpolate(flat) size: vec3f,    // radius in m, width of a pixel in radii, opacity
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    let velocity = bitcast<vec3f>(droplets[2u * (index / 6u) + 1u].xyz);
    let place = bitcast<vec3f>(droplets[2u * (index / 6u)].xyz) + velocity * globals.shutter_time;
    let centre = place - globals.eye;
    let distance = length(centre);
    let pixel = globals.pixel_angle * distance;
    let radius = max(globals.droplet_radius, MIN_RADIUS * pixel);
    var out: Varying;
    // Also false for NaN and infinity, and near the eye: these are not drawn.
    if !(distance > 1.1 * radius && distance < 1e15 && dot(velocity, velocity) < 1e20) {
        out.position = vec4f(2.0, 2.0, 2.0, 1.0);
        return out;
    }
    let axis = centre / distance;
    let half_way = 0.5 * globals.droplet_shutter * (velocity - axis * dot(axis, velocity));
    let length_squared = dot(half_way, half_way);
    let is_moving = length_squared > 1e-4 * radius * radius;
    let upright = normalize(cross(axis, globals.up + 0.001 * globals.right));
    let along = select(upright, half_way * inverseSqrt(max(length_squared, 1e-30)), is_moving);
    let streak = select(0.0, sqrt(length_squared) / radius, is_moving);

    // Two triangles, corners 0 1 2 and 2 1 3, packed two bits each.
    let corner = (0xDA4u >> (2u * (index % 6u))) & 3u;
    let side = vec2f(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0;
    // One extra pixel on every side for partially covered pixels.
    let reach = 1.0 + pixel / radius;
    out.across = side * vec2f(reach + streak, reach);
    out.ray = centre + radius * (along * out.across.x + cross(along, axis) * out.across.y);
    out.centre = vec4f(centre, distance);
    out.along = vec4f(along, streak);
    let shrunk = globals.droplet_radius / radius;
    out.size = vec3f(radius, pixel / radius, shrunk * shrunk);
    out.position = globals.clip_from_world * vec4f(globals.eye + out.ray, 1.0);
    return out;
}

// The light of a droplet from a point of its sphere with a unit normal; `towards` is the direction of the view ray.
fn droplet_light(place: vec3f, normal: vec3f, towards: vec3f, radius: f32) -> vec3f {
    let spread = 4.0 * globals.pixel_angle;
    let facing = max(-dot(normal, towards), 0.02);
    let mirrored = reflectance(facing, 1.0 / globals.refractive_index);
    let bent = refract(towards, normal, 1.0 / globals.refractive_index);
    // The chord of the sphere, at whose ends the ray has the same angle with the normal.
    let path = 2.0 * radius * max(-dot(bent, normal), 0.0);
    let exit = place + path * bent;
    let inward = -normalize(normal * radius + path * bent);
    var leaving = refract(bent, inward, globals.refractive_index);
    leaving = select(bent, normalize(leaving), dot(leaving, leaving) > 0.5);
    let passed_through = exp(-globals.liquid_absorption * path) * light_towards(exit, leaving, spread);
    let transmitted = mix(passed_through, scattered_light(normal), turbidity(path));
    let reflection = environment(place, reflect(towards, normal), spread);
    let sun = sun_highlight(normal, -towards, facing);
    return mix(transmitted, reflection, mirrored) + globals.sun_light * min(2.2 * sun, 12.0);
}

struct Output {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment_main(in: Varying) -> Output {
    let pixel = in.size.y;
    // The disc covers this place from `first` to `last`, in radii of its way; a disc at rest moves by a pixel, which
    // smooths its outline.
    let streak = max(in.along.w, 0.5 * pixel);
    let chord = sqrt(max(1.0 - in.across.y * in.across.y, 0.0));
    let first = max(-streak, in.across.x - chord);
    let last = min(streak, in.across.x + chord);
    let edge = clamp((1.0 - abs(in.across.y)) / pixel + 0.5, 0.0, 1.0);
    let coverage = clamp((last - first) / (2.0 * streak), 0.0, 1.0) * edge * in.size.z;
    let is_drawn = coverage > 0.004 && (coverage >= WHOLE) == (OPAQUE == 1u);
    if !is_drawn {
        discard;
    }
    let radius = in.size.x;
    let axis = in.centre.xyz / in.centre.w;
    let beside = cross(in.along.xyz, axis);
    let towards = normalize(in.ray);
    // No turn where nothing is drawn: software drivers shade discarded pixels too.
    let times = select(0, select(1, TIMES, last - first > 0.5), is_drawn);
    var light = vec3f(0.0);
    var nearest = 0.0;
    for (var i = 0; i < times; i++) {
        let time = mix(first, last, (f32(i) + 0.5) / f32(times));
        let shift = time * select(0.0, 1.0, in.along.w > 0.0);
        var disc = vec2f(in.across.x - shift, in.across.y);
        disc *= min(1.0, 0.98 * inverseSqrt(max(dot(disc, disc), 1e-6)));
        let rise = sqrt(1.0 - dot(disc, disc));
        let normal = in.along.xyz * disc.x + beside * disc.y - axis * rise;
        let place = in.centre.xyz + radius * (normal + in.along.xyz * shift);
        light += droplet_light(globals.eye + place, normal, towards, radius);
        nearest = max(nearest, rise);
    }
    var output: Output;
    output.colour = vec4f(present(light / f32(times)), select(coverage, 1.0, OPAQUE == 1u));
    let front = in.ray * (1.0 - nearest * radius / in.centre.w);
    output.depth = depth_of(dot(front, globals.forward));
    return output;
}
