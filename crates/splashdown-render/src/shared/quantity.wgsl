// The quantity that a particle is coloured by: 0 speed, 1 density, 2 pressure.
fn quantity_of(which: u32, velocity: vec4f, density_pressure: vec2f) -> f32 {
    if which == 1u {
        return density_pressure.x;
    }
    if which == 2u {
        return density_pressure.y;
    }
    return length(velocity.xyz);
}
