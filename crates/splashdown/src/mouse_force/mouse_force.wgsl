struct MouseForce {
    origin: vec3<f32>,
    radius: f32,
    direction: vec3<f32>,
    rate: f32,
    velocity: vec3<f32>,
    unused: f32,
}
