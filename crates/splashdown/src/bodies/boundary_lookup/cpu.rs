use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::BoundaryLookupBindings;
use crate::bodies::field::{self, Interior};
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
    let around =
        &Around { params, images: Images::new(params), interior: Interior::new(params), bodies, maps };
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
                    insert(contacts, around.completed::<K>(b, p.xyz()));
                }
                around.limit::<K>(contacts);
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

/// The surroundings of all particles.
struct Around<'a> {
    params: &'a Params,
    images: Images,
    interior: Interior,
    bodies: &'a [Body],
    maps: &'a [Vec2],
}

impl Around<'_> {
    /// The contact with the part of a body inside the domain, and with the images of this part behind walls.
    #[inline]
    fn completed<K: Kernel + WallKernel>(&self, b: usize, x: Vec3) -> Contact {
        let contact = self.contact_with::<K>(b, x);
        if contact.body == Contact::NONE || self.bodies[b].is_complete != 0 {
            contact
        } else if self.bodies[b].way == Body::PARTICLES {
            self.completed_particles::<K>(contact, b, x)
        } else {
            self.completed_map::<K>(contact, b, x)
        }
    }

    /// The boundary particles inside the domain and their images.
    fn completed_particles<K: Kernel + WallKernel>(
        &self,
        mut contact: Contact,
        b: usize,
        x: Vec3,
    ) -> Contact {
        let support = self.params.support_radius;
        for by in self.images.near(x, x, support) {
            let image = self.contact_with::<K>(b, by.sign * x + by.shift);
            contact.kernel_fraction += image.kernel_fraction;
            contact.slope += by.sign * image.slope;
        }
        contact.kernel_fraction = contact.kernel_fraction.min(1.0);
        contact.density = contact.kernel_fraction;
        contact.effective = support * q_of_fraction(K::WALLS, contact.kernel_fraction);
        contact
    }

    /// A map does not tell where in the support the body is. A body that stands on a floor has an image which fills the
    /// kernel below the floor; a body that reaches through the floor fills that part itself. So the body and its images
    /// fill at most what a plane at its distance does. If the image of the particle is inside the body, the body fills
    /// the space of the images of the fluid: that part does not count.
    fn completed_map<K: Kernel + WallKernel>(&self, mut contact: Contact, b: usize, x: Vec3) -> Contact {
        let support = self.params.support_radius;
        let spacing = self.params.particle_spacing;
        let most = contact.kernel_fraction.max(plane_through(K::WALLS, contact.distance / support).0);
        let before = contact.kernel_fraction;
        for by in self.images.near(x, x, support) {
            let behind = by.sign * x + by.shift;
            let image = self.contact_with::<K>(b, behind);
            if image.body == Contact::NONE {
                continue;
            }
            let is_plane = by.sign.element_sum() > 0.5;
            let part = if is_plane && contact.distance > 0.0 && image.distance < 0.0 {
                let through = x.distance(behind);
                let beyond = -image.distance / (through - contact.distance).max(0.1 * spacing);
                let part = if 2.0 * contact.distance > through { 1.0 } else { beyond.clamp(0.0, 1.0) };
                contact.kernel_fraction -= part;
                contact.density -= part;
                part
            } else if image.kernel_fraction > 0.0 {
                ((most - contact.kernel_fraction) / image.kernel_fraction).clamp(0.0, 1.0)
            } else {
                0.0
            };
            contact.kernel_fraction += part * image.kernel_fraction;
            contact.density += part * image.density;
            contact.slope += part * (by.sign * image.slope);
        }
        if self.is_outside(&contact, x) || contact.kernel_fraction <= 0.0 {
            (contact.kernel_fraction, contact.density, contact.slope) = (0.0, 0.0, Vec3::ZERO);
        }
        contact.density = contact.density.max(0.0);
        if contact.kernel_fraction != before {
            contact.effective = support * q_of_fraction(K::WALLS, contact.kernel_fraction);
        }
        contact
    }

    /// Whether the surface of a body lies parallel to a wall and behind it.
    fn is_outside(&self, contact: &Contact, x: Vec3) -> bool {
        let distance = contact.distance - 1e-3 * self.params.particle_spacing;
        self.images.near(x, x, self.params.support_radius).any(|by| {
            let behind = by.sign * x + by.shift;
            let inwards = (x - behind).normalize_or_zero();
            by.sign.element_sum() > 0.5
                && inwards.dot(contact.normal) > 0.9
                && 2.0 * distance > x.distance(behind)
        })
    }

    /// Limits the parts of two bodies to their union, if their maps and boundary particles do not do so. The bodies fill
    /// at most what planes at their distances fill. Planes that face the same way contain one another; those at right
    /// angles overlap by the product of their parts; those that face one another do not overlap.
    fn limit<K: Kernel + WallKernel>(&self, contacts: &mut [Contact; 2]) {
        let [first, second] = contacts;
        let is_static = |contact: &Contact| self.bodies[contact.body as usize].kind == Body::STATIC;
        if second.body == Contact::NONE || (is_static(first) && is_static(second)) {
            return;
        }
        let support = self.params.support_radius;
        let plane = |contact: &Contact| {
            plane_through(K::WALLS, contact.distance / support).0.max(contact.kernel_fraction)
        };
        let (one, two) = (plane(first), plane(second));
        let cosine = first.normal.dot(second.normal);
        let across = one * two;
        let both =
            if cosine > 0.0 { across + cosine * (one.min(two) - across) } else { (1.0 + cosine) * across };
        let room = one + two - both - first.kernel_fraction;
        if second.kernel_fraction > room {
            let part = (room / second.kernel_fraction).max(0.0);
            second.kernel_fraction *= part;
            second.density *= part;
            second.slope *= part;
            second.effective = support * q_of_fraction(K::WALLS, second.kernel_fraction);
        }
    }

    #[inline]
    fn contact_with<K: Kernel + WallKernel>(&self, b: usize, x: Vec3) -> Contact {
        let &Self { params, ref interior, bodies, maps, .. } = self;
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
            let sum = field::sampled::<K>(body, maps, y, support, interior);
            contact.kernel_fraction = sum.w.min(1.0);
            contact.density = contact.kernel_fraction;
            contact.slope = rotation * sum.xyz();
            contact.effective = support * q_of_fraction(K::WALLS, contact.kernel_fraction);
        } else {
            let (effective, gradient) = if params.is_implicit == 1 {
                field::effective_at(body, maps, y)
            } else {
                (field.effective, field.effective_gradient)
            };
            let (stretched, steepness) = stretched_distance(params, effective);
            let (_, slope) = plane_through(K::WALLS, (stretched + params.slope_offset) / support);
            contact.kernel_fraction = plane_through(K::WALLS, effective / support).0;
            contact.slope = rotation * (steepness * slope / support * gradient);
            contact.effective = effective;
            contact.density = density_through(K::WALLS, (stretched + params.solid_offset) / support);
        }
        contact
    }
}

/// The distance of [`SolidDistance`](crate::boundary::SolidDistance) without its offsets, and its derivative.
#[inline]
fn stretched_distance(params: &Params, distance: f32) -> (f32, f32) {
    let beyond = distance - params.stretched_from();
    if beyond > 0.0 {
        (distance + (params.solid_stretch - 1.0) * beyond, params.solid_stretch)
    } else {
        (distance, 1.0)
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::WendlandBlend;
    use crate::scene::Scene;

    /// The gradient that forces use is the derivative of the density, on both sides of the distance from which it is
    /// stretched and behind the surface.
    #[test]
    fn the_gradient_of_a_body_is_the_derivative_of_its_density() {
        const TEXT: &str = "[scene]\nname = \"x\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[fluid]\n\
                            particle_spacing = 0.05\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, 0.5, 1]\n[solver]\n";
        let largest_error = |solver: &str| {
            let params = crate::schemes::params(&Scene::parse(&format!("{TEXT}{solver}"), "x").unwrap(), 1);
            let (spacing, support) = (params.particle_spacing, params.support_radius);
            let density = |d: f32| {
                let (stretched, _) = stretched_distance(&params, d);
                density_through(WendlandBlend::WALLS, (stretched + params.solid_offset) / support)
            };
            let distances = (-8..38).map(|i| (0.05 * i as f32 + 0.02) * spacing);
            let errors = distances.map(|d| {
                let (stretched, steepness) = stretched_distance(&params, d);
                let q = (stretched + params.slope_offset) / support;
                let slope = steepness * plane_through(WendlandBlend::WALLS, q).1 / support;
                let step = 0.01 * spacing;
                ((density(d - step) - density(d + step)) / (2.0 * step) - slope).abs() * support
            });
            errors.fold(0.0, f32::max)
        };
        assert!(largest_error("method = \"dfsph\"") < 0.01);
        assert!(largest_error("method = \"wcsph\"") > 0.1, "negative control");
    }
}
