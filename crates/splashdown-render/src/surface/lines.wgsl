// The edges of the surface's triangles (wireframe). Needs globals.wgsl, environment.wgsl.

@group(2) @binding(0) var<storage, read> vertices: array<vec4f>;
@group(2) @binding(1) var<storage, read> indices: array<u32>;

// 1: the lines are drawn on the shaded surface, front faces only. 0: the lines are drawn alone.
override OVER_SURFACE: u32 = 1u;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) corner: vec3f,        // barycentric coordinates
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    let vertex = vertices[indices[index]];
    let corner = index % 3u;
    var out: Varying;
    out.position = globals.clip_from_world * vec4f(vertex.xyz, 1.0);
    // Depth bias of 1e-4 against z-fighting with the faces.
    out.position.z *= 1.0001;
    out.corner = vec3f(vec3u(corner) == vec3u(0u, 1u, 2u));
    return out;
}

@fragment
fn fragment_main(in: Varying, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let right = dpdx(in.corner);
    let down = dpdy(in.corner);
    // Each barycentric coordinate falls from 1 to 0 over the height of the triangle on the screen.
    let heights = inverseSqrt(max(right * right + down * down, vec3f(1e-12)));
    let pixels = in.corner * heights;
    let nearest = min(min(pixels.x, pixels.y), pixels.z);
    // The two triangles at an edge draw half of the line each.
    let half_width = 0.35 * globals.line_width;
    let covered = 1.0 - smoothstep(half_width - 0.5, half_width + 0.5, nearest);
    // Lines of small triangles are fainter; otherwise a fine mesh would be black.
    let height = min(min(heights.x, heights.y), heights.z);
    let fine = clamp(height / (14.0 * half_width), 0.3, 1.0);
    var opacity = 0.8 * covered * fine;
    if OVER_SURFACE == 0u && !front {
        opacity *= 0.3;
    }
    return vec4f(encode(vec3f(0.001, 0.004, 0.010)), opacity);
}
