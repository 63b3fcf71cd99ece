// The path of light through liquid, followed from surface to surface. Needs globals.wgsl,
// environment.wgsl, optics.wgsl, trace.wgsl, sunlit.wgsl, matte.wgsl.

// Surfaces that a path crosses before the environment replaces the rest.
override BOUNCES: i32 = 7;

// Pseudo-random number in [0, 1) for a pixel and sample (PCG hash, Jarzynski and Olano 2020).
fn random_of(pixel: vec2u, salt: u32) -> f32 {
    var state = pixel.x + 4096u * pixel.y + 16777259u * globals.sample + 2654435769u * salt;
    state = state * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return f32(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}

// Fraction of the light that passes through this length of liquid in metres (Beer-Lambert).
fn passed(path: f32) -> vec3f {
    return exp(-globals.liquid_absorption * path) * (1.0 - turbidity(path));
}

// Light that a point of the floor below the liquid sends out of it.
fn wet_floor(p: vec2f) -> vec3f {
    let albedo = floor_albedo(p, 0.0);
    let light = light_on_floor(p);
    let factors = wet(albedo);
    return albedo * (light[0] * factors[0] + light[1] * factors[1]);
}

// Light that a point of a body sends out of the liquid, or towards the eye outside it. The liquid takes away the gloss: its
// refractive index is near that of the body.
fn body_light(point: vec3f, outward: vec3f, colour: vec3f, to_eye: vec3f, in_liquid: bool) -> vec3f {
    let normal = visible_normal(outward, to_eye);
    let sun = globals.sun_light * sun_on(point, normal, in_liquid);
    let sky = sky_on(point, normal);
    let factors = wet(colour);
    let wet_light = colour * (sun * factors[0] + sky * factors[1]);
    return select(dry_light(normal, colour, to_eye, sun, sky), wet_light, in_liquid);
}

// The body at the end of a ray.
struct MetBody {
    is_met: bool,
    point: vec3f,
    normal: vec3f,
    colour: vec3f,
    in_liquid: bool,
}

// Light along a ray that starts at the surface of the liquid, which has this normal there. A part of the light is reflected at
// every surface: a picture of few samples follows the stronger part, one of many samples chooses.
fn followed_light(start: vec3f, towards: vec3f, outward: vec3f, spread: f32, pixel: vec2u) -> vec3f {
    var origin = start;
    var direction = towards;
    let glow = scattered_light(outward);
    var scattered = vec3f(0.0);
    var weight = vec3f(1.0);
    var inside = true;
    // Shaded after the loop: a software driver would shade it at every surface.
    var body: MetBody;
    for (var bounce = 0; bounce < BOUNCES; bounce++) {
        let hit = nearest_hit(origin, direction);
        let to_floor = floor_distance(origin, direction);
        if hit.triangle == NO_TRIANGLE || (to_floor > 0.0 && to_floor < hit.distance) {
            if inside && to_floor > 0.0 {
                scattered += weight * turbidity(to_floor) * glow;
                weight *= passed(to_floor);
            }
            break;
        }
        let place = origin + direction * hit.distance;
        let found = struck(hit);
        if inside {
            scattered += weight * turbidity(hit.distance) * glow;
            weight *= passed(hit.distance);
        }
        if found.is_body {
            body = MetBody(true, place, found.normal, found.colour, inside);
            break;
        }
        let leaving = dot(direction, found.face) > 0.0;
        let is_on_floor = has_floor() && place.y - globals.floor_height < globals.contact_distance;
        if leaving && is_on_floor && found.face.y < 0.0 {
            // The liquid touches the floor without air between them.
            return scattered + weight * wet_floor(place.xz);
        }
        if leaving {
            let beyond = touched_body(place, direction);
            if beyond.triangle != NO_TRIANGLE {
                let touched = struck(beyond);
                let at = place + direction * beyond.distance;
                body = MetBody(true, at, touched.normal, touched.colour, true);
                break;
            }
        }
        let normal = facing_normal(select(found.normal, -found.normal, leaving), -direction);
        let ratio = select(1.0 / globals.refractive_index, globals.refractive_index, leaving);
        let mirrored = reflectance(-dot(direction, normal), ratio);
        var threshold = 0.5;
        if globals.sample_count > 16u {
            threshold = random_of(pixel, u32(bounce) + 7u);
        }
        if mirrored > threshold {
            direction = reflect(direction, normal);
            inside = leaving;
        } else {
            direction = refract(direction, normal, ratio);
            inside = !leaving;
        }
        origin = place;
    }
    if body.is_met {
        return scattered + weight * body_light(body.point, body.normal, body.colour, -direction, body.in_liquid);
    }
    return scattered + weight * environment(origin, direction, spread);
}

// Light that arrives from outside the liquid: from bodies, from other parts of the liquid, and from
// the environment.
fn arriving_light(origin: vec3f, direction: vec3f, spread: f32) -> vec3f {
    let hit = nearest_hit(origin, direction);
    let to_floor = floor_distance(origin, direction);
    if hit.triangle == NO_TRIANGLE || (to_floor > 0.0 && to_floor < hit.distance) {
        return environment(origin, direction, spread);
    }
    let place = origin + direction * hit.distance;
    let found = struck(hit);
    if found.is_body {
        return matte(place, found.normal, found.colour, -direction);
    }
    // Other liquid: one more reflection, and a straight view through it.
    let normal = facing_normal(found.normal, -direction);
    let mirrored = reflectance(-dot(direction, normal), 1.0 / globals.refractive_index);
    let above = environment(place, reflect(direction, normal), spread);
    let through = environment(place, refract(direction, normal, 1.0 / globals.refractive_index), spread);
    return mix(through, above, mirrored);
}

// Light from a point of the surface of the liquid towards the eye.
fn traced_liquid(world: vec3f, outward: vec3f, pixel: vec2u) -> vec3f {
    let to_eye = normalize(globals.eye - world);
    let normal = facing_normal(outward, to_eye);
    let facing = max(dot(normal, to_eye), 0.0);
    let mirrored = reflectance(facing, 1.0 / globals.refractive_index);
    let spread = 2.0 * globals.pixel_angle;
    let bent = refract(-to_eye, normal, 1.0 / globals.refractive_index);
    let transmitted = followed_light(world, bent, normal, spread, pixel);
    let back = reflect(-to_eye, normal);
    var reflection: vec3f;
    if mirrored > 0.05 {
        reflection = arriving_light(world, back, spread);
    } else {
        reflection = environment(world, back, spread);
    }
    let sun = sun_highlight(normal, to_eye, facing);
    return mix(transmitted, reflection, mirrored) + globals.sun_light * min(2.2 * sun, 12.0);
}
