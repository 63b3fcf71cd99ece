// Shading of the liquid's surface without tracing rays: Fresnel blend of reflection and refraction,
// used for the mesh and the screen-space fluid. Needs globals.wgsl, environment.wgsl, optics.wgsl, picture_behind.wgsl.

@group(2) @binding(0) var scene_colour: texture_2d_array<f32>; // the picture without the liquid, a layer per tile
@group(2) @binding(1) var thickness: texture_2d<f32>;      // length of the view ray inside the liquid, m
@group(2) @binding(2) var scene_sampler: sampler;

// Length in metres of the view ray inside the liquid, at half the resolution. Nothing is read from beyond the
// picture, which only a tile shows.
fn liquid_path(pixel: vec2f) -> f32 {
    let in_picture = clamp(pixel + globals.tile_corner, vec2f(1.0), globals.picture_size - 1.0);
    let uv = (in_picture - globals.tile_corner) / globals.target_size;
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

// A ray that leaves the liquid.
struct Leaving {
    origin: vec3f,
    direction: vec3f,
    path: f32,              // length in the liquid, m
    is_straight: bool,      // whether it ends in the picture behind the liquid
}

// Follows a ray that has entered the liquid. The exit through a free surface is not known: the ray
// goes straight on to the picture behind. At a wall of the tank it is refracted, or reflected totally up to three
// times; the bottom of the tank ends it.
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
            return Leaving(origin, leaving, travelled, false);
        }
        direction -= 2.0 * direction * sideways;
        is_reflected = true;
    }
    let down = bottom_distance(origin, direction);
    let left = max(path - travelled, 0.0);
    let rest = select(left, min(left, down), down > 0.0);
    if is_reflected {
        return Leaving(origin, direction, travelled + rest, false);
    }
    return Leaving(origin + direction * rest, direction, rest, true);
}

// Colour of the liquid at the surface point `world`, with `path` metres of liquid behind it. The
// normal may have any length.
fn liquid_colour(world: vec3f, outward: vec3f, path: f32) -> vec3f {
    let to_eye = normalize(globals.eye - world);
    let normal = facing_normal(outward, to_eye);
    let facing = max(dot(normal, to_eye), 0.0);
    let mirrored = reflectance(facing, 1.0 / globals.refractive_index);
    let reflection = environment(world, reflect(-to_eye, normal), 6.0 * globals.pixel_angle);

    let bent = refract(-to_eye, normal, 1.0 / globals.refractive_index);
    let leaving = leaving_ray(world, bent, path);
    // Here and not in the loop of leaving_ray: a software driver would evaluate it in every turn.
    var behind: vec3f;
    if leaving.is_straight {
        behind = scene_at(leaving.origin);
    } else {
        behind = environment(leaving.origin, leaving.direction, 6.0 * globals.pixel_angle);
    }

    // Absorption along the path (Beer-Lambert), and light scattered back by a turbid liquid.
    let transmittance = exp(-globals.liquid_absorption * leaving.path);
    let transmitted = mix(behind * transmittance, scattered_light(normal), turbidity(leaving.path));
    let sun = sun_highlight(normal, to_eye, facing);
    return present(mix(transmitted, reflection, mirrored) + globals.sun_light * min(2.2 * sun, 12.0));
}
