//! An emitter's outlet on the host: axes, the lattice of a layer, the nozzle behind it, and how much it will make.

use glam::{Vec2, Vec3};

use super::Nozzle;
use crate::bodies::{BodyError, mesh_of};
use crate::boundary::KernelPair;
use crate::scene::{Domain, Emitter, MeshSource, Outlet, Scene};
use crate::solid::{self, Solid, SolidSettings};

/// More than any scene makes, and small enough to be added to.
const UNLIMITED: u32 = u32::MAX / 2;

/// The horizontal unit vector across a direction (x where the direction is vertical), and the third one.
pub fn axes(direction: Vec3) -> (Vec3, Vec3) {
    let across = Vec3::Y.cross(direction);
    let across = if across.length_squared() < 1e-6 { Vec3::X } else { across.normalize_or_zero() };
    (across, direction.cross(across))
}

/// A layer: points in m along [`axes`], on a square lattice of `spacing` that keeps half a spacing off the rim. Of the lattice with a
/// point in the middle and that with a square there, the one whose points make up the outlet's area better is taken.
pub fn disc_layer(radius: f32, spacing: f32) -> Vec<Vec2> {
    let reach = (radius / spacing).ceil() as i32 + 1;
    let area = std::f32::consts::PI * radius * radius / (spacing * spacing);
    let inside = |q: &Vec2| q.length() <= radius - 0.499 * spacing;
    let layers = [0.0, 0.5].map(|shift| {
        let points = (-reach..=reach).flat_map(|j| (-reach..=reach).map(move |i| (i, j)));
        let place = |(i, j): (i32, i32)| spacing * (Vec2::new(i as f32, j as f32) + shift);
        points.map(place).filter(inside).collect::<Vec<_>>()
    });
    let best = layers.into_iter().filter(|layer| !layer.is_empty());
    best.min_by(|a, b| (a.len() as f32 - area).abs().total_cmp(&(b.len() as f32 - area).abs()))
        .unwrap_or_else(|| vec![Vec2::ZERO])
}

/// As [`disc_layer`] for a rectangle of this size in m: as many whole spacings as fit it best.
pub fn rectangle_layer(size: [f32; 2], spacing: f32) -> Vec<Vec2> {
    let [n, m] = size.map(|edge| ((edge / spacing).round() as i32).max(1));
    let place = |i: i32, n: i32| spacing * (i as f32 - 0.5 * (n - 1) as f32);
    (0..m).flat_map(|j| (0..n).map(move |i| Vec2::new(place(i, n), place(j, m)))).collect()
}

/// The solid of an outlet's or a sink's mesh.
///
/// # Errors
/// [`BodyError`] of the file or the shape; a sheet without an inside among them.
pub fn solid_of(
    name: &str,
    source: &MeshSource,
    scene: &Scene,
    kernels: KernelPair,
) -> Result<Solid, BodyError> {
    let mesh = mesh_of(name, source)?;
    let spacing = scene.fluid.particle_spacing;
    let (low, high) = solid::bounds(&mesh);
    let support_radius = scene.solver.support_radius(spacing);
    let settings = SolidSettings {
        // A hundred cells along the longest edge show as much of a shape as particles can.
        cell_size: (0.5 * spacing).max((high - low).max_element() / 100.0),
        support_radius,
        kernels,
        half_thickness: 0.5 * spacing,
        shell: Some(false),
        cache: None,
    };
    let wrong = |source| BodyError::Solid { name: name.into(), source };
    let solid = Solid::build(&mesh, &settings, &|_| {}).map_err(wrong)?;
    solid.require_volume().map_err(wrong)?;
    Ok(solid)
}

/// Points of the mesh's cross-section at the outlet, on the lattice of [`axes`] round `position`.
fn mesh_layer(emitter: &Emitter, source: &MeshSource, solid: &Solid, spacing: f32) -> Vec<Vec2> {
    let (across, up) = axes(emitter.direction);
    let reach = solid.mesh.vertices.iter().map(|v| Vec3::from(*v).length()).fold(0.0, f32::max);
    let n = (reach / spacing).ceil() as i32;
    let points = (-n..=n).flat_map(|j| (-n..=n).map(move |i| spacing * Vec2::new(i as f32, j as f32)));
    let inside = |q: &Vec2| {
        let offset = q.x * across + q.y * up;
        solid.field.distance(source.rotation.conjugate() * offset) <= -0.499 * spacing
    };
    points.filter(inside).collect()
}

/// An emitter's layer and nozzle; `first_point` is not yet set.
///
/// # Errors
/// As [`solid_of`].
pub fn nozzle(
    emitter: &Emitter,
    scene: &Scene,
    kernels: KernelPair,
) -> Result<(Nozzle, Vec<Vec2>), BodyError> {
    let spacing = scene.fluid.particle_spacing;
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
            let solid = solid_of(&emitter.name, source, scene, kernels)?;
            let layer = mesh_layer(emitter, source, &solid, spacing);
            let half = half(&layer);
            (layer, 0, half)
        }
    };
    let length = scene.solver.support_radius(spacing) + spacing;
    let start = emitter.position - length * emitter.direction;
    let back = start + emitter.direction * forward(&scene.domain, start, emitter, &layer, length, spacing);
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

/// How far a nozzle must stick out so that its back face is inside the domain, in m: an outlet in a wall has its nozzle before the wall.
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

/// How many particles a nozzle makes until `duration` (s), one layer more than the flow asks for.
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
    use super::*;

    #[test]
    fn layers_fill_their_outlet_and_keep_off_the_rim() {
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
    fn axes_are_right_handed_and_unit() {
        for d in [Vec3::X, Vec3::Y, -Vec3::Y, Vec3::new(1.0, -2.0, 0.5).normalize_or_zero()] {
            let (across, up) = axes(d);
            assert!((across.cross(up) - d).length() < 1e-6 || (d.cross(across) - up).length() < 1e-6);
            assert!(across.dot(d).abs() < 1e-6 && across.y.abs() < 1e-6);
        }
    }
}
