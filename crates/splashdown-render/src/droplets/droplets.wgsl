// Droplets as spheres that are blurred by their motion. Needs globals.wgsl, environment.wgsl, optics.wgsl, sphere.wgsl, and
// plain.wgsl or traced.wgsl: two rows per droplet, position and velocity; the fourth components are not read.

// Smallest radius in pixels. Smaller droplets would flicker; they are enlarged and made fainter.
const MIN_RADIUS = 0.7;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) across: vec2f,        // place in the plane through the centre, in radii; the motion is along x
    @location(1) ray: vec3f,           // from the eye
    @location(2) @interpolate(flat) centre: vec4f,  // xyz: relative to the eye, w: distance
    @location(3) @interpolate(flat) along: vec4f,   // xyz: unit vector of the motion, w: half the streak in radii
    // Radius in m, width of a pixel in radii, opacity, and half the axis along the motion in radii.
    @location(4) @interpolate(flat) size: vec4f,
    @location(5) @interpolate(flat) waves: vec2f,   // phase, slope
}

struct Shape {
    radius: f32,     // of the sphere with the volume of the droplet, over that of a particle
    length: f32,     // half the axis along the motion, over that radius
    phase: f32,      // of the oscillation
    moving: f32,     // 0: at rest, 1: fast
}

// Droplets of a splash differ in size, and oscillate. A droplet that flies keeps its horizontal velocity, so
// that a smooth function of it is a property of the droplet. The mean volume is that of a particle.
fn shape_of(place: vec3f, velocity: vec3f) -> Shape {
    // The speed of falling by a radius is the unit.
    let unit = sqrt(10.0 * globals.droplet_radius);
    let moving = dot(velocity, velocity) / (unit * unit + dot(velocity, velocity));
    let drift = 4.0 / unit * velocity.xz;
    let volume = sin(drift.x + 0.7 * drift.y + 1.7 * sin(1.3 * drift.y - 0.8 * drift.x));
    let phase = dot(place, vec3f(0.11, 0.13, 0.09)) / globals.droplet_radius + drift.x - drift.y;
    return Shape(pow(1.0 + 0.8 * moving * volume, 1.0 / 3.0), 1.0 + 0.16 * moving * sin(phase), phase, moving);
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    let velocity = bitcast<vec3f>(droplets[2u * (index / 6u) + 1u].xyz);
    let place = bitcast<vec3f>(droplets[2u * (index / 6u)].xyz) + velocity * globals.shutter_time;
    let centre = place - globals.eye;
    let distance = length(centre);
    let pixel = globals.pixel_angle * distance;
    let shape = shape_of(place, velocity);
    let own_radius = shape.radius * globals.droplet_radius;
    let radius = max(own_radius, MIN_RADIUS * pixel);
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
    let width = inverseSqrt(shape.length);
    out.across = side * (vec2f(shape.length + streak, width) + pixel / radius);
    out.ray = centre + radius * (along * out.across.x + cross(along, axis) * out.across.y);
    out.centre = vec4f(centre, distance);
    out.along = vec4f(along, streak);
    let shrunk = own_radius / radius;
    out.waves = vec2f(shape.phase, 0.35 * shape.moving);
    out.size = vec4f(radius, pixel / radius, shrunk * shrunk, shape.length);
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
    // An ellipsoid of the volume of the sphere: half the axis along the motion, and the others.
    let axes = vec3f(in.size.w, vec2f(inverseSqrt(in.size.w)));
    // The disc covers this place from `first` to `last`, in radii of its way; a disc at rest moves by a pixel, which
    // smooths its outline.
    let streak = max(in.along.w, 0.5 * pixel);
    let height = in.across.y / axes.y;
    let chord = axes.x * sqrt(max(1.0 - height * height, 0.0));
    let first = max(-streak, in.across.x - chord);
    let last = min(streak, in.across.x + chord);
    let edge = clamp((axes.y - abs(in.across.y)) / pixel + 0.5, 0.0, 1.0);
    let coverage = clamp((last - first) / (2.0 * streak), 0.0, 1.0) * edge * in.size.z;
    let is_drawn = coverage > 0.004;
    if !is_drawn {
        discard;
    }
    let radius = in.size.x;
    let axis = in.centre.xyz / in.centre.w;
    let beside = cross(in.along.xyz, axis);
    let towards = normalize(in.ray);
    // The light at the middle of that time stands for the mean: several sharp images of sun and horizon would show.
    let shift = 0.5 * (first + last) * select(0.0, 1.0, in.along.w > 0.0);
    var disc = vec2f(in.across.x - shift, in.across.y) / axes.xy;
    disc *= min(1.0, 0.98 * inverseSqrt(max(dot(disc, disc), 1e-6)));
    let rise = sqrt(1.0 - dot(disc, disc));
    let local = vec3f(disc, rise);
    let frame = mat3x3f(in.along.xyz, beside, -axis);
    let waves = in.waves.y * sin(2.6 * disc.yx + in.waves.x * vec2f(1.0, 1.7));
    let normal = frame * normalize(local / axes + vec3f(waves, 0.0));
    let place = in.centre.xyz + radius * (frame * (local * axes) + in.along.xyz * shift);
    var light = vec3f(0.0);
    // A loop without a turn where nothing is drawn: software drivers shade discarded pixels too, and both sides of a
    // branch.
    for (var i = select(1, 0, is_drawn); i < 1; i++) {
        light = droplet_light(globals.eye + place, normal, towards, radius);
    }
    var output: Output;
    output.colour = vec4f(present(light), coverage);
    let front = in.ray * (1.0 - rise * axes.z * radius / in.centre.w);
    output.depth = depth_of(dot(front, globals.forward));
    return output;
}
