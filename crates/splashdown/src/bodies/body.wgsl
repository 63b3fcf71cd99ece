// Mirrors types.rs.
const BODY_STATIC: u32 = 0u;
const BODY_SCRIPTED: u32 = 1u;
const BODY_DYNAMIC: u32 = 2u;
const BODY_PARTICLES: u32 = 1u;
const NO_BODY: u32 = 0xffffffffu;
const SCRIPT_SAMPLES: u32 = 65u;
const SUM_WORDS: u32 = 12u;
const SUPPORTS: u32 = 8u;

struct Body {
    position: vec3<f32>,
    kind: u32,
    orientation: vec4<f32>,
    velocity: vec3<f32>,
    friction: f32,
    angular_velocity: vec3<f32>,
    adhesion: f32,
    center: vec3<f32>,
    inverse_mass: f32,
    inertia: vec3<f32>,
    way: u32,
    inertia_products: vec3<f32>,
    radius: f32,
    inverse_inertia: vec3<f32>,
    first_node: u32,
    inverse_inertia_products: vec3<f32>,
    nodes_x: u32,
    field_min: vec3<f32>,
    cell_size: f32,
    force: vec3<f32>,
    nodes_y: u32,
    torque: vec3<f32>,
    nodes_z: u32,
    first_sample_cell: u32,
    samples_x: u32,
    samples_y: u32,
    samples_z: u32,
    reach: f32,
    script: u32,
    is_complete: u32,
    work: f32,
    moment: vec3<f32>,
    coupling: f32,
    motor: vec3<f32>,
    motor_torque: f32,
}

struct Contact {
    slope: vec3<f32>,
    density: f32,
    normal: vec3<f32>,
    distance: f32,
    kernel_fraction: f32,
    effective: f32,
    body: u32,
    unused: u32,
}

// The unit vector along which the body's pressure acts; see Contact in types.rs.
fn direction(contact: Contact, scale: f32) -> vec3<f32> {
    let steep = length(contact.slope);
    return select(contact.normal, contact.slope / max(steep, 1e-20), steep > 1e-3 * scale);
}

// The acceleration that continues `a` into a body; see Contact in types.rs.
fn continued(contact: Contact, a: vec3<f32>, scale: f32) -> vec3<f32> {
    let n = direction(contact, scale);
    let fraction = clamp(contact.density, 0.0, 0.6);
    return fraction / (1.0 - fraction) * (a - dot(a, n) * n);
}

// The gradient of the contribution to the density with which a body acts on the implicit pressure; see solid_gradient.
fn solid_gradient_of(contact: Contact) -> vec3<f32> {
    return -2.0 * contact.slope;
}

struct Support {
    normal: vec3<f32>,
    min_speed: f32,
    arm: vec3<f32>,
    impulse: f32,
}

struct ScriptSample {
    position: vec3<f32>,
    unused: f32,
    orientation: vec4<f32>,
    velocity: vec3<f32>,
    unused_2: f32,
    angular_velocity: vec3<f32>,
    unused_3: f32,
}

// Rotates a vector by a unit quaternion; `turned_back` by its inverse.
fn turned(q: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    let t = 2.0 * cross(q.xyz, v);
    return v + q.w * t + cross(q.xyz, t);
}

fn turned_back(q: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    return turned(vec4(-q.xyz, q.w), v);
}
