//! Collisions of bodies with one another and with the box, by `rapier3d`.
//!
//! *How it works.* The device moves every body in every step, collisions left out. After a batch of steps the
//! host makes rapier's bodies go the same way, from where they were before the batch with the mean velocity
//! that leads to where the device has them. Without a contact rapier arrives at the same place and its answer
//! is dropped, so that free bodies are untouched. With one, its places are taken, and what the contact changed
//! of the mean velocity is added to the device's.
//!
//! *Why not* rapier for all motion: the fluid's force changes in every step, and a host in every step is what
//! the house avoids.
//!
//! Dynamic bodies collide as their convex hull where that is nearly their volume, else as a convex
//! decomposition; what does not answer to forces as its triangles.

use glam::{Quat, Vec3, Vec4};
use rapier3d::prelude::{
    ColliderBuilder, PhysicsWorld, Pose, RevoluteJointBuilder, RigidBodyBuilder, RigidBodyHandle, Rotation,
    SharedShape, Vector,
};
use serde::{Deserialize, Serialize};

use super::load::LoadedBody;
use super::types::Body;
use crate::scene::Domain;

/// Friction between solids: wood on wood, roughly.
const FRICTION: f32 = 0.4;
/// Share of the approach speed that comes back.
const RESTITUTION: f32 = 0.2;
/// A hull this much larger than its body hides a hollow.
const HOLLOW: f32 = 1.1;

/// The bodies' twins in rapier's world.
#[derive(Serialize, Deserialize)]
pub(crate) struct Rigid {
    world: PhysicsWorld,
    /// One per body, in their order.
    handles: Vec<RigidBodyHandle>,
    /// Where they were after the last batch.
    before: Vec<Place>,
}

/// A position in m and a rotation, a quaternion.
type Place = ([f32; 3], [f32; 4]);

fn place(state: &Body) -> Place {
    (state.position.to_array(), state.rotation().to_array())
}

impl Rigid {
    /// `None` where nothing can collide.
    pub fn new(loaded: &[LoadedBody], states: &[Body], domain: &Domain) -> Option<Self> {
        if !states.iter().any(|body| body.kind == Body::DYNAMIC) {
            return None;
        }
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::ZERO;
        let smallest = states.iter().filter(|body| body.kind == Body::DYNAMIC).map(|body| body.reach);
        world.integration_parameters.length_unit = smallest.fold(f32::INFINITY, f32::min).max(1e-6);
        let handles =
            loaded.iter().zip(states).map(|(body, state)| insert(&mut world, body, state)).collect();
        insert_box(&mut world, domain);
        let before = states.iter().map(place).collect();
        Some(Self { world, handles, before })
    }

    /// Brings states up to date with the collisions of the last `seconds`; true if there were any.
    pub fn resolve(&mut self, states: &mut [Body], seconds: f32) -> bool {
        if seconds.is_nan() || seconds <= 0.0 {
            return false;
        }
        let mut means = Vec::with_capacity(states.len());
        for ((state, handle), &(position, rotation)) in states.iter().zip(&self.handles).zip(&self.before) {
            let (position, rotation) = (Vec3::from(position), Quat::from_array(rotation));
            let body = &mut self.world.bodies[*handle];
            let velocity = (state.position - position) / seconds;
            let turn = state.rotation() * rotation.conjugate();
            let spin = if turn.w < 0.0 { -turn } else { turn }.to_scaled_axis() / seconds;
            means.push((velocity, spin));
            if state.kind == Body::DYNAMIC {
                body.set_position(pose(position, rotation), true);
                body.set_linvel(there(velocity), true);
                body.set_angvel(there(spin), true);
            } else if state.kind == Body::SCRIPTED {
                body.set_next_kinematic_position(pose(state.position, state.rotation()));
            }
        }
        self.world.integration_parameters.dt = seconds;
        self.world.step();
        let mut collided = false;
        for (b, state) in states.iter_mut().enumerate() {
            let handle = self.handles[b];
            let body = &self.world.bodies[handle];
            if state.kind == Body::DYNAMIC && self.touches(handle) {
                collided = true;
                let (velocity, spin) = means[b];
                let axis = axis(state).map(|axis| state.rotation() * axis);
                if axis.is_none() {
                    state.position = here(body.position().translation);
                    state.velocity += here(body.linvel()) - velocity;
                }
                let [x, y, z, w] = body.position().rotation.to_array();
                state.orientation = Vec4::new(x, y, z, w).normalize_or(state.orientation);
                let turn = here(body.angvel()) - spin;
                state.angular_velocity += axis.map_or(turn, |axis| axis.dot(turn) * axis);
            }
            self.before[b] = place(state);
        }
        collided
    }

    /// Bodies have been put elsewhere: what comes next begins there.
    pub fn place(&mut self, states: &[Body]) {
        self.before = states.iter().map(place).collect();
    }

    fn touches(&self, handle: RigidBodyHandle) -> bool {
        self.world.bodies[handle].colliders().iter().any(|&collider| {
            self.world.narrow_phase.contact_pairs_with(collider).any(|pair| pair.has_any_active_contact())
        })
    }
}

/// The axis of a body on a hinge, in the mesh's frame: the only one about which its inertia lets it turn.
fn axis(state: &Body) -> Option<Vec3> {
    let hangs = state.kind == Body::DYNAMIC && state.inverse_mass == 0.0;
    let inertia = state.inertia_matrix();
    let columns = [inertia.x_axis, inertia.y_axis, inertia.z_axis];
    let longest = columns.into_iter().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    longest.filter(|_| hangs).map(Vec3::normalize_or_zero)
}

fn insert(world: &mut PhysicsWorld, body: &LoadedBody, state: &Body) -> RigidBodyHandle {
    let builder = match state.kind {
        Body::DYNAMIC => RigidBodyBuilder::dynamic(),
        Body::SCRIPTED => RigidBodyBuilder::kinematic_position_based(),
        _ => RigidBodyBuilder::fixed(),
    };
    let builder = builder.pose(pose(state.position, state.rotation())).can_sleep(false);
    let handle = world.insert_body(builder);
    if let Some(axis) = axis(state) {
        let fixed = world.insert_body(RigidBodyBuilder::fixed().pose(pose(state.position, state.rotation())));
        world.insert_impulse_joint(fixed, handle, RevoluteJointBuilder::new(there(axis)));
    }
    let points: Vec<Vector> =
        body.solid.mesh.vertices.iter().map(|&v| there(Vec3::from(v) - state.center)).collect();
    let shape = if state.kind == Body::DYNAMIC {
        convex(&points, &body.solid.mesh.triangles, body.solid.mass.volume)
    } else {
        SharedShape::trimesh(points.clone(), body.solid.mesh.triangles.clone()).ok()
    };
    // A mesh of which no solid can be made, for rapier, is its ball; it has been accepted as a body before.
    let shape = shape.unwrap_or_else(|| SharedShape::ball(state.reach));
    // The mass is that of the shape for rapier, whatever its volume: contacts with equal masses look the same.
    let volume = shape.mass_properties(1.0).mass();
    let mass = if state.inverse_mass > 0.0 { 1.0 / state.inverse_mass } else { body.mass() };
    let density = if volume > 0.0 { mass / volume } else { 1.0 };
    let collider = ColliderBuilder::new(shape).density(density).friction(FRICTION).restitution(RESTITUTION);
    world.insert_collider(collider, Some(handle));
    handle
}

fn convex(points: &[Vector], triangles: &[[u32; 3]], volume: f32) -> Option<SharedShape> {
    let hull = hull(points)?;
    if hull.mass_properties(1.0).mass() <= HOLLOW * volume {
        return Some(hull);
    }
    let parts = SharedShape::convex_decomposition(points, triangles);
    let parts = parts.as_compound()?.shapes().iter().filter_map(|(place, part)| {
        let part = part.as_convex_polyhedron()?;
        Some((*place, self::hull(part.points())?))
    });
    let parts: Vec<_> = parts.collect();
    if parts.is_empty() { Some(hull) } else { Some(SharedShape::compound(parts)) }
}

/// The convex hull of the points that are farthest in some evenly spread directions. Of all points of a fine
/// mesh parry makes hulls whose slivers its contacts trip over; and a contact need not know a ball from one
/// with a hundred facets.
fn hull(points: &[Vector]) -> Option<SharedShape> {
    const DIRECTIONS: u32 = 256;
    let golden = std::f32::consts::PI * (3.0 - 5f32.sqrt());
    let mut kept: Vec<usize> = (0..DIRECTIONS)
        .filter_map(|k| {
            let y = 1.0 - 2.0 * (k as f32 + 0.5) / DIRECTIONS as f32;
            let (radius, angle) = ((1.0 - y * y).sqrt(), golden * k as f32);
            let direction = Vector::new(radius * angle.cos(), y, radius * angle.sin());
            (0..points.len()).max_by(|&a, &b| points[a].dot(direction).total_cmp(&points[b].dot(direction)))
        })
        .collect();
    kept.sort_unstable();
    kept.dedup();
    let mut corners: Vec<Vector> = Vec::new();
    let size = kept.iter().map(|&k| points[k].length()).fold(0.0, f32::max);
    for point in kept.into_iter().map(|k| points[k]) {
        if corners.iter().all(|corner| corner.distance(point) > 0.02 * size) {
            corners.push(point);
        }
    }
    SharedShape::convex_hull(&corners)
}

fn insert_box(world: &mut PhysicsWorld, domain: &Domain) {
    for axis in 0..3 {
        for (side, corner) in [domain.min, domain.max].into_iter().enumerate() {
            if domain.closed[axis][side] {
                let mut normal = Vec3::ZERO;
                normal[axis] = 1.0 - 2.0 * side as f32;
                let shape = SharedShape::halfspace(there(normal));
                let place = pose(corner, Quat::IDENTITY);
                let collider = ColliderBuilder::new(shape).position(place);
                world.insert_collider(collider.friction(FRICTION).restitution(RESTITUTION), None);
            }
        }
    }
}

/// Into rapier's vectors, which come from another release of the same crate.
fn there(v: Vec3) -> Vector {
    Vector::from_array(v.to_array())
}

fn here(v: Vector) -> Vec3 {
    Vec3::from_array(v.to_array())
}

fn pose(position: Vec3, rotation: Quat) -> Pose {
    Pose::from_parts(there(position), Rotation::from_array(rotation.to_array()))
}
