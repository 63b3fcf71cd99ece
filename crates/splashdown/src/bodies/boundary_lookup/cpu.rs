use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::BoundaryLookupBindings;
use crate::bodies::field;
use crate::bodies::types::{Body, Contact};
use crate::boundary::{Images, KernelPair, WallKernel};
use crate::kernel::Kernel;
use crate::state::{Params, StepCounters};

/// Particles per task. The particles of a chunk lie near one another, so that most bodies are far from all of them.
const CHUNK: usize = 128;

pub(super) fn boundary_lookup<K: Kernel + WallKernel>(buffers: BoundaryLookupBindings<'_>) {
    let BoundaryLookupBindings {
        params,
        cell_start,
        bodies,
        maps,
        sorted_positions: positions,
        contacts,
        counters,
    } = buffers;
    let n = cell_start[cell_start.len() - 2] as usize;
    let images = &Images::new(params);
    let corrections: u32 = positions[..n]
        .par_chunks_mut(CHUNK)
        .zip(contacts.par_chunks_mut(2 * CHUNK))
        .with_min_len(8)
        .map_init(Vec::new, |near: &mut Vec<usize>, (positions, contacts)| {
            find_near(bodies, positions, near);
            let pairs = contacts.as_chunks_mut::<2>().0;
            let mut corrections = 0;
            for (p, contacts) in positions.iter_mut().zip(pairs) {
                *contacts = [NO_CONTACT; 2];
                for &b in near.iter() {
                    insert(contacts, completed::<K>(params, images, bodies, maps, b, p.xyz()));
                }
                corrections += u32::from(move_outside(params, p, contacts));
            }
            corrections
        })
        .sum();
    counters[StepCounters::CORRECTIONS] += corrections;
}

const NO_CONTACT: Contact = Contact {
    slope: Vec3::ZERO,
    density: 0.0,
    normal: Vec3::ZERO,
    distance: 1e30,
    kernel_fraction: 0.0,
    effective: 1e30,
    body: Contact::NONE,
    unused: 0,
};

/// Collects the bodies in whose reach any of these particles may be, in their order.
fn find_near(bodies: &[Body], positions: &[Vec4], near: &mut Vec<usize>) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for p in positions {
        low = low.min(p.xyz());
        high = high.max(p.xyz());
    }
    near.clear();
    near.extend((0..bodies.len()).filter(|&b| {
        let closest = bodies[b].position.clamp(low, high);
        closest.distance_squared(bodies[b].position) < bodies[b].radius * bodies[b].radius
    }));
}

/// Inserts a contact if it is one of the two nearest.
#[inline]
fn insert(contacts: &mut [Contact; 2], contact: Contact) {
    let rank = |contact: &Contact| contact.distance.min(contact.effective);
    if rank(&contact) < rank(&contacts[0]) {
        contacts[1] = contacts[0];
        contacts[0] = contact;
    } else if rank(&contact) < rank(&contacts[1]) {
        contacts[1] = contact;
    }
}

/// Moves a particle that is inside a body towards its surface; true if it was inside.
#[inline]
fn move_outside(params: &Params, p: &mut Vec4, contacts: &[Contact; 2]) -> bool {
    let inside = contacts[0].distance.min(contacts[1].distance);
    if inside >= 0.0 {
        return false;
    }
    let deeper = if contacts[0].distance <= contacts[1].distance { &contacts[0] } else { &contacts[1] };
    let x = p.xyz() + (-inside).min(0.1 * params.particle_spacing) * deeper.normal;
    *p = x.clamp(params.domain_min, params.domain_max).extend(p.w);
    true
}

/// The contact with a body and its images behind walls. The image of a body that stands on a floor fills the kernel
/// below the floor. A body that reaches through the floor fills that part itself: so the body and its images fill at most
/// what a plane at its distance does.
#[inline]
fn completed<K: Kernel + WallKernel>(
    params: &Params,
    images: &Images,
    bodies: &[Body],
    maps: &[Vec2],
    b: usize,
    x: Vec3,
) -> Contact {
    let mut contact = contact_with::<K>(params, bodies, maps, b, x);
    if contact.body == Contact::NONE {
        return contact;
    }
    let support = params.support_radius;
    let most = contact.kernel_fraction.max(plane_through(K::WALLS, contact.distance / support).0);
    for by in images.near(x, x, support) {
        let image = contact_with::<K>(params, bodies, maps, b, by.sign * x + by.shift);
        if image.body == Contact::NONE || image.kernel_fraction <= 0.0 {
            continue;
        }
        let part = ((most - contact.kernel_fraction) / image.kernel_fraction).clamp(0.0, 1.0);
        if part > 0.0 {
            contact.kernel_fraction += part * image.kernel_fraction;
            contact.density += part * image.density;
            contact.slope += part * (by.sign * image.slope);
            contact.effective = support * q_of_fraction(K::WALLS, contact.kernel_fraction);
        }
    }
    contact
}

#[inline]
fn contact_with<K: Kernel + WallKernel>(
    params: &Params,
    bodies: &[Body],
    maps: &[Vec2],
    b: usize,
    x: Vec3,
) -> Contact {
    let body = &bodies[b];
    let away = x - body.position;
    if away.length_squared() >= body.radius * body.radius {
        return NO_CONTACT;
    }
    let rotation = body.rotation();
    let y = rotation.conjugate() * away + body.center;
    let support = params.support_radius;
    let Some(field) = field::at(body, maps, y, support) else { return NO_CONTACT };
    let length = field.distance_gradient.length().max(1e-6);
    let mut contact = Contact {
        body: b as u32,
        distance: field.distance,
        normal: rotation * (field.distance_gradient / length),
        ..NO_CONTACT
    };
    if body.way == Body::PARTICLES {
        let sum = field::sampled::<K>(body, maps, y, support);
        contact.kernel_fraction = sum.w.min(1.0);
        contact.density = contact.kernel_fraction;
        contact.slope = rotation * sum.xyz();
        contact.effective = support * q_of_fraction(K::WALLS, contact.kernel_fraction);
    } else {
        let (kernel_fraction, slope) = plane_through(K::WALLS, field.effective / support);
        contact.kernel_fraction = kernel_fraction;
        contact.slope = rotation * (slope / support * field.effective_gradient);
        contact.effective = field.effective;
        contact.density = density_through(K::WALLS, (field.effective + params.solid_offset) / support);
    }
    contact
}

/// (D, A) of a plane wall; q is negative behind the wall.
fn plane_through(kernels: KernelPair, q: f32) -> (f32, f32) {
    let (d, a) = if q.abs() < 1.0 { kernels.gradient(q.abs()) } else { (0.0, 0.0) };
    if q < 0.0 { (1.0 - d, a) } else { (d, a) }
}

fn density_through(kernels: KernelPair, q: f32) -> f32 {
    let d = if q.abs() < 1.0 { kernels.density(q.abs()).0 } else { 0.0 };
    if q < 0.0 { 1.0 - d } else { d }
}

/// The q at which a plane wall has this kernel fraction.
fn q_of_fraction(kernels: KernelPair, kernel_fraction: f32) -> f32 {
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..16 {
        let middle = 0.5 * (low + high);
        if plane_through(kernels, middle).0 > kernel_fraction { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
