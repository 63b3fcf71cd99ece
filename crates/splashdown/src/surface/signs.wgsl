// The signs of the eight nodes of a row and of the next node, one bit each. y and z go up to 8,
// which is in the next block. The pass binds what surface/slots needs and defines `sign_bits(row)`.
fn row_signs(place: vec3<i32>, y: u32, z: u32) -> u32 {
    let at = place + vec3<i32>(0, i32(y >> 3u), i32(z >> 3u));
    let row = (y & 7u) + 8u * (z & 7u);
    var bits = 0u;
    let slot = slot_at(at);
    if slot != NONE {
        bits = sign_bits(slot * 64u + row);
    }
    let next = slot_at(at + vec3<i32>(1, 0, 0));
    if next != NONE {
        bits |= (sign_bits(next * 64u + row) & 1u) << 8u;
    }
    return bits;
}

// The marching-cubes case of the cell at x from the signs of its four rows: (y, z), (y + 1, z), (y,
// z + 1), (y + 1, z + 1).
fn cell_case(signs: vec4<u32>, x: u32) -> u32 {
    let pairs = (signs >> vec4<u32>(x)) & vec4<u32>(3u);
    return pairs.x | (pairs.y << 2u) | (pairs.z << 4u) | (pairs.w << 6u);
}
