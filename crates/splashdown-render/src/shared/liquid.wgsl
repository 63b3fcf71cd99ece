// Shading of the liquid's surface without tracing rays: Fresnel blend of reflection and refraction,
// used for the mesh and the screen-space fluid. Needs globals.wgsl, environment.wgsl, optics.wgsl, picture_behind.wgsl.

@group(2) @binding(0) var scene_colour: texture_2d_array<f32>; // the picture without the liquid, a layer per tile
@group(2) @binding(1) var thickness: texture_2d<f32>;      // length of the view ray inside the liquid, m
@group(2) @binding(2) var scene_sampler: sampler;
@group(2) @binding(3) var solid: texture_2d_array<f32>;    // relative distance of the nearest body, a layer per tile

// A place of the target, moved into the picture: only a tile shows what is around it.
fn in_picture(pixel: vec2f) -> vec2f {
    return clamp(pixel + globals.tile_corner, vec2f(1.0), globals.picture_size - 1.0) - globals.tile_corner;
}

// Length in metres of the view ray inside the liquid, at half the resolution.
fn liquid_path(pixel: vec2f) -> f32 {
    let uv = in_picture(pixel) / globals.target_size;
    return max(textureSampleLevel(thickness, scene_sampler, uv, 0.0).r, 0.0);
}

// Distance along a ray inside the tank to the nearest glass wall (x) and the axis of its normal (y).
fn wall_ahead(origin: vec3f, direction: vec3f) -> vec2f {
    var nearest = vec2f(1e30, -1.0);
    for (var axis = 0u; axis < 3u; axis += 2u) {
        let ahead = select(globals.box_min[axis], globals.box_max[axis], direction[axis] > 0.0);
        let is_glass = ((globals.glass[axis] >> select(0u, 1u, direction[axis] > 0.0)) & 1u) == 1u;
        let distance = (ahead - origin[axis]) / direction[axis];
        if is_glass && abs(direction[axis]) > 1e-4 && distance < nearest.x {
            nearest = vec2f(max(distance, 0.0), f32(axis));
        }
    }
    return nearest;
}

// Where a ray in the liquid ends.
const IN_PICTURE = 0u;  // at a place that the picture behind the liquid shows
const AT_WALL = 1u;     // at a wall of the tank, or after a reflection there
const AT_SURFACE = 2u;  // at a free surface

// The end of a ray in the liquid.
struct Leaving {
    origin: vec3f,
    direction: vec3f,
    path: f32,              // length in the liquid, m
    end: u32,
}

// The view ray ends at a solid that is at most this far from where it enters the liquid: over its length in the liquid, and
// in addition over the diagonal of the box or the radius of the spheres of a liquid of particles. The thickness of the liquid
// is less precise than the places of solids.
const NEAR_END = 2.0;
const NEAR_END_IN_BOX = 0.02;
const NEAR_END_IN_SPLATS = 3.0;

// Whether the part of the view ray in the liquid ends at a body, at the bottom or at a wall, and not at a free surface
// that refracts it.
fn ends_at_solid(world: vec3f, path: f32) -> bool {
    if globals.exit_reach == 0.0 {
        return true;
    }
    let view = normalize(world - globals.eye);
    let down = bottom_distance(world, view);
    let in_box = NEAR_END_IN_BOX * length(globals.box_max - globals.box_min);
    let near = NEAR_END * path + max(in_box, NEAR_END_IN_SPLATS * globals.splat_radius);
    let at_bottom = down > 0.0 && down < near;
    return at_bottom || wall_ahead(world, view).x < near || body_towards(world) < relative_to_middle(world) + near;
}

// Follows a ray that has entered the liquid. At a wall of the tank it is refracted, or reflected totally up to three times; a
// body or the bottom of the tank ends it. The ray leaves through a free surface after the length of the view ray.
fn leaving_ray(world: vec3f, bent: vec3f, path: f32) -> Leaving {
    var origin = world;
    var direction = bent;
    var travelled = 0.0;
    var is_reflected = false;
    for (var turn = 0; turn < 3; turn++) {
        let wall = wall_ahead(origin, direction);
        let down = bottom_distance(origin, direction);
        let reaches_bottom = down > 0.0 && down < wall.x;
        // On the first segment the length of the view ray tells whether the liquid extends to the wall.
        let in_liquid = turn > 0 || wall.x < 1.2 * path;
        if reaches_bottom || !in_liquid || wall.y < 0.0 {
            break;
        }
        origin += direction * wall.x;
        travelled += wall.x;
        let axis = u32(wall.y);
        let sideways = vec3f(vec3u(0u, 1u, 2u) == vec3u(axis));
        let outward = sideways * sign(direction[axis]);
        let leaving = refract(direction, -outward, globals.refractive_index);
        if dot(leaving, leaving) > 0.0 {
            return Leaving(origin, leaving, travelled, AT_WALL);
        }
        direction -= 2.0 * direction * sideways;
        is_reflected = true;
    }
    let down = bottom_distance(origin, direction);
    let left = max(path - travelled, 0.0);
    let at_bottom = down > 0.0 && down < left;
    let rest = select(left, down, at_bottom);
    if is_reflected {
        return Leaving(origin, direction, travelled + rest, AT_WALL);
    }
    let end = select(AT_SURFACE, IN_PICTURE, at_bottom || ends_at_solid(world, path));
    return Leaving(origin + direction * rest, direction, rest, end);
}

// The place where the view ray of a pixel leaves the liquid, relative to the eye, if it enters in the plane through a
// point.
fn exit_of(pixel: vec2f, from_eye: vec3f, normal: vec3f) -> vec3f {
    let place = in_picture(pixel);
    let ray = normalize(view_ray(place));
    let distance = length(from_eye);
    let entry = clamp(dot(from_eye, normal) / min(dot(ray, normal), -0.05), 0.5 * distance, 2.0 * distance);
    return ray * (entry + liquid_path(place));
}

// The outward normal of the surface through which a ray in this direction leaves the liquid: from the differences of the
// exits of the view rays around a pixel. They are a part of the thickness apart, because it is stored in 16-bit floats.
fn exit_normal(pixel: vec2f, world: vec3f, normal: vec3f, direction: vec3f, path: f32) -> vec3f {
    let from_eye = world - globals.eye;
    let pixel_size = length(from_eye) * globals.pixel_angle;
    // Whole pixels have the same place between the texels of the thickness.
    let step = floor(clamp(0.15 * path / pixel_size, min(2.0, globals.exit_reach), globals.exit_reach));
    let right = vec2f(step, 0.0);
    let low = vec2f(0.0, step);
    let a = exit_of(pixel + right, from_eye, normal) - exit_of(pixel - right, from_eye, normal);
    let b = exit_of(pixel + low, from_eye, normal) - exit_of(pixel - low, from_eye, normal);
    // Without units, so that the smallest scenes have a normal.
    return facing_normal(cross(a / pixel_size, b / pixel_size), direction);
}

// Mean light of bubbles over that of white foam; see foam.wgsl.
const BUBBLES = 0.9;

// Parts into which a ray in the liquid is divided to find the body that it meets first, and how often the part in which it
// does is halved.
const PARTS = 12;
const HALVINGS = 5;

// A place on a ray, its distance along it in m, and whether the picture behind the liquid shows it.
struct Place {
    world: vec3f,
    travelled: f32,
    is_shown: bool,
}

// Distance along a ray inside the box to its sides.
fn box_exit(origin: vec3f, direction: vec3f) -> f32 {
    let ahead = select(globals.box_min, globals.box_max, direction > vec3f(0.0)) - origin;
    let along = select(direction, vec3f(1e-6), abs(direction) < vec3f(1e-6));
    let distances = abs(ahead / along);
    return min(min(distances.x, distances.y), distances.z);
}

// How far a place is behind the nearest body that the picture shows there.
fn behind_body(place: vec3f) -> f32 {
    return relative_to_middle(place) - body_towards(place);
}

// Where a ray in the liquid ends: at the first body that it meets, or where it leaves the box.
fn end_in_liquid(world: vec3f, direction: vec3f) -> Place {
    let slack = NEAR_END_IN_BOX * length(globals.box_max - globals.box_min);
    let end = box_exit(world, direction);
    var before = 0.0;
    for (var part = 1; part <= PARTS; part++) {
        var after = end * f32(part) / f32(PARTS);
        if behind_body(world + direction * after) > 0.0 {
            for (var turn = 0; turn < HALVINGS; turn++) {
                let middle = 0.5 * (before + after);
                let is_behind = behind_body(world + direction * middle) > 0.0;
                after = select(after, middle, is_behind);
                before = select(middle, before, is_behind);
            }
            let place = world + direction * after;
            // Otherwise the ray passes behind the body.
            if behind_body(place) < slack {
                return Place(place, after, true);
            }
        }
        before = end * f32(part) / f32(PARTS);
    }
    let place = world + direction * end;
    return Place(place, end, behind_body(place) < slack);
}

// The light that a ray brings from where it leaves the liquid, and its length in the liquid in m. The light is that of the
// picture behind the liquid, where the place that the ray meets is known, and otherwise that of the environment.
fn light_behind(pixel: vec2f, world: vec3f, normal: vec3f, leaving: Leaving) -> vec4f {
    var path = leaving.path;
    var place = leaving.origin;
    var direction = leaving.direction;
    var is_known = leaving.end == IN_PICTURE;
    if is_known && globals.exit_reach > 0.0 {
        let end = end_in_liquid(world, direction);
        // The floor is known without the picture too.
        place = select(world, end.world, end.is_shown);
        is_known = end.is_shown;
        path = end.travelled;
    } else if is_known && body_towards(place) < relative_to_middle(world) {
        // A body in front of the surface hides the place.
        place = world;
    }
    if leaving.end == AT_SURFACE {
        let outward = exit_normal(pixel, world, normal, direction, leaving.path);
        let refracted = refract(direction, -outward, globals.refractive_index);
        // Total reflection: nothing is known about further ways in the liquid.
        direction = select(reflect(direction, outward), refracted, dot(refracted, refracted) > 0.0);
        let ahead = body_ahead(place, direction);
        let to_floor = floor_distance(place, direction);
        let on_floor = place + direction * to_floor;
        // A body that hides the place on the floor from the eye probably hides it from the ray as well.
        let hiding = body_towards(on_floor);
        let is_hidden = to_floor > 0.0
            && hiding < min(relative_to_middle(on_floor), NO_BODY)
            && hiding > relative_to_middle(place);
        is_known = ahead > 0.0 || is_hidden;
        place += direction * select(select(0.0, to_floor, is_hidden), ahead, ahead > 0.0);
    }
    // At the end, once each: a software driver evaluates both.
    let seen = scene_at(place);
    if is_known {
        return vec4f(seen.rgb, path);
    }
    let outside = environment(place, direction, 6.0 * globals.pixel_angle);
    return vec4f(mix(BUBBLES * globals.foam_light, outside, seen.a), path);
}

// Colour of the liquid in a pixel at the surface point `world`. The normal may have any length.
fn liquid_colour(pixel: vec2f, world: vec3f, outward: vec3f) -> vec3f {
    let path = liquid_path(pixel);
    let to_eye = normalize(globals.eye - world);
    let normal = facing_normal(outward, to_eye);
    let facing = max(dot(normal, to_eye), 0.0);
    let mirrored = reflectance(facing, 1.0 / globals.refractive_index);
    let reflection = environment(world, reflect(-to_eye, normal), 6.0 * globals.pixel_angle);

    let bent = refract(-to_eye, normal, 1.0 / globals.refractive_index);
    let leaving = leaving_ray(world, bent, path);
    let behind = light_behind(pixel, world, normal, leaving);

    // Absorption along the path (Beer-Lambert), and light scattered back by a turbid liquid.
    let transmittance = exp(-globals.liquid_absorption * behind.w);
    let transmitted = mix(behind.rgb * transmittance, scattered_light(normal), turbidity(behind.w));
    let sun = sun_highlight(normal, to_eye, facing);
    return present(mix(transmitted, reflection, mirrored) + globals.sun_light * min(2.2 * sun, 12.0));
}
