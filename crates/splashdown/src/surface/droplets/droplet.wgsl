// Mirrors Droplet in droplets/mod.rs.
struct Droplet {
    position: vec3<f32>,
    id: u32,
    velocity: vec3<f32>,
    padding: u32,
}
