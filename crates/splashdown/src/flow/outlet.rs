//! The outlet of an emitter on the host: the lattice of a layer, the nozzle behind it, and the number of particles.

use glam::{Vec2, Vec3, Vec4};

use super::Nozzle;
use crate::bodies::{BodyError, closed_solid, owner};
use crate::scene::outlet::LATTICE_SHIFTS;
pub use crate::scene::outlet::{Layer, axes, disc_layer, rectangle_layer};
use crate::scene::{Domain, Emitter, MeshSource, Outlet, Scene};
use crate::solid::Solid;

/// More particles than any scene emits, and small enough that sums do not overflow.
const UNLIMITED: u32 = u32::MAX / 2;

/// The largest distance in spacings of particles from the axis of an outlet that is one particle wide. Exactly above one
/// another they would pile up to a rigid column between floor and outlet.
const WOBBLE: f32 = 0.05;

/// The largest relative error of the flow of an outlet given by a mesh.
const MOST_MESH_ERROR: f32 = 0.1;

/// Shifts the points of a layer forward, each by its own fraction of `depth` (m). The distances between columns do not
/// change, and a jet that gravity stretches thins evenly instead of separating into discs. The fractions are those of
/// Roberts' sequence R2 on the lattice, which differ strongly between neighbours.
pub fn staggered(layer: &Layer, depth: f32) -> Vec<Vec4> {
    const PLASTIC: f32 = 1.324_718;
    let fraction = |column: &Vec2| (column.x / PLASTIC + column.y / (PLASTIC * PLASTIC)).rem_euclid(1.0);
    let points = layer.points.iter().zip(&layer.columns);
    points.map(|(q, column)| q.extend(depth * fraction(column)).extend(0.0)).collect()
}

/// The depth in m by which a layer is staggered: the distance between layers for a jet straight down, and zero for one
/// that gravity does not stretch, whose layers may have to enter fluid at rest as a whole.
pub fn stagger(direction: Vec3, gravity: Vec3, interval: f32) -> f32 {
    interval * direction.dot(gravity.normalize_or_zero()).clamp(0.0, 1.0)
}

/// As [`disc_layer`], for the cross-section of the mesh at the outlet; none if its area is too
/// small for the spacing.
fn mesh_layer(emitter: &Emitter, source: &MeshSource, solid: &Solid, spacing: f32) -> Option<Layer> {
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
    let layers =
        LATTICE_SHIFTS.map(|shift| lattice(spacing, shift).filter(|q| inside(*q)).collect::<Vec<_>>());
    let error = |layer: &Vec<Vec2>| (layer.len() as f32 - wanted).abs();
    let best = layers.into_iter().filter(|layer| !layer.is_empty());
    let points = best.min_by(|a, b| error(a).total_cmp(&error(b)))?;
    let area = wanted * spacing * spacing;
    let layer = Layer::covering(area, points, spacing);
    ((layer.share_of(area, spacing) - 1.0).abs() < MOST_MESH_ERROR).then_some(layer)
}

/// The nozzle of an emitter, with `first_point` not yet set, and its layer, not yet [`staggered`].
///
/// # Errors
/// [`BodyError`] of the outlet's mesh, which must be closed.
pub fn nozzle(emitter: &Emitter, scene: &Scene) -> Result<(Nozzle, Layer), BodyError> {
    let spacing = scene.fluid.particle_spacing;
    let support_radius = scene.solver.support_radius(spacing);
    let (nozzle, layer) = nozzle_in(emitter, &scene.domain, spacing, support_radius)?;
    let [share_across, share_up] = shares(&nozzle, &layer, &scene.domain, spacing);
    let stretching = stretching(&nozzle, &scene.domain, scene.fluid.material.viscosity);
    Ok((Nozzle { share_across, share_up, stretching, ..nozzle }, layer))
}

/// The rate R at which gravity g stretches a jet along d at its outlet, over g.d, in s/m: one over the speed in free fall.
///
/// A viscous thread carries its weight by the tension 3 rho nu R (Trouton): with a length L below the outlet, R is at
/// most g.d L / (3 nu). L is the way to the end of the domain along the jet.
fn stretching(nozzle: &Nozzle, domain: &Domain, viscosity: f32) -> f32 {
    let outlet = nozzle.back + nozzle.length * nozzle.direction;
    let way = |k: usize| {
        let end = if nozzle.direction[k] > 0.0 { domain.max[k] } else { domain.min[k] };
        // A component near zero does not reach its end.
        if nozzle.direction[k].abs() < 1e-6 {
            f32::MAX
        } else {
            ((end - outlet[k]) / nozzle.direction[k]).max(0.0)
        }
    };
    let length = way(0).min(way(1)).min(way(2));
    (1.0 / nozzle.speed).min(length / (3.0 * viscosity))
}

/// The shares of the rate at which gravity stretches a jet in air that are its contraction along `across` and `up` of its
/// nozzle. Their sum is 1, so that the jet keeps its density.
///
/// The pressure of an elliptic jet with half the axes A and B, which vanishes at its surface, is proportional to
/// 1 - a^2 / A^2 - b^2 / B^2; its gradient causes rates in the ratio B^2 : A^2. A rectangle is treated like the ellipse of
/// its width and height. Fluid at a closed side of the domain stays there: the jet contracts in the other direction only.
/// So does one that is a single column wide. Jets of meshes contract if they are centred at the origin of the mesh. The
/// velocity at the rim is at most [`Nozzle::MOST_CONTRACTION`] times the speed: slower jets are not slender, and the rate
/// holds at their outlet only.
fn shares(nozzle: &Nozzle, layer: &Layer, domain: &Domain, spacing: f32) -> [f32; 2] {
    let middle = layer.points.iter().sum::<Vec2>() / layer.points.len() as f32;
    if middle.length() > spacing {
        return [0.0; 2];
    }
    let halves = [nozzle.half_across, nozzle.half_up];
    let centre = nozzle.back + nozzle.length * nozzle.direction;
    let axes = [nozzle.across, nozzle.up];
    let squares = [0, 1].map(|k| {
        let ends = [-halves[k], halves[k]].map(|end| centre + end * axes[k]);
        let is_at_wall = ends.iter().any(|&end| is_at_wall(end, axes[k], domain, spacing));
        let is_column = layer.points.iter().all(|q| (q[k] - middle[k]).abs() < 0.25 * spacing);
        if is_at_wall || is_column { f32::INFINITY } else { halves[k] * halves[k] }
    });
    match squares.map(f32::is_infinite) {
        [true, true] => [0.0, 0.0],
        [true, false] => [0.0, 1.0],
        [false, true] => [1.0, 0.0],
        [false, false] => [squares[1], squares[0]].map(|square| square / (squares[0] + squares[1])),
    }
}

/// Whether a point is less than a spacing from a closed side of the domain to which `axis` is nearly perpendicular, or
/// behind it.
fn is_at_wall(x: Vec3, axis: Vec3, domain: &Domain, spacing: f32) -> bool {
    (0..3).filter(|&k| axis[k].abs() > 0.9).any(|k| {
        let [low, high] = domain.closed[k];
        low && x[k] < domain.min[k] + spacing || high && x[k] > domain.max[k] - spacing
    })
}

/// The volume in m^3 [beside the pipe](Nozzle::is_beside).
fn volume_beside(nozzle: &Nozzle, spacing: f32) -> f32 {
    let (across, up, reach) = (nozzle.half_across, nozzle.half_up, Nozzle::REACH * spacing);
    let area = if nozzle.disc == 1 {
        std::f32::consts::PI * ((across + reach).powi(2) - across * across)
    } else {
        4.0 * ((across + reach) * (up + reach) - across * up)
    };
    area * nozzle.length
}

/// As [`nozzle`], for a scene that is not complete yet.
pub(crate) fn nozzle_in(
    emitter: &Emitter,
    domain: &Domain,
    spacing: f32,
    support_radius: f32,
) -> Result<(Nozzle, Layer), BodyError> {
    let (across, up) = axes(emitter.direction);
    let half =
        |layer: &Layer| layer.points.iter().fold(Vec2::ZERO, |most, q| most.max(q.abs())) + 0.5 * layer.pitch;
    let (layer, disc, half) = match &emitter.outlet {
        Outlet::Disc { radius } => {
            let layer = disc_layer(*radius, spacing);
            // A single column has no extent of its own.
            (layer, 1, Vec2::splat(radius.max(0.5 * spacing)))
        }
        Outlet::Rectangle { size } => {
            let layer = rectangle_layer(*size, spacing);
            let half = half(&layer);
            (layer, 0, half)
        }
        Outlet::Mesh(source) => {
            let owner = owner("emitter", &emitter.name, source);
            let solid = closed_solid(&owner, source, domain, spacing)?;
            let Some(layer) = mesh_layer(emitter, source, &solid, spacing) else {
                return Err(BodyError::Outline { owner, spacing });
            };
            let half = half(&layer);
            (layer, 0, half)
        }
    };
    let points = layer.points.len() as u32;
    if let Some(most) = emitter.max_particles.filter(|&most| most < points) {
        return Err(BodyError::LessThanLayer { name: emitter.name.clone(), most, layer: points });
    }
    let length = support_radius + spacing;
    let start = emitter.position - length * emitter.direction;
    let back = start + emitter.direction * forward(domain, start, emitter, &layer.points, length, spacing);
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
        points,
        most: emitter.max_particles.unwrap_or(UNLIMITED).min(UNLIMITED),
        disc,
        interval: layer.interval,
        wobble: if points == 1 { WOBBLE * spacing } else { 0.0 },
        share_across: 0.0,
        share_up: 0.0,
        stretching: 0.0,
        submerged_at: 1.0,
    };
    let submerged_at = 0.5 * volume_beside(&nozzle, spacing) / spacing.powi(3);
    let nozzle = Nozzle { submerged_at, ..nozzle };
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
pub fn expected(nozzle: &Nozzle, duration: f32) -> u64 {
    let active = (nozzle.end.min(duration) - nozzle.start).max(0.0);
    if active == 0.0 {
        return 0;
    }
    let layers = (f64::from(nozzle.speed) * f64::from(active) / f64::from(nozzle.interval)).ceil() as u64 + 1;
    layers.saturating_mul(u64::from(nozzle.points)).min(u64::from(nozzle.most))
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec4Swizzles};

    use super::*;
    use crate::scene::{MeshShape, UpAxis};

    #[test]
    fn layers_emit_the_flow_of_the_outlet_and_stay_inside_it() {
        for radius in [0.012, 0.02, 0.03, 0.04, 0.05, 0.083, 0.2] {
            let layer = disc_layer(radius, 0.01);
            let area = std::f32::consts::PI * radius * radius;
            assert!((layer.share_of(area, 0.01) - 1.0).abs() < 1e-5, "{radius}");
            assert!(layer.points.iter().all(|q| q.length() <= radius - 0.0024), "{radius}");
            // The lattice has the rest density; points at the rim are nearer to their neighbours.
            let volume = layer.pitch.element_product() * layer.interval;
            assert!((volume / 1e-6 - 1.0).abs() < 1e-5, "{radius}: {volume}");
            let adjusted = layer.interval / 0.01;
            assert!((0.8..1.43).contains(&adjusted), "{radius}: {adjusted}");
            assert!(radius < 0.03 || (adjusted - 1.0).abs() < 0.1, "{radius}: {adjusted}");
        }
        let squares = [0.015, 0.024, 0.0249, 0.0349].map(|edge| [edge, edge]);
        for size in [[0.04, 0.03], [0.043, 0.026], [0.015, 0.2], [0.012, 0.01]].into_iter().chain(squares) {
            let layer = rectangle_layer(size, 0.01);
            assert!((layer.share_of(size[0] * size[1], 0.01) - 1.0).abs() < 1e-5, "{size:?}");
            let outside = |q: &Vec2| 2.0 * q.abs() + layer.pitch - Vec2::from(size);
            assert!(layer.points.iter().all(|q| outside(q).max_element() < 1e-6), "{size:?}");
            let volume = layer.pitch.element_product() * layer.interval;
            assert!((volume / 1e-6 - 1.0).abs() < 1e-5, "{size:?}: {volume}");
        }
        assert_eq!(rectangle_layer([0.04, 0.03], 0.01).points.len(), 12);
    }

    /// The largest sum of the Wendland kernel with a support of two spacings in a pipe full of layers, over that of the
    /// lattice at rest. Lengths in spacings.
    fn largest_density(points: &[Vec4], interval: f32) -> f32 {
        let kernel = |square: f32| {
            let q = (0.5 * square.sqrt()).min(1.0);
            (1.0 - q).powi(4) * (1.0 + 4.0 * q)
        };
        let lattice = (0..125).map(|k| Vec3::new((k % 5) as f32, (k / 5 % 5) as f32, (k / 25) as f32) - 2.0);
        let at_rest: f32 = lattice.map(|q| kernel(q.length_squared())).sum();
        let layers = (2.0 / interval).ceil() as i32 + 1;
        let density = |a: &Vec4| {
            let share = |b: &Vec4, layer: i32| {
                kernel((a.xyz() - b.xyz() - Vec3::Z * (layer as f32 * interval)).length_squared())
            };
            points.iter().map(|b| (-layers..=layers).map(|layer| share(b, layer)).sum::<f32>()).sum::<f32>()
        };
        points.iter().map(density).fold(0.0, f32::max) / at_rest
    }

    #[test]
    fn a_pipe_full_of_layers_is_hardly_denser_than_water_at_rest() {
        let mut clamped: f32 = 0.0;
        for k in 0..350 {
            let radius = 1.0 + 0.02 * k as f32;
            let layer = disc_layer(radius, 1.0);
            assert!(layer.points.iter().all(|q| q.length() <= radius - 0.249), "{radius}");
            for depth in [0.0, layer.interval] {
                let density = largest_density(&staggered(&layer, depth), layer.interval);
                assert!(density < 1.035, "{radius}: {density}");
            }
            // Control: points of the lattice that are only moved inwards.
            let middle = layer.columns.iter().sum::<Vec2>() / layer.columns.len() as f32;
            let inwards = |q: &Vec2| {
                ((*q - middle) * layer.pitch).clamp_length_max(radius - 0.25).extend(0.0).extend(0.0)
            };
            let points: Vec<Vec4> = layer.columns.iter().map(inwards).collect();
            clamped = clamped.max(largest_density(&points, layer.interval));
        }
        assert!(clamped > 1.1, "{clamped}");
    }

    #[test]
    fn an_outlet_much_narrower_than_a_spacing_emits_too_much() {
        let layer = disc_layer(0.001, 0.01);
        assert_eq!(layer.points, [Vec2::ZERO]);
        assert!(layer.interval < 0.0143 && layer.share_of(3.14e-6, 0.01) > 20.0);
    }

    fn tap(outlet: Outlet, position: Vec3, direction: Vec3, speed: f32) -> Emitter {
        Emitter {
            name: "tap".into(),
            outlet,
            position,
            direction,
            speed,
            start: 0.0,
            end: None,
            max_particles: None,
        }
    }

    #[test]
    fn jets_contract_along_both_axes_but_at_walls() {
        let domain = Domain { min: Vec3::ZERO, max: Vec3::ONE, closed: [[true; 2]; 3], oscillation: None };
        let shares_of = |outlet: Outlet, position: Vec3| {
            let emitter = tap(outlet, position, Vec3::NEG_Y, 2.0);
            let (nozzle, layer) = nozzle_in(&emitter, &domain, 0.01, 0.02).unwrap();
            shares(&nozzle, &layer, &domain, 0.01)
        };
        let (disc, middle) = (|| Outlet::Disc { radius: 0.05 }, Vec3::splat(0.5));
        assert_eq!(shares_of(disc(), middle), [0.5, 0.5]);
        // A curtain contracts mostly in its thickness, and between two walls only there.
        let curtain = |width: f32, thickness: f32| Outlet::Rectangle { size: [width, thickness] };
        let free = shares_of(curtain(0.5, 0.1), middle);
        assert!(free[0] < 0.05 && (free[0] + free[1] - 1.0).abs() < 1e-6, "{free:?}");
        assert_eq!(shares_of(curtain(1.0, 0.1), middle), [0.0, 1.0]);
        // The ceiling is no wall of a jet that falls from it. A single row has no thickness, a single column no width either.
        assert_eq!(shares_of(disc(), Vec3::new(0.5, 0.99, 0.5)), [0.5, 0.5]);
        assert_eq!(shares_of(curtain(0.5, 0.01), middle), [1.0, 0.0]);
        assert_eq!(shares_of(Outlet::Disc { radius: 0.002 }, middle), [0.0, 0.0]);
    }

    #[test]
    fn the_rim_of_a_slow_jet_is_half_as_fast_as_the_jet() {
        let domain = Domain { min: Vec3::ZERO, max: Vec3::ONE, closed: [[true; 2]; 3], oscillation: None };
        let gravity = Vec3::new(0.0, -10.0, 0.0);
        let sideways = |speed: f32, direction: Vec3| {
            let emitter = tap(Outlet::Disc { radius: 0.05 }, Vec3::splat(0.5), direction, speed);
            let (nozzle, _) = nozzle_in(&emitter, &domain, 0.01, 0.02).unwrap();
            let nozzle = Nozzle {
                share_across: 0.5,
                share_up: 0.5,
                stretching: stretching(&nozzle, &domain, 1e-6),
                ..nozzle
            };
            let rim = emitter.position - 1e-6 * direction + 0.05 * nozzle.across;
            nozzle.velocity(rim, gravity, 0.001, 0).dot(nozzle.across)
        };
        let near = |a: f32, b: f32| (a - b).abs() < 1e-4;
        assert!(near(sideways(2.0, Vec3::NEG_Y), -0.05 * 2.5) && near(sideways(2.0, Vec3::Y), 0.05 * 2.5));
        assert!(near(sideways(2.0, Vec3::X), 0.0) && near(sideways(0.1, Vec3::NEG_Y), -0.05));
    }

    #[test]
    fn a_viscous_thread_is_stretched_by_its_weight() {
        let domain = Domain { min: Vec3::ZERO, max: Vec3::ONE, closed: [[true; 2]; 3], oscillation: None };
        let rate = |viscosity: f32, direction: Vec3| {
            let emitter = tap(Outlet::Disc { radius: 0.05 }, Vec3::new(0.5, 0.8, 0.5), direction, 0.5);
            let (nozzle, _) = nozzle_in(&emitter, &domain, 0.01, 0.02).unwrap();
            stretching(&nozzle, &domain, viscosity)
        };
        assert_eq!([1e-6, 0.0].map(|viscosity| rate(viscosity, Vec3::NEG_Y)), [2.0, 2.0]);
        // Its length is 0.8 m downwards, and 0.5 m to the side.
        assert!((rate(0.5, Vec3::NEG_Y) - 0.8 / 1.5).abs() < 1e-4);
        assert!((rate(0.5, Vec3::X) - 0.5 / 1.5).abs() < 1e-4);
    }

    #[test]
    fn a_pipe_at_the_surface_is_half_submerged() {
        let domain = Domain { min: Vec3::ZERO, max: Vec3::ONE, closed: [[true; 2]; 3], oscillation: None };
        for outlet in [Outlet::Disc { radius: 0.05 }, Outlet::Rectangle { size: [0.1, 0.06] }] {
            let emitter = tap(outlet, Vec3::splat(0.5), Vec3::X, 1.0);
            let (mut nozzle, _) = nozzle_in(&emitter, &domain, 0.01, 0.02).unwrap();
            (nozzle.share_across, nozzle.share_up, nozzle.stretching) = (0.5, 0.5, 1.0);
            let gravity = Vec3::X * 4.0;
            let points = (0..1_000_000)
                .map(|k| Vec3::new((k % 100) as f32, (k / 100 % 100) as f32, (k / 10_000) as f32));
            let beside: Vec<Vec3> =
                points.map(|q| 0.01 * (q + 0.5)).filter(|x| nozzle.is_beside(*x, 0.01)).collect();
            let full = beside.len() as f32 / nozzle.submerged_at;
            assert!((1.6..2.4).contains(&full), "{full}");
            let below = beside.iter().filter(|x| x.y < 0.5).count() as f32 / nozzle.submerged_at;
            assert!((0.8..1.2).contains(&below), "{below}");
            let leaving = Vec3::new(0.499, 0.52, 0.5);
            let velocity = |beside: usize| nozzle.velocity(leaving, gravity, 0.005, beside as u32);
            assert!((velocity(0) - Vec3::new(1.0, -0.04, 0.0)).length() < 1e-5);
            assert_eq!(velocity(beside.len()), Vec3::X);
            assert_eq!(nozzle.velocity(leaving, gravity, 5e-4, 0), Vec3::X);
        }
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
            assert_eq!((layer.points.len(), nozzle.points), (count, count as u32), "{spacing}");
            assert!((layer.interval / spacing - 1.0).abs() < 1e-3, "{spacing}: {}", layer.interval);
            assert!(layer.points.iter().all(|q| q.abs().max_element() < 0.05 - 0.49 * spacing));
        }
        // The gear is 0.22 m wide at this scale. Its layer has no points in the bore and between the teeth.
        let gear = MeshSource {
            shape: MeshShape::Model("gear".into()),
            rotation: Quat::from_rotation_x(std::f32::consts::FRAC_PI_2),
            ..source(0.5)
        };
        let (_, layer) =
            nozzle_in(&Emitter { outlet: Outlet::Mesh(gear), ..emitter }, &domain, 0.01, 0.02).unwrap();
        // A disc with 20 teeth, without six holes and the bore with its groove (`models::machines`).
        let disc = |radius: f32| std::f32::consts::PI * radius * radius;
        let full = disc(0.178) + 20.0 * 0.5 * (0.033 + 0.016) * 0.031;
        let area = 0.25 * (full - 6.0 * disc(0.027) - disc(0.031) - 0.018 * 0.011);
        let share = layer.share_of(area, 0.01);
        // The distance field rounds the teeth and the holes, which are a few spacings wide.
        assert!((share - 1.0).abs() < 0.15, "{share}");
        assert!(layer.points.iter().all(|q| q.length() > 0.01));
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
            let points = staggered(&layer, 0.01);
            assert!(points.iter().zip(&layer.points).all(|(p, q)| p.x == q.x && p.y == q.y));
            assert!(points.iter().all(|p| (0.0..0.01).contains(&p.z)));
            let mut pairs = 0;
            for a in &points {
                for b in points
                    .iter()
                    .filter(|b| (a.x - b.x).hypot(a.y - b.y) < 1.01 * layer.pitch.max_element() && *b != a)
                {
                    let apart = (a.z - b.z).rem_euclid(0.01);
                    assert!(apart.min(0.01 - apart) > 0.0024, "{a} and {b}");
                    pairs += 1;
                }
            }
            assert!(pairs > 2 * layer.points.len(), "{pairs}");
            assert!(staggered(&layer, 0.0).iter().all(|p| p.z == 0.0));
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
