//! The hydrostatic pressure of blocks at the start.

use glam::Vec3;
use rayon::prelude::*;
use splashdown_io::Particles;

use crate::bodies::LoadedBody;
use crate::scene::{Block, DensityMode, Derived, InitialPressure, Method, Scene, Shape};

/// Maximum number of steps of a search for the body below a particle.
const MOST_STEPS: u32 = 2000;
/// The largest distance of the direction of gravity from an axis.
const STRAIGHT: f32 = 1e-3;

/// Gives particles of boxes that stand on a closed side below them, or on such a box, the pressure of fluid at rest.
/// An implicit pressure starts with it. Where the density is integrated, they get its initial value. Where it is summed,
/// their layers move closer together, above the floor or the body below them.
///
/// A fluid that starts without pressure falls on itself: in a tank at rest the pressure at the floor oscillates by an
/// eighth of rho g h for seconds.
pub fn start_at_rest(scene: &Scene, particles: &mut Particles, bodies: &[LoadedBody]) {
    let Some(columns) = Columns::new(scene) else { return };
    let derived = Derived::without_particles(scene);
    let (rest, exponent) = (scene.fluid.material.rest_density, scene.solver.exponent);
    let per_depth = scene.gravity.length() / (derived.sound_speed * derived.sound_speed);
    let is_integrated = is_density_integrated(scene);
    let Particles { positions, velocities, densities, pressures, .. } = particles;
    let at = |(x, v): (&[f32; 3], &[f32; 3])| if *v == [0.0; 3] { columns.at(Vec3::from(*x)) } else { None };
    if scene.solver.method == Method::Dfsph {
        pressures.resize(positions.len(), 0.0);
        let all = positions.par_iter().zip(velocities.par_iter()).zip(pressures.par_iter_mut());
        all.for_each(|(particle, pressure)| {
            if let Some((_, depth)) = at(particle) {
                *pressure = rest * scene.gravity.length() * depth;
            }
        });
    } else if is_integrated {
        densities.resize(positions.len(), rest);
        let all = positions.par_iter().zip(velocities.par_iter()).zip(densities.par_iter_mut());
        all.for_each(|(particle, density)| {
            if let Some((_, depth)) = at(particle) {
                *density = rest * (1.0 + exponent * per_depth * depth).powf(exponent.recip());
            }
        });
    } else {
        let lowered = |height: f32, total: f32| height - compressed(height, total, per_depth, exponent);
        positions.par_iter_mut().zip(velocities.par_iter()).for_each(|(x, v)| {
            if let Some((height, depth)) = at((x, v)) {
                let total = height + depth;
                let base = height - room_below(bodies, Vec3::from(*x), columns.up, height);
                let lowered = lowered(height, total) - lowered(base, total);
                *x = (Vec3::from(*x) - lowered * columns.up).into();
            }
        });
    }
}

/// True if [`start_at_rest`] has an effect.
pub(crate) fn can_start_at_rest(scene: &Scene) -> bool {
    Columns::new(scene).is_some_and(|columns| {
        columns.boxes.iter().any(|&(min, max)| columns.at(0.5 * (min + max)).is_some())
    })
}

fn is_density_integrated(scene: &Scene) -> bool {
    scene.solver.method == Method::Wcsph && scene.solver.density == DensityMode::Continuity
}

/// The distance in m from a point to the first body below it, and at most `height`. Follows the distances to the bodies.
fn room_below(bodies: &[LoadedBody], x: Vec3, up: Vec3, height: f32) -> f32 {
    let distance = |x: Vec3| {
        let of = |body: &LoadedBody| {
            let (position, rotation) = body.pose();
            body.solid.field.distance(rotation.conjugate() * (x - position))
        };
        bodies.iter().map(of).fold(f32::INFINITY, f32::min)
    };
    let mut room = 0.0;
    // Beside a surface that runs along the way the steps are as short as the distance from it.
    for _ in 0..MOST_STEPS {
        let step = distance(x - room * up);
        room += step.max(0.0);
        if room >= height {
            return height;
        }
        if step < 1e-3 * height {
            break;
        }
    }
    room
}

/// The height to which fluid at a height falls when a column of this total height is compressed by its weight: the
/// integral of rho0 / rho from the floor, with Tait's equation of state.
fn compressed(height: f32, total: f32, per_depth: f32, exponent: f32) -> f32 {
    let (k, n) = (f64::from(per_depth), f64::from(exponent));
    let stretched = |height: f32| 1.0 + n * k * f64::from(total - height);
    let (floor, here) = (stretched(0.0), stretched(height));
    let above = if exponent == 1.0 {
        (floor / here).ln() / k
    } else {
        (floor.powf(1.0 - 1.0 / n) - here.powf(1.0 - 1.0 / n)) / (k * (n - 1.0))
    };
    above as f32
}

/// Boxes of fluid without velocity, and the direction in which they are stacked.
struct Columns<'a> {
    scene: &'a Scene,
    up: Vec3,
    axis: usize,
    boxes: Vec<(Vec3, Vec3)>,
}

impl<'a> Columns<'a> {
    /// `None` if no block can be at rest.
    fn new(scene: &'a Scene) -> Option<Self> {
        let up = -scene.gravity.try_normalize()?;
        let axis = (0..3).find(|&axis| (up - up[axis].signum() * Vec3::AXES[axis]).length() < STRAIGHT)?;
        if scene.fluid.initial_pressure == InitialPressure::Zero {
            return None;
        }
        let at_rest = |block: &Block| match block.shape {
            Shape::Box { min, size } if block.velocity == Vec3::ZERO => Some((min, min + size)),
            _ => None,
        };
        let boxes: Vec<_> = scene.fluid.blocks.iter().filter_map(at_rest).collect();
        (!boxes.is_empty()).then_some(Self { scene, up: up.round(), axis, boxes })
    }

    /// The height above the floor and the depth below the surface of a point, in metres, if it lies in a column of boxes
    /// that stands on a closed side.
    fn at(&self, x: Vec3) -> Option<(f32, f32)> {
        let near = 0.51 * self.scene.fluid.particle_spacing;
        let [low, high] = [self.scene.domain.min, self.scene.domain.max];
        let is_upwards = self.up[self.axis] > 0.0;
        // Heights grow against gravity.
        let height = |x: Vec3| x.dot(self.up);
        let floor = height(if is_upwards { low } else { high });
        let is_closed = self.scene.domain.closed[self.axis][usize::from(!is_upwards)];
        let beside = |&&(min, max): &&(Vec3, Vec3)| {
            (0..3).all(|axis| axis == self.axis || (min[axis] <= x[axis] && x[axis] <= max[axis]))
        };
        let spans = || {
            let span =
                |&(min, max): &(Vec3, Vec3)| (height(min).min(height(max)), height(min).max(height(max)));
            self.boxes.iter().filter(beside).map(span)
        };
        let (mut bottom, mut top) = spans().find(|&(bottom, top)| bottom <= height(x) && height(x) <= top)?;
        // Every round extends the column by at least one of the boxes, or ends.
        loop {
            let before = (bottom, top);
            for (lower, upper) in spans() {
                if lower <= top + near && upper > top {
                    top = upper;
                }
                if upper >= bottom - near && lower < bottom {
                    bottom = lower;
                }
            }
            if (bottom, top) == before {
                break;
            }
        }
        (is_closed && (bottom - floor).abs() <= near).then_some((height(x) - floor, top - height(x)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tank with two stacked boxes, one beside them in mid-air, and one that moves.
    fn scene(density: &str, gravity: [f32; 3]) -> Scene {
        let text = format!(
            "[scene]\nname = \"t\"\nduration = 1\ngravity = {gravity:?}\n[domain]\nmin = [0, 0, 0]\nmax = [4, 4, 1]\n\
             open = [\"y_max\"]\n[solver]\ndensity = \"{density}\"\n[fluid]\nparticle_spacing = 0.1\n\
             [[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, 1, 1]\n\
             [[fluid.block]]\nposition = [0, 1, 0]\nsize = [0.5, 1, 1]\n\
             [[fluid.block]]\nposition = [2, 1, 0]\nsize = [1, 1, 1]\n\
             [[fluid.block]]\nposition = [3, 0, 0]\nsize = [1, 1, 1]\nvelocity = [1, 0, 0]\n"
        );
        Scene::parse(&text, "t.toml").unwrap()
    }

    fn start(scene: &Scene, x: [f32; 3]) -> Particles {
        let mut particles = Particles::default();
        particles.positions.push(x);
        particles.velocities.push([0.0; 3]);
        start_at_rest(scene, &mut particles, &[]);
        particles
    }

    #[test]
    fn the_density_is_that_of_water_at_rest() {
        let scene = scene("continuity", [0.0, -9.81, 0.0]);
        let params = crate::schemes::params(&scene, 0);
        for (x, depth) in [
            ([0.75, 0.25, 0.5], 0.75),
            // Below the second box.
            ([0.25, 0.25, 0.5], 1.75),
            ([0.25, 1.5, 0.5], 0.5),
            // In mid-air, and in motion.
            ([2.5, 1.5, 0.5], 0.0),
            ([3.5, 0.5, 0.5], 0.0),
        ] {
            let pressure = params.pressure_at(start(&scene, x).densities[0]);
            assert!(
                (pressure - 9.81 * params.rest_density * depth).abs() < 30.0,
                "{x:?}: {pressure} Pa at {depth} m"
            );
        }
    }

    #[test]
    fn layers_are_closer_where_the_density_is_summed() {
        let scene = scene("summation", [0.0, -9.81, 0.0]);
        let lowered = |x: [f32; 3]| f64::from(x[1]) - f64::from(start(&scene, x).positions[0][1]);
        let per_depth = 9.81 / f64::from(crate::schemes::params(&scene, 0).sound_speed).powi(2);
        for (y, depth) in [(0.05, 0.95), (0.95, 0.05)] {
            // The strain at a depth is the change of the displacement.
            let strain = (lowered([0.75, y + 0.05, 0.5]) - lowered([0.75, y - 0.05, 0.5])) / 0.1;
            assert!((strain - per_depth * depth).abs() < 0.02 * per_depth, "{y}: {strain}");
        }
        assert_eq!(lowered([2.5, 1.5, 0.5]), 0.0);
    }

    #[test]
    fn only_gravity_along_an_axis_to_a_closed_side_counts() {
        let density =
            |gravity| start(&scene("continuity", gravity), [0.75, 0.25, 0.5]).densities.first().copied();
        assert_eq!(density([0.0, 0.0, 0.0]), None);
        assert_eq!(density([1.0, -9.81, 0.0]), None);
        // Upwards: the upper side is open, and no box is near it.
        let rest = scene("continuity", [0.0; 3]).fluid.material.rest_density;
        assert_eq!(density([0.0, 9.81, 0.0]), Some(rest));
    }

    #[test]
    fn strong_compression_keeps_the_order_of_the_layers() {
        for exponent in [1.0, 7.0] {
            let heights = [0.0, 0.1, 0.5, 0.9, 1.0].map(|height| compressed(height, 1.0, 1.6, exponent));
            assert_eq!(heights[0], 0.0);
            assert!(heights.windows(2).all(|pair| pair[0] < pair[1]), "{exponent}: {heights:?}");
            // rho0 / rho at the surface is 1.
            let slope = (heights[4] - heights[3]) / 0.1;
            assert!((0.9..=1.0).contains(&slope), "{exponent}: {slope}");
        }
    }

    #[test]
    fn moving_particles_inside_a_box_start_without_pressure() {
        let scene = scene("continuity", [0.0, -9.81, 0.0]);
        let mut particles = Particles::default();
        particles.positions = vec![[0.75, 0.25, 0.5]; 2];
        particles.velocities = vec![[0.0; 3], [1.0, 0.0, 0.0]];
        start_at_rest(&scene, &mut particles, &[]);
        assert!(particles.densities[0] > scene.fluid.material.rest_density);
        assert_eq!(particles.densities[1], scene.fluid.material.rest_density);
    }
}
