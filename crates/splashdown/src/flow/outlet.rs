//! The outlet of an emitter on the host: the lattice of a layer, the nozzle behind it, and the number of particles.

use glam::{Vec2, Vec3, Vec4};

use super::Nozzle;
use crate::bodies::{BodyError, closed_solid, owner};
pub use crate::scene::outlet::{axes, disc_layer, rectangle_layer};
use crate::scene::{Domain, Emitter, MeshSource, Outlet, Scene};
use crate::solid::Solid;

/// More particles than any scene emits, and small enough that sums do not overflow.
const UNLIMITED: u32 = u32::MAX / 2;

/// Shifts the points of a layer forward, each by its own fraction of `depth` (m). The distances between columns do not
/// change, and a jet that gravity stretches thins evenly instead of separating into discs. The fractions are those of
/// Roberts' sequence R2 on the lattice, which differ strongly between neighbours.
pub fn staggered(layer: &[Vec2], spacing: f32, depth: f32) -> Vec<Vec4> {
    const PLASTIC: f32 = 1.324_718;
    let fraction = |q: &Vec2| {
        let place = (*q / spacing + 0.25).floor();
        (place.x / PLASTIC + place.y / (PLASTIC * PLASTIC)).rem_euclid(1.0)
    };
    layer.iter().map(|q| q.extend(depth * fraction(q)).extend(0.0)).collect()
}

/// The depth in m by which a layer is staggered: a spacing for a jet straight down, and zero for one that gravity does
/// not stretch, whose layers may have to enter fluid at rest as a whole.
pub fn stagger(direction: Vec3, gravity: Vec3, spacing: f32) -> f32 {
    spacing * direction.dot(gravity.normalize_or_zero()).clamp(0.0, 1.0)
}

/// The points of a square lattice along [`axes`] that lie in the cross-section of the mesh at the outlet, at least half
/// a spacing from its rim. Four lattices are tried, which differ in their position relative to the centre; the one whose
/// points represent the area best is used.
fn mesh_layer(emitter: &Emitter, source: &MeshSource, solid: &Solid, spacing: f32) -> Vec<Vec2> {
    const FINER: i32 = 4;
    let (across, up) = axes(emitter.direction);
    let reach = solid.mesh.vertices.iter().map(|v| Vec3::from(*v).length()).fold(0.0, f32::max);
    let inside = |q: Vec2| {
        let offset = q.x * across + q.y * up;
        solid.contains(source.rotation.conjugate() * offset)
    };
    let lattice = |distance: f32, shift: Vec2| {
        let n = (reach / distance).ceil() as i32;
        let points = (-n..=n).flat_map(move |j| (-n..=n).map(move |i| Vec2::new(i as f32, j as f32)));
        points.map(move |q| distance * (q + shift))
    };
    // The area of the cross-section in squares of the spacing, by counting finer cells.
    let fine = lattice(spacing / FINER as f32, Vec2::splat(0.5)).filter(|q| inside(*q)).count();
    let wanted = fine as f32 / (FINER * FINER) as f32;
    let off_rim = |q: Vec2| {
        let rim =
            (0..8).map(|k| Vec2::from_angle(std::f32::consts::FRAC_PI_4 * k as f32) * (0.499 * spacing));
        inside(q) && rim.into_iter().all(|offset| inside(q + offset))
    };
    let shifts = [Vec2::ZERO, Vec2::splat(0.5), Vec2::new(0.5, 0.0), Vec2::new(0.0, 0.5)];
    let layers = shifts.map(|shift| lattice(spacing, shift).filter(|q| off_rim(*q)).collect::<Vec<_>>());
    let error = |layer: &Vec<Vec2>| (layer.len() as f32 - wanted).abs();
    layers.into_iter().min_by(|a, b| error(a).total_cmp(&error(b))).unwrap_or_default()
}

/// The nozzle of an emitter, with `first_point` not yet set, and its layer, not yet [`staggered`].
///
/// # Errors
/// [`BodyError`] of the outlet's mesh, which must be closed.
pub fn nozzle(emitter: &Emitter, scene: &Scene) -> Result<(Nozzle, Vec<Vec2>), BodyError> {
    let spacing = scene.fluid.particle_spacing;
    let support_radius = scene.solver.support_radius(spacing);
    nozzle_in(emitter, &scene.domain, spacing, support_radius)
}

/// As [`nozzle`], for a scene that is not complete yet.
pub(crate) fn nozzle_in(
    emitter: &Emitter,
    domain: &Domain,
    spacing: f32,
    support_radius: f32,
) -> Result<(Nozzle, Vec<Vec2>), BodyError> {
    let (across, up) = axes(emitter.direction);
    let half = |layer: &[Vec2]| {
        layer.iter().fold(Vec2::ZERO, |most, q| most.max(q.abs())) + Vec2::splat(0.5 * spacing)
    };
    let (layer, disc, half) = match &emitter.outlet {
        Outlet::Disc { radius } => {
            let layer = disc_layer(*radius, spacing);
            let widest = layer.iter().map(|q| q.length()).fold(0.0, f32::max);
            (layer, 1, Vec2::splat(radius.max(widest + 0.5 * spacing)))
        }
        Outlet::Rectangle { size } => {
            let layer = rectangle_layer(*size, spacing);
            let half = half(&layer);
            (layer, 0, half)
        }
        Outlet::Mesh(source) => {
            let owner = owner("emitter", &emitter.name, source);
            let solid = closed_solid(&owner, source, domain, spacing)?;
            let layer = mesh_layer(emitter, source, &solid, spacing);
            if layer.is_empty() {
                return Err(BodyError::Outline { owner, spacing });
            }
            let half = half(&layer);
            (layer, 0, half)
        }
    };
    let length = support_radius + spacing;
    let start = emitter.position - length * emitter.direction;
    let back = start + emitter.direction * forward(domain, start, emitter, &layer, length, spacing);
    let nozzle = Nozzle {
        back,
        speed: emitter.speed,
        direction: emitter.direction,
        length,
        across,
        start: emitter.start,
        up,
        end: emitter.end.unwrap_or(f32::MAX),
        half_across: half.x,
        half_up: half.y,
        first_point: 0,
        points: layer.len() as u32,
        most: emitter.max_particles.unwrap_or(UNLIMITED).min(UNLIMITED),
        disc,
        unused: glam::UVec2::ZERO,
    };
    Ok((nozzle, layer))
}

/// The distance in m by which a nozzle is moved forward so that its back face is inside the domain: the nozzle of an
/// outlet in a wall lies in front of the wall.
fn forward(domain: &Domain, back: Vec3, emitter: &Emitter, layer: &[Vec2], length: f32, spacing: f32) -> f32 {
    let (across, up) = axes(emitter.direction);
    let (low, high) = (domain.min + 0.5 * spacing, domain.max - 0.5 * spacing);
    let fits = |shift: f32| {
        layer.iter().all(|q| {
            let x = back + shift * emitter.direction + q.x * across + q.y * up;
            x.cmpge(low - 1e-3 * spacing).all() && x.cmple(high + 1e-3 * spacing).all()
        })
    };
    let steps = (4.0 * length / spacing).ceil() as u32 + 2;
    (0..=steps).map(|k| 0.25 * spacing * k as f32).find(|&shift| fits(shift)).unwrap_or(0.0)
}

/// The number of particles that a nozzle creates until `duration` (s), plus one layer.
pub fn expected(nozzle: &Nozzle, duration: f32, spacing: f32) -> u64 {
    let active = (nozzle.end.min(duration) - nozzle.start).max(0.0);
    if active == 0.0 {
        return 0;
    }
    let layers = (f64::from(nozzle.speed) * f64::from(active) / f64::from(spacing)).ceil() as u64 + 1;
    layers.saturating_mul(u64::from(nozzle.points)).min(u64::from(nozzle.most))
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;
    use crate::scene::{MeshShape, UpAxis};

    #[test]
    fn layers_fill_the_outlet_up_to_half_a_spacing_from_the_rim() {
        for radius in [0.02, 0.03, 0.05, 0.083] {
            let layer = disc_layer(radius, 0.01);
            let area = std::f32::consts::PI * radius * radius;
            assert!(layer.iter().all(|q| q.length() <= radius - 0.0049), "{radius}");
            let filled = layer.len() as f32 * 1e-4 / area;
            assert!((0.5..1.15).contains(&filled), "{radius}: {filled}");
        }
        assert_eq!(disc_layer(0.001, 0.01), [Vec2::ZERO]);
        let layer = rectangle_layer([0.04, 0.03], 0.01);
        assert_eq!(layer.len(), 12);
        assert!(layer.iter().all(|q| q.x.abs() < 0.0151 && q.y.abs() < 0.0101));
    }

    #[test]
    fn an_outlet_of_a_mesh_is_its_cross_section_for_any_thickness() {
        let source = |scale: f32| MeshSource {
            shape: MeshShape::Model("cube".into()),
            scale: Vec3::splat(scale),
            up: UpAxis::Y,
            position: Vec3::ZERO,
            rotation: Quat::IDENTITY,
        };
        let emitter = Emitter {
            name: "tap".into(),
            outlet: Outlet::Mesh(source(0.1)),
            position: Vec3::splat(0.5),
            direction: Vec3::NEG_Y,
            speed: 1.0,
            start: 0.0,
            end: None,
            max_particles: None,
        };
        let domain = Domain { min: Vec3::ZERO, max: Vec3::ONE, closed: [[true; 2]; 3], oscillation: None };
        // A square whose edge is an even or odd number of spacings is filled to its rim.
        for (spacing, count) in [(0.01, 100), (0.02, 25)] {
            let (nozzle, layer) = nozzle_in(&emitter, &domain, spacing, 2.0 * spacing).unwrap();
            assert_eq!((layer.len(), nozzle.points), (count, count as u32), "{spacing}");
            assert!(layer.iter().all(|q| q.abs().max_element() < 0.05 - 0.49 * spacing));
        }
        // The gear is 0.22 m wide at this scale. Its layer has no points in the bore and between the teeth.
        let gear = MeshSource {
            shape: MeshShape::Model("gear".into()),
            rotation: Quat::from_rotation_x(std::f32::consts::FRAC_PI_2),
            ..source(0.5)
        };
        let (_, layer) =
            nozzle_in(&Emitter { outlet: Outlet::Mesh(gear), ..emitter }, &domain, 0.01, 0.02).unwrap();
        let area = layer.len() as f32 * 1e-4;
        assert!((0.5..0.8).contains(&(area / (std::f32::consts::PI * 0.1 * 0.1))), "{area}");
        assert!(layer.iter().all(|q| q.length() > 0.01));
    }

    #[test]
    fn only_downward_outlets_are_staggered() {
        let gravity = Vec3::new(0.0, -9.81, 0.0);
        let depth = |direction| stagger(direction, gravity, 0.01);
        assert_eq!([Vec3::NEG_Y, Vec3::Y, Vec3::X].map(depth), [0.01, 0.0, 0.0]);
        assert_eq!(stagger(Vec3::NEG_Y, Vec3::ZERO, 0.01), 0.0);
    }

    #[test]
    fn neighbours_in_a_layer_are_emitted_at_different_depths() {
        for layer in [disc_layer(0.083, 0.01), rectangle_layer([0.08, 0.05], 0.01)] {
            let points = staggered(&layer, 0.01, 0.01);
            assert!(points.iter().zip(&layer).all(|(p, q)| p.x == q.x && p.y == q.y));
            assert!(points.iter().all(|p| (0.0..0.01).contains(&p.z)));
            let mut pairs = 0;
            for a in &points {
                for b in points.iter().filter(|b| (a.x - b.x).hypot(a.y - b.y) < 0.0101 && *b != a) {
                    let apart = (a.z - b.z).rem_euclid(0.01);
                    assert!(apart.min(0.01 - apart) > 0.0024, "{a} and {b}");
                    pairs += 1;
                }
            }
            assert!(pairs > 2 * layer.len(), "{pairs}");
            assert!(staggered(&layer, 0.01, 0.0).iter().all(|p| p.z == 0.0));
        }
    }

    #[test]
    fn axes_are_right_handed_and_unit() {
        for d in [Vec3::X, Vec3::Y, -Vec3::Y, Vec3::new(1.0, -2.0, 0.5).normalize_or_zero()] {
            let (across, up) = axes(d);
            assert!((across.cross(up) - d).length() < 1e-6 || (d.cross(across) - up).length() < 1e-6);
            assert!(across.dot(d).abs() < 1e-6 && across.y.abs() < 1e-6);
        }
    }
}
