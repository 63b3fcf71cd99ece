// Writes unknowns of bodies, where `unknowns` is writable; imports sph/viscous_unknowns.

fn set_unknown(b: u32, what: u32, value: BodyVelocities) {
    unknowns[UNKNOWNS * b + what] = vec4(value.linear, 0.0);
    unknowns[UNKNOWNS * b + what + 1u] = vec4(value.angular, 0.0);
}
