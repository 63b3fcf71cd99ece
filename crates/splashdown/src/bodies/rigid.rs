//! Collisions of bodies with one another and with the domain, by `rapier3d`.
//!
//! *How it works.* The device moves every body in every step without collisions. After a batch of steps the host
//! repeats the motion in rapier: each body starts at its position before the batch and has the mean velocity that
//! leads to its position on the device. Without a contact rapier arrives at the same position, and its result is
//! discarded, so that bodies without contacts are unchanged. With a contact the positions of rapier are used, and the
//! change of the mean velocity is added to the velocity on the device.
//!
//! *Why not* rapier for all motion: the force of the fluid changes in every step, and a round trip to the host in
//! every step is too slow.
//!
//! A dynamic body collides as a ball if it is one, as its convex hull if their volumes are nearly equal, and as a
//! convex decomposition otherwise. Static and scripted bodies collide as triangle meshes. Only the corners of a dynamic body
//! collide with the sides of the domain: parry tests four corners of the nearest face against a plane, on which a prism
//! with more corners would tip over into the floor.

use glam::{Quat, Vec3, Vec4};
use rapier3d::geometry::NEW_CONTACT_BIT;
use rapier3d::math::Matrix;
use rapier3d::prelude::{
    ActiveHooks, CoefficientCombineRule, ColliderBuilder, ContactModificationContext, Group,
    InteractionGroups, InteractionTestMode, MassProperties, PhysicsHooks, PhysicsWorld, Pose, RigidBody,
    RigidBodyBuilder, RigidBodyHandle, Rotation, SharedShape, Vector,
};
use serde::{Deserialize, Serialize};

use super::load::LoadedBody;
use super::support::spread;
use super::types::{Body, Support};
use crate::scene::Domain;

/// The coefficient of friction of the domain's sides. It is larger than that of any body, so that the smaller one is that
/// of the body.
const WALL_FRICTION: f32 = 1e3;
/// The coefficient of restitution of the domain's sides, chosen likewise.
const WALL_RESTITUTION: f32 = 1.0;
/// The natural frequency of contacts in Hz; rapier's is 30, and 60 at what does not move. A contact yields under its load
/// like a spring, so that light boxes under water sank into one another, and a dry stack crept.
const STIFFNESS: f32 = 1000.0;
/// The ratio of volumes above which a convex hull does not represent a body, because the body has a cavity.
const HOLLOW: f32 = 1.1;

/// The representation of the bodies in rapier.
#[derive(Serialize, Deserialize)]
pub(crate) struct Rigid {
    world: PhysicsWorld,
    /// The handles of the bodies, in the order of the scene.
    handles: Vec<RigidBodyHandle>,
    /// Their positions and rotations after the last batch.
    before: Vec<Place>,
}

/// A position in m and a rotation, a quaternion.
type Place = ([f32; 3], [f32; 4]);

fn place(state: &Body) -> Place {
    (state.position.to_array(), state.rotation().to_array())
}

impl Rigid {
    /// `None` if there is no dynamic body.
    pub fn new(loaded: &[LoadedBody], states: &[Body], domain: &Domain) -> Option<Self> {
        if !states.iter().any(|body| body.kind == Body::DYNAMIC) {
            return None;
        }
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::ZERO;
        let smallest = states.iter().filter(|body| body.kind == Body::DYNAMIC).map(|body| body.reach);
        world.integration_parameters.length_unit = smallest.fold(f32::INFINITY, f32::min).max(1e-6);
        world.integration_parameters.contact_softness.natural_frequency = STIFFNESS;
        world.integration_parameters.static_contact_softness.natural_frequency = STIFFNESS;
        // With the default of 4, 1 and 1 a box at rest crept over a level floor at 3 mm/s, in the order in which its corners
        // are solved.
        world.integration_parameters.num_solver_iterations = 8;
        world.integration_parameters.num_internal_pgs_iterations = 8;
        world.integration_parameters.num_internal_stabilization_iterations = 4;
        let handles =
            loaded.iter().zip(states).map(|(body, state)| insert(&mut world, body, state)).collect();
        insert_box(&mut world, domain);
        let before = states.iter().map(place).collect();
        Some(Self { world, handles, before })
    }

    /// Applies the collisions of the last `seconds` to the states. Returns true if there were any.
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
                body.set_linvel(to_rapier(velocity), true);
                body.set_angvel(to_rapier(spin), true);
            } else if state.kind == Body::SCRIPTED {
                body.set_next_kinematic_position(pose(state.position, state.rotation()));
            }
        }
        self.world.integration_parameters.dt = seconds;
        self.world.step_with_events(&Levers, &());
        let mut collided = false;
        for (b, state) in states.iter_mut().enumerate() {
            let handle = self.handles[b];
            let body = &self.world.bodies[handle];
            if state.kind == Body::DYNAMIC && self.touches(handle) {
                collided = true;
                let (velocity, spin) = means[b];
                let axis = axis(state).map(|axis| state.rotation() * axis);
                let mut change = Vec3::ZERO;
                if axis.is_none() {
                    state.position = from_rapier(body.position().translation);
                    change = from_rapier(body.linvel()) - velocity;
                    state.velocity += change;
                }
                let [x, y, z, w] = body.position().rotation.to_array();
                state.orientation = Vec4::new(x, y, z, w).normalize_or(state.orientation);
                let turn = from_rapier(body.angvel()) - spin;
                let turn = axis.map_or(turn, |axis| axis.dot(turn) * axis);
                state.angular_velocity += turn;
                // The motion pass took the work of a body that nothing holds.
                state.work -= 0.5 * seconds * (state.force.dot(change) + state.torque.dot(turn));
            }
            self.before[b] = place(state);
        }
        collided
    }

    /// Sets the positions from which the next batch starts, after bodies were moved by other means.
    pub fn place(&mut self, states: &[Body]) {
        self.before = states.iter().map(place).collect();
    }

    /// The contacts that carried a load in the last batch, [`SUPPORTS`](super::types::SUPPORTS) per body; empty if there is none.
    pub fn supports(&self, states: &[Body]) -> Vec<Support> {
        let of_body = |(state, &handle): (&Body, &RigidBodyHandle)| {
            if state.kind == Body::DYNAMIC { self.loaded_contacts(handle) } else { Vec::new() }
        };
        let contacts: Vec<Vec<Support>> = states.iter().zip(&self.handles).map(of_body).collect();
        if contacts.iter().all(Vec::is_empty) {
            return Vec::new();
        }
        contacts.into_iter().zip(states).flat_map(|(of_body, state)| spread(of_body, state.reach)).collect()
    }

    /// The contacts of a dynamic body whose impulses were not zero. Near its hinge a contact cannot hold a body.
    fn loaded_contacts(&self, handle: RigidBodyHandle) -> Vec<Support> {
        let own = &self.world.bodies[handle];
        let colliders = own.colliders();
        let pairs = colliders.iter().flat_map(|&own| self.world.narrow_phase.contact_pairs_with(own));
        let manifolds = pairs.flat_map(|pair| pair.solver_manifolds());
        let mut contacts = Vec::new();
        for manifold in manifolds {
            let data = &manifold.data;
            // The normal points from the first body to the second.
            let is_first = data.rigid_body1 == Some(handle);
            let other = if is_first { data.rigid_body2 } else { data.rigid_body1 };
            let other = other.map(|other| &self.world.bodies[other]);
            let normal = from_rapier(if is_first { -data.normal } else { data.normal });
            // Other points may still have the impulses of earlier steps.
            let solved = data.solver_contacts.iter().map(|contact| contact.contact_id[0] & !NEW_CONTACT_BIT);
            let points = solved.filter_map(|index| Some(&manifold.points.get(index as usize)?.data));
            for point in points.filter(|point| point.impulse > 0.0) {
                let [arm, other_arm] = if is_first {
                    [point.solver_dp1, point.solver_dp2]
                } else {
                    [point.solver_dp2, point.solver_dp1]
                };
                if !can_move(Some(own), own.translation() + arm, data.normal) {
                    continue;
                }
                let min_speed = other.map_or(0.0, |other| {
                    let speed = from_rapier(other.linvel())
                        + from_rapier(other.angvel()).cross(from_rapier(other_arm));
                    speed.dot(normal)
                });
                contacts.push(Support { normal, min_speed, arm: from_rapier(arm), impulse: 0.0 });
            }
        }
        contacts
    }

    fn touches(&self, handle: RigidBodyHandle) -> bool {
        self.world.bodies[handle].colliders().iter().any(|&collider| {
            self.world.narrow_phase.contact_pairs_with(collider).any(|pair| pair.has_any_active_contact())
        })
    }
}

/// The axis of a hinged body in the mesh's frame: the only axis about which its inertia allows rotation.
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
    // Contacts are found before bodies overlap, so that the motion of a step ends at the surface.
    let mut builder = builder
        .pose(pose(state.position, state.rotation()))
        .can_sleep(false)
        .soft_ccd_prediction(0.5 * state.reach);
    if state.kind == Body::DYNAMIC {
        // Not those of the shape, which may have another volume.
        builder = builder
            .additional_mass_properties(mass_properties(state))
            .user_data(state.reach.to_bits().into());
    }
    let handle = world.insert_body(builder);
    let points: Vec<Vector> =
        body.solid.mesh.vertices.iter().map(|&v| to_rapier(Vec3::from(v) - state.center)).collect();
    let hooks =
        if axis(state).is_some() { ActiveHooks::MODIFY_SOLVER_CONTACTS } else { ActiveHooks::empty() };
    let collide = |world: &mut PhysicsWorld, shape, groups| {
        let collider = ColliderBuilder::new(shape).density(0.0).collision_groups(groups).active_hooks(hooks);
        let collider = collider.friction(body.contact.friction).restitution(body.contact.restitution);
        world.insert_collider(collider, Some(handle));
    };
    if state.kind != Body::DYNAMIC {
        let mesh = SharedShape::trimesh(points, body.solid.mesh.triangles.clone());
        collide(world, mesh.unwrap_or_else(|_| SharedShape::ball(state.reach)), between(BODIES, BODIES));
        return handle;
    }
    let volume = body.solid.mass.volume;
    if let Some(hull) = hull(&points).filter(|_| ball(&points, volume).is_none()) {
        let corners = corners_of(&hull, state.reach);
        let shape = convex(hull, &points, &body.solid.mesh.triangles, volume);
        collide(world, shape, between(BODIES, BODIES));
        collide(world, corners, between(CORNERS, WALLS));
    } else {
        // If rapier cannot use the mesh, the body collides as its bounding ball.
        let ball = ball(&points, volume).unwrap_or_else(|| SharedShape::ball(state.reach));
        collide(world, ball, between(BODIES | CORNERS, BODIES | WALLS));
    }
    handle
}

/// The groups of the colliders: shapes of bodies, their corners, and the sides of the domain.
const BODIES: Group = Group::GROUP_1;
const CORNERS: Group = Group::GROUP_2;
const WALLS: Group = Group::GROUP_3;

/// The collider is in the first group, and collides with those in the second.
fn between(own: Group, others: Group) -> InteractionGroups {
    InteractionGroups::new(own, others, InteractionTestMode::And)
}

/// Drops the contacts that no body can move out of: between a hinged body, near whose hinge their normal passes, and one that
/// does not move freely. To end an overlap of such a contact, rapier turned the body by 143 degrees in 0.06 s, which threw
/// another one away.
struct Levers;

/// The smallest arm of a contact about the hinge, over the reach of the body.
const SMALLEST_LEVER: f32 = 0.25;

impl PhysicsHooks for Levers {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext<'_>) {
        let bodies = context.bodies;
        let [first, second] = [context.rigid_body1, context.rigid_body2].map(|handle| bodies.get(handle?));
        let Some(manifold) = context.rigid_mut() else { return };
        let normal = *manifold.normal;
        manifold.solver_contacts.retain(|contact| {
            can_move(first, contact.anchor1, normal) || can_move(second, contact.anchor2, normal)
        });
    }
}

/// Whether a body can move along the normal of a contact at a point.
fn can_move(body: Option<&RigidBody>, point: Vector, normal: Vector) -> bool {
    let Some(body) = body.filter(|body| body.is_dynamic()) else { return false };
    let mass = body.mass_properties().local_mprops;
    if mass.inv_mass > 0.0 {
        return true;
    }
    let axis = body.rotation() * (mass.principal_inertia_local_frame * Vector::Z);
    let lever = (point - body.translation()).cross(normal).dot(axis);
    lever.abs() >= SMALLEST_LEVER * f32::from_bits(body.user_data as u32)
}

/// The mass of a dynamic body, and its inertia about its position. As on the device, a hinged body has infinite inertia in all
/// directions but the hinge's, which zeros stand for: with a joint instead, an elastic impact more than doubled its energy.
fn mass_properties(state: &Body) -> MassProperties {
    if let Some(axis) = axis(state) {
        let inertia = Vector::new(0.0, 0.0, state.inertia.element_sum());
        let frame = Rotation::from_rotation_arc(Vector::Z, to_rapier(axis));
        return MassProperties::with_principal_inertia_frame(Vector::ZERO, 0.0, inertia, frame);
    }
    // Of order one: the decomposition takes moments of small bodies for equal.
    let scale = state.inertia.element_sum();
    let unit = Matrix::from_cols_array(&(state.inertia_matrix() / scale).to_cols_array());
    let unit = MassProperties::with_inertia_matrix(Vector::ZERO, 1.0, unit);
    let (moments, frame) = (unit.principal_inertia() * scale, unit.principal_inertia_local_frame);
    MassProperties::with_principal_inertia_frame(Vector::ZERO, 1.0 / state.inverse_mass, moments, frame)
}

/// Small balls in the corners of a hull, for contacts with planes. The reach is the largest distance of a corner.
fn corners_of(hull: &SharedShape, reach: f32) -> SharedShape {
    let radius = 1e-3 * reach;
    let corners = hull.as_convex_polyhedron().map_or(&[][..], |hull| hull.points());
    let middle = corners.iter().copied().sum::<Vector>() / corners.len().max(1) as f32;
    let ball = |&corner: &Vector| {
        let inside = (middle - corner).normalize_or_zero() * radius;
        (Pose::from_parts(corner + inside, Rotation::IDENTITY), SharedShape::ball(radius))
    };
    SharedShape::compound(corners.iter().map(ball).collect())
}

/// A ball, if the mesh is a sphere. A hull would collide with its facets, whose normals miss the centre.
fn ball(points: &[Vector], volume: f32) -> Option<SharedShape> {
    /// The largest deviation from the volume and, of any point, from the radius.
    const DEVIATION: f32 = 0.02;
    let middle = points.iter().copied().sum::<Vector>() / points.len().max(1) as f32;
    let radius = (0.75 / std::f32::consts::PI * volume).cbrt();
    let near = |x: f32, y: f32| (x - y).abs() <= DEVIATION * y;
    let is_sphere = points.iter().all(|&x| near(x.distance(middle), radius));
    let place = Pose::from_parts(middle, Rotation::IDENTITY);
    is_sphere.then(|| SharedShape::compound(vec![(place, SharedShape::ball(radius))]))
}

/// The hull, or a convex decomposition of the mesh if their volumes differ.
fn convex(hull: SharedShape, points: &[Vector], triangles: &[[u32; 3]], volume: f32) -> SharedShape {
    if hull.mass_properties(1.0).mass() <= HOLLOW * volume {
        return hull;
    }
    let parts = SharedShape::convex_decomposition(points, triangles);
    let parts =
        parts.as_compound().map_or(&[][..], |parts| parts.shapes()).iter().filter_map(|(place, part)| {
            let part = part.as_convex_polyhedron()?;
            Some((*place, self::hull(part.points())?))
        });
    let parts: Vec<_> = parts.collect();
    if parts.is_empty() { hull } else { SharedShape::compound(parts) }
}

/// The convex hull of the farthest points in evenly distributed directions. From all points of a fine mesh parry
/// makes hulls with slivers, on which its contacts fail. A hull of a few hundred points is accurate enough for
/// contacts.
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
                let shape = SharedShape::halfspace(to_rapier(normal));
                let place = pose(corner, Quat::IDENTITY);
                let collider = ColliderBuilder::new(shape).position(place);
                let collider = collider
                    .friction(WALL_FRICTION)
                    .friction_combine_rule(CoefficientCombineRule::Min)
                    .restitution(WALL_RESTITUTION)
                    .restitution_combine_rule(CoefficientCombineRule::Min)
                    .collision_groups(between(WALLS, CORNERS));
                world.insert_collider(collider, None);
            }
        }
    }
}

/// Converts to the vectors of rapier, which come from another release of glam.
fn to_rapier(v: Vec3) -> Vector {
    Vector::from_array(v.to_array())
}

fn from_rapier(v: Vector) -> Vec3 {
    Vec3::from_array(v.to_array())
}

fn pose(position: Vec3, rotation: Quat) -> Pose {
    Pose::from_parts(to_rapier(position), Rotation::from_array(rotation.to_array()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parry takes moments whose differences have a product below 1e-10 for equal.
    #[test]
    fn small_bodies_keep_their_axes() {
        for size in [1.0, 0.05, 0.002] {
            for slender in Vec3::AXES {
                // A stick of 1,000 kg/m^3, ten times as long as wide.
                let mass = 1000.0 * size * 0.01 * size * size;
                let about =
                    |axis: Vec3| mass * size * size / 12.0 * if axis == slender { 0.02 } else { 1.01 };
                let inertia = Vec3::from_array(Vec3::AXES.map(about));
                let state = Body {
                    kind: Body::DYNAMIC,
                    inverse_mass: 1.0 / mass,
                    inertia,
                    ..bytemuck::Zeroable::zeroed()
                };
                let properties = mass_properties(&state);
                let frame = properties.principal_inertia_local_frame;
                for axis in Vec3::AXES {
                    let own = frame.inverse() * to_rapier(axis);
                    let moment = (properties.principal_inertia() * own).dot(own);
                    let expected = about(axis);
                    assert!(
                        (moment / expected - 1.0).abs() < 1e-3,
                        "{size} {slender} {axis}: {moment} of {expected}"
                    );
                }
            }
        }
    }
}
