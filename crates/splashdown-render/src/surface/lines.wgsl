// The edges of the surface's triangles. Needs globals.wgsl, environment.wgsl.

@group(2) @binding(0) var<storage, read> vertices: array<vec4f>;
@group(2) @binding(1) var<storage, read> indices: array<u32>;

// 1 where the lines lie on the lit surface and only fronts are drawn, 0 where they are alone.
override OVER_SURFACE: u32 = 1u;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) corner: vec3f,        // weights of the triangle's corners
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    let vertex = vertices[indices[index]];
    let corner = index % 3u;
    var out: Varying;
    out.position = globals.clip_from_world * vec4f(vertex.xyz, 1.0);
    // A ten-thousandth nearer, so that lines do not fight with the faces that they lie on.
    out.position.z *= 1.0001;
    out.corner = vec3f(vec3u(corner) == vec3u(0u, 1u, 2u));
    return out;
}

@fragment
fn fragment_main(in: Varying, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let right = dpdx(in.corner);
    let down = dpdy(in.corner);
    // A corner's weight falls from 1 to 0 over the triangle's height on the screen.
    let heights = inverseSqrt(max(right * right + down * down, vec3f(1e-12)));
    let pixels = in.corner * heights;
    let nearest = min(min(pixels.x, pixels.y), pixels.z);
    // Each of the two triangles at an edge draws half of the line.
    let half_width = 0.35 * globals.line_width;
    let covered = 1.0 - smoothstep(half_width - 0.5, half_width + 0.5, nearest);
    // Triangles of a few pixels would be nothing but lines.
    let height = min(min(heights.x, heights.y), heights.z);
    let fine = clamp(height / (14.0 * half_width), 0.3, 1.0);
    var opacity = 0.8 * covered * fine;
    if OVER_SURFACE == 0u && !front {
        opacity *= 0.3;
    }
    return vec4f(encode(vec3f(0.008, 0.035, 0.075)), opacity);
}
