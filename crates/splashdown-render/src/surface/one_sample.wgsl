// The textures of the stored surface, with one sample per pixel.

@group(3) @binding(0) var normals: texture_2d<u32>;
@group(3) @binding(1) var depths: texture_depth_2d;

const SAMPLES = 1u;

fn stored_code(pixel: vec2u, sample: u32) -> vec2u {
    return textureLoad(normals, pixel, 0).rg;
}

fn stored_depth(pixel: vec2u, sample: u32) -> f32 {
    return textureLoad(depths, pixel, 0);
}
