// Intersection of rays with the triangles of liquid and bodies. Needs globals.wgsl. The layout of
// nodes is that of `Node` in bvh.rs.

@group(2) @binding(0) var<storage, read> tree_nodes: array<vec4u>;
@group(2) @binding(1) var<storage, read> tree_triangles: array<vec4u>;  // corners, colour
@group(2) @binding(2) var<storage, read> tree_corners: array<vec4u>;    // position, normal in two 16-bit numbers

const NO_TRIANGLE = 0xffffffffu;
const IS_LEAF = 0x80000000u;
const FAR = 1e30;

struct Hit {
    distance: f32,
    triangle: u32,
    place: vec2f,       // barycentric coordinates of the second and third corner
}

fn position_of(corner: u32) -> vec3f {
    return bitcast<vec3f>(tree_corners[corner].xyz);
}

// Distance at which a ray enters a box, or FAR if it misses the box within `limit`.
fn box_entry(low: vec3f, high: vec3f, origin: vec3f, inverse: vec3f, limit: f32) -> f32 {
    let a = (low - origin) * inverse;
    let b = (high - origin) * inverse;
    let nearer = min(a, b);
    let farther = max(a, b);
    let entry = max(max(nearer.x, nearer.y), max(nearer.z, 0.0));
    let leave = min(min(farther.x, farther.y), min(farther.z, limit));
    return select(FAR, entry, entry <= leave);
}

fn safe_inverse(direction: vec3f) -> vec3f {
    let small = abs(direction) < vec3f(1e-9);
    return 1.0 / select(direction, vec3f(1e-9), small);
}

// Intersection with one triangle (Moeller and Trumbore 1997).
fn triangle_hit(index: u32, origin: vec3f, direction: vec3f, nearest: Hit) -> Hit {
    let corners = tree_triangles[index];
    let a = position_of(corners.x);
    let ab = position_of(corners.y) - a;
    let ac = position_of(corners.z) - a;
    let p = cross(direction, ac);
    let determinant = dot(ab, p);
    let inverse = 1.0 / select(determinant, 1e-30, abs(determinant) < 1e-30);
    let from_a = origin - a;
    let u = dot(from_a, p) * inverse;
    let q = cross(from_a, ab);
    let v = dot(direction, q) * inverse;
    let t = dot(ac, q) * inverse;
    // The tolerance closes the gaps that rounding leaves at the edges of triangles.
    let inside = u >= -1e-5 && v >= -1e-5 && u + v <= 1.00001;
    if inside && t > globals.ray_offset && t < nearest.distance {
        return Hit(t, index, vec2f(u, v));
    }
    return nearest;
}

// The nearest triangle of a tree on a ray, before that of `known`.
fn nearest_of(root: u32, origin: vec3f, direction: vec3f, known: Hit) -> Hit {
    var nearest = known;
    if root == NO_TRIANGLE {
        return nearest;
    }
    let inverse = safe_inverse(direction);
    var stack: array<u32, 48>;
    var height = 0u;
    var current = root;
    loop {
        if (current & IS_LEAF) != 0u {
            let first = current & 0x0fffffffu;
            let end = first + ((current >> 28u) & 7u);
            for (var i = first; i < end; i++) {
                nearest = triangle_hit(i, origin, direction, nearest);
            }
            if height == 0u {
                break;
            }
            height--;
            current = stack[height];
            continue;
        }
        let row = 4u * current;
        let left = tree_nodes[row];
        let right = tree_nodes[row + 2u];
        let left_high = bitcast<vec3f>(tree_nodes[row + 1u].xyz);
        let right_high = bitcast<vec3f>(tree_nodes[row + 3u].xyz);
        let left_entry = box_entry(bitcast<vec3f>(left.xyz), left_high, origin, inverse, nearest.distance);
        let right_entry = box_entry(bitcast<vec3f>(right.xyz), right_high, origin, inverse, nearest.distance);
        let nearer = min(left_entry, right_entry);
        if nearer == FAR {
            if height == 0u {
                break;
            }
            height--;
            current = stack[height];
            continue;
        }
        let left_first = left_entry <= right_entry;
        current = select(right.w, left.w, left_first);
        if max(left_entry, right_entry) < FAR {
            stack[height] = select(left.w, right.w, left_first);
            height++;
        }
    }
    return nearest;
}

fn no_hit(limit: f32) -> Hit {
    return Hit(limit, NO_TRIANGLE, vec2f(0.0));
}

// The nearest triangle of liquid or bodies on a ray.
fn nearest_hit(origin: vec3f, direction: vec3f) -> Hit {
    let of_bodies = nearest_of(globals.body_root, origin, direction, no_hit(FAR));
    return nearest_of(globals.water_root, origin, direction, of_bodies);
}

// The body that liquid touches where a ray leaves the liquid, without air between them. The surface of the liquid lies on the
// body, so the search begins before the place: rays ignore what is at their origin.
fn touched_body(place: vec3f, direction: vec3f) -> Hit {
    let back = 4.0 * globals.ray_offset;
    var hit = nearest_of(globals.body_root, place - back * direction, direction, no_hit(back + globals.contact_distance));
    hit.distance -= back;
    return hit;
}

// Whether a body lies on a ray.
fn meets_body(origin: vec3f, direction: vec3f) -> bool {
    return nearest_of(globals.body_root, origin, direction, no_hit(FAR)).triangle != NO_TRIANGLE;
}

fn unpacked_normal(packed: u32) -> vec3f {
    let octahedron = unpack2x16snorm(packed);
    var n = vec3f(octahedron, 1.0 - abs(octahedron.x) - abs(octahedron.y));
    let fold = max(-n.z, 0.0);
    n.x += select(fold, -fold, n.x >= 0.0);
    n.y += select(fold, -fold, n.y >= 0.0);
    return normalize(n);
}

struct Struck {
    is_body: bool,
    colour: vec3f,      // of a body
    normal: vec3f,      // interpolated unit normal
    face: vec3f,        // normal of the triangle, of any length
}

fn struck(hit: Hit) -> Struck {
    let corners = tree_triangles[hit.triangle];
    let a = tree_corners[corners.x];
    let b = tree_corners[corners.y];
    let c = tree_corners[corners.z];
    let origin = bitcast<vec3f>(a.xyz);
    var out: Struck;
    out.face = cross(bitcast<vec3f>(b.xyz) - origin, bitcast<vec3f>(c.xyz) - origin);
    let rest = 1.0 - hit.place.x - hit.place.y;
    let smooth_normal = rest * unpacked_normal(a.w) + hit.place.x * unpacked_normal(b.w) + hit.place.y * unpacked_normal(c.w);
    out.normal = normalize(smooth_normal + 1e-6 * out.face);
    out.is_body = corners.w != 0u;
    let root_colour = unpack4x8unorm(corners.w).rgb;
    out.colour = root_colour * root_colour;
    return out;
}
