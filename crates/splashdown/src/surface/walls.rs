//! The closed sides of a box, at which the surface ends.
//!
//! A closed side is a plane of symmetry of the field, as it is of the solver: the field is that of
//! the particles and of their [images](crate::boundary). The gap of half a spacing between the
//! outermost particles and the wall is therefore filled, and a free surface meets the wall at a
//! right angle. Nodes beyond a wall are outside the fluid, and the vertex of an edge that crosses a
//! wall lies exactly on it, with the normal of the wall. Smoothing moves it along the wall only. The
//! layer of nodes nearest to a wall is moved to it, so that the mesh fills the edges of the box.

use glam::Vec3;
use splashdown_gpu::WgslModule;
use splashdown_io::Mesh;

use crate::boundary::{Images, closed_bounds};
use crate::scene::Domain;
use crate::state::Params;
use crate::surface::components::retain_vertices;
use crate::surface::params::LAYER_MARGINS;

/// The WGSL side: folding, reflections and tests of nodes. Imports surface/lattice.
pub(crate) const WGSL: WgslModule = WgslModule { name: "surface/walls", source: include_str!("walls.wgsl") };

/// In place of the coordinate of an open side, in m: beyond any coordinate.
const OPEN: f32 = 1e30;

/// The closed sides of a box. The mesh touches them and does not pass them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walls {
    /// Lower corner in m; -1e30 where the side is open.
    pub(super) low: Vec3,
    /// Upper corner in m; 1e30 where the side is open.
    pub(super) high: Vec3,
}

impl Walls {
    /// No side is closed.
    pub const NONE: Self = Self { low: Vec3::splat(-OPEN), high: Vec3::splat(OPEN) };

    /// The box between two corners (m); `closed` says which sides are walls: of each axis the lower and the upper one.
    /// In a box that is narrower than a support radius
    /// of the surface the field is too low, because images of images are left out.
    pub fn new(min: [f32; 3], max: [f32; 3], closed: [[bool; 2]; 3]) -> Self {
        let mut walls = Self::NONE;
        for (axis, [low, high]) in closed.into_iter().enumerate() {
            if low {
                walls.low[axis] = min[axis];
            }
            if high {
                walls.high[axis] = max[axis];
            }
        }
        walls
    }

    /// The closed sides of a scene.
    pub fn of_domain(domain: &Domain) -> Self {
        Self::new(domain.min.into(), domain.max.into(), domain.closed)
    }

    /// The closed sides of a simulation.
    pub(crate) fn of_params(params: &Params) -> Self {
        let [low, high] = closed_bounds(params.domain_min, params.domain_max, params.closed);
        Self { low: low.max(Vec3::splat(-OPEN)), high: high.min(Vec3::splat(OPEN)) }
    }

    /// The reflections at the walls.
    pub(super) fn images(&self) -> Images {
        Images::between(self.low, self.high)
    }

    /// The coordinate in front of the walls of an axis at which the field has the same value.
    #[inline(always)]
    pub(super) fn folded(low: f32, high: f32, coordinate: f32) -> f32 {
        let above = if coordinate < low { 2.0 * low - coordinate } else { coordinate };
        if above > high { 2.0 * high - above } else { above }
    }

    /// The unit normal of the wall on which a vertex lies.
    pub(super) fn normal_at(&self, x: Vec3) -> Option<Vec3> {
        (0..3).find_map(|axis| match x[axis] {
            at if at == self.low[axis] => Some(-Vec3::AXES[axis]),
            at if at == self.high[axis] => Some(Vec3::AXES[axis]),
            _ => None,
        })
    }

    /// True if a vertex lies on a wall.
    #[inline(always)]
    pub(super) fn touch(&self, x: Vec3) -> bool {
        (x.cmpeq(self.low) | x.cmpeq(self.high)).any()
    }

    /// The place of a vertex that smoothing moves from `own` by `step`: a vertex on a wall, or at the
    /// layer of nodes beside it, remains there, and no other vertex gets as close. `margin`:
    /// [`Lattice::wall_margin`](super::params::Lattice).
    #[inline(always)]
    pub(super) fn slid(&self, own: Vec3, step: Vec3, margin: f32) -> Vec3 {
        let beside = (LAYER_MARGINS + 1.0) * margin;
        let beside_wall =
            (own - self.low).cmple(Vec3::splat(beside)) | (self.high - own).cmple(Vec3::splat(beside));
        let clear = (LAYER_MARGINS + 2.0) * margin;
        let free = (own + step).min(self.high - clear).max(self.low + clear);
        Vec3::select(beside_wall, own, free)
    }
}

/// Removes the triangles that lie in a wall, and their vertices; returns the number of triangles. What remains is the free
/// surface, open along the walls, and a strip of up to a cell along its edge, for pictures with another model of the tank.
pub fn remove_caps(mesh: &mut Mesh, walls: &Walls) -> usize {
    let sides = |vertex: u32| {
        let x = Vec3::from(mesh.vertices[vertex as usize]);
        x.cmpeq(walls.low).bitmask() | x.cmpeq(walls.high).bitmask() << 3
    };
    let before = mesh.triangles.len();
    let free: Vec<[u32; 3]> = mesh
        .triangles
        .iter()
        .copied()
        .filter(|t| t.map(sides).into_iter().reduce(|a, b| a & b) == Some(0))
        .collect();
    let mut is_used = vec![false; mesh.vertices.len()];
    free.as_flattened().iter().for_each(|&vertex| is_used[vertex as usize] = true);
    mesh.triangles = free;
    retain_vertices(mesh, &is_used);
    before - mesh.triangles.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{SurfaceParams, reconstruct_with};
    use glam::Vec3Swizzles;
    use splashdown_gpu::{CpuExecutor, Executor};

    const SPACING: f32 = 0.05;
    /// The walls: a box without a lid whose sides lie between the nodes of the surface.
    const LOW: [f32; 3] = [-0.013, 0.007, 0.021];
    const SIDE: f32 = 0.6;

    fn walls() -> Walls {
        Walls::new(LOW, LOW.map(|low| low + SIDE), [[true, true], [true, false], [true, true]])
    }

    /// Water that covers the floor of the box, half as high as wide, with jitter.
    fn still_water() -> Vec<[f32; 3]> {
        let unit = |i: u32| splashdown_gpu::testing::noise(i) as f32 / u32::MAX as f32 - 0.5;
        (0..12 * 6 * 12_u32)
            .map(|i| {
                let lattice = [i % 12, i / 12 % 6, i / 72];
                std::array::from_fn(|axis| {
                    LOW[axis] + SPACING * (lattice[axis] as f32 + 0.5 + 0.1 * unit(3 * i + axis as u32))
                })
            })
            .collect()
    }

    fn mesh(params: &SurfaceParams) -> Mesh {
        reconstruct_with(&still_water(), params, &mut Executor::from(CpuExecutor::new())).unwrap().0
    }

    fn params(smoothing_iterations: u32) -> SurfaceParams {
        SurfaceParams { walls: walls(), smoothing_iterations, ..SurfaceParams::new(SPACING) }
    }

    /// The vertices that are farther outside than `tolerance`, and those that are near a wall (by a quarter of a spacing)
    /// and farther from it than `tolerance`.
    fn misplaced(mesh: &Mesh, tolerance: f32) -> [usize; 2] {
        let Walls { low, high } = walls();
        let distance = |x: &[f32; 3]| {
            let x = Vec3::from(*x);
            (x - low).min(high - x).min_element()
        };
        let outside = mesh.vertices.iter().filter(|x| distance(x) < -tolerance).count();
        let near = |x: &&[f32; 3]| (tolerance..0.25 * SPACING).contains(&distance(x));
        [outside, mesh.vertices.iter().filter(near).count()]
    }

    #[test]
    fn the_mesh_touches_the_walls_and_does_not_pass_them() {
        for smoothing in [0, 20] {
            let mesh = mesh(&params(smoothing));
            let topology = mesh.topology().unwrap();
            assert!(topology.is_watertight() && topology.components == 1, "{topology}");
            assert_eq!(misplaced(&mesh, 0.0)[0], 0);
            assert_eq!(misplaced(&mesh, 0.02 * SPACING)[1], 0);
            let mut on_walls = 0;
            for (x, n) in mesh.vertices.iter().zip(&mesh.normals) {
                if let Some(wall) = walls().normal_at((*x).into()) {
                    on_walls += 1;
                    assert!(Vec3::from(*n).angle_between(wall).to_degrees() < 1.0, "{x:?} {n:?}");
                }
            }
            assert!(on_walls > mesh.vertices.len() / 3, "{on_walls} of {}", mesh.vertices.len());
        }
        // Negative control: without walls the surface passes them or keeps away.
        let free = mesh(&SurfaceParams::new(SPACING));
        assert!(misplaced(&free, 0.02 * SPACING).iter().sum::<usize>() > free.vertices.len() / 3);
    }

    #[test]
    fn still_water_fills_the_box_to_its_level() {
        let exact = f64::from(SIDE * SIDE * 0.5 * SIDE);
        for smoothing in [0, 20] {
            let volume = mesh(&params(smoothing)).volume();
            assert!((volume / exact - 1.0).abs() < 0.005, "{smoothing}: {volume} of {exact}");
        }
        let mesh = mesh(&params(20));
        let level = LOW[1] + 0.5 * SIDE;
        let Walls { low, high } = walls();
        let mut free = 0;
        for x in &mesh.vertices {
            let x = Vec3::from(*x);
            let aside = (x - low).min(high - x).xz();
            if aside.min_element() > 0.0 && x.y > LOW[1] + SPACING {
                free += 1;
                assert!((x.y - level).abs() < 0.05 * SPACING, "{x}");
            }
        }
        assert!(free > 100);
        // Negative control: without walls the volume is wrong.
        let free = self::mesh(&SurfaceParams::new(SPACING));
        assert!((free.volume() / exact - 1.0).abs() > 0.015, "{} of {exact}", free.volume());
    }

    #[test]
    fn caps_can_be_removed() {
        let mut open = mesh(&params(0));
        let area = |mesh: &Mesh| -> f32 {
            let corner = |v: u32| Vec3::from(mesh.vertices[v as usize]);
            mesh.triangles
                .iter()
                .map(|&[a, b, c]| 0.5 * (corner(b) - corner(a)).cross(corner(c) - corner(a)).length())
                .sum()
        };
        let whole = area(&open);
        let vertices = open.vertices.len();
        assert!(remove_caps(&mut open, &walls()) > 0);
        assert!(open.vertices.len() < vertices / 2 && open.normals.len() == open.vertices.len());
        let largest = open.triangles.as_flattened().iter().max();
        assert_eq!(largest.map(|&vertex| vertex as usize + 1), Some(open.vertices.len()));
        // The level, and the narrow strips along the edges of the box.
        let ratio = area(&open) / (SIDE * SIDE);
        assert!((0.99..1.05).contains(&ratio), "{ratio}");
        assert!(whole > 3.5 * SIDE * SIDE);
        assert_eq!(remove_caps(&mut open, &Walls::NONE), 0);
    }
}
