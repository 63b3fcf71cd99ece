//! Volume, centre of mass and inertia.

use glam::{DMat3, DVec3, Mat3, UVec3, Vec3};
use splashdown_io::Mesh;

use super::field::DistanceField;

/// Mass properties at a density of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Volume in m^3.
    pub volume: f32,
    /// Centre of mass in the mesh's frame, in m.
    pub center: Vec3,
    /// Inertia about the centre divided by the density, in m^5.
    pub inertia: Mat3,
}

impl MassProperties {
    /// The inverse of the inertia, in 1/m^5; not finite if there is none. In f64: in f32 the determinant of bodies of a few
    /// millimetres is zero.
    pub fn inverse_inertia(&self) -> Mat3 {
        self.inertia.as_dmat3().inverse().as_mat3()
    }
}

/// Largest relative difference between the volumes of the polyhedron formula and the distance field. Beyond
/// it the mesh overlaps itself or faces the wrong way, and the distance field is used.
const TOLERANCE: f64 = 0.1;

/// Sums of 1, x and x x^T over a solid.
#[derive(Clone, Copy)]
struct Moments {
    volume: f64,
    first: DVec3,
    second: DMat3,
}

impl Moments {
    const NONE: Self = Self { volume: 0.0, first: DVec3::ZERO, second: DMat3::ZERO };

    fn finish(self) -> MassProperties {
        if self.volume <= 0.0 {
            return MassProperties { volume: 0.0, center: Vec3::ZERO, inertia: Mat3::ZERO };
        }
        let center = self.first / self.volume;
        let spread = self.second - outer(center, center) * self.volume;
        let trace = spread.x_axis.x + spread.y_axis.y + spread.z_axis.z;
        let inertia = DMat3::IDENTITY * trace - spread;
        MassProperties { volume: self.volume as f32, center: center.as_vec3(), inertia: inertia.as_mat3() }
    }
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Mass properties from the formula for polyhedra if the mesh is closed and the volume agrees with the
/// distance field; otherwise from the cells of the distance field. The volume of a shell is its area times
/// its thickness.
pub(super) fn properties(
    mesh: &Mesh,
    closed: bool,
    field: &DistanceField,
    half_thickness: Option<f32>,
) -> MassProperties {
    if let Some(half) = half_thickness {
        return by_area(mesh, f64::from(2.0 * half)).finish();
    }
    let counted = by_cells(field);
    let exact = by_formula(mesh);
    if closed && (exact.volume - counted.volume).abs() <= TOLERANCE * counted.volume {
        return exact.finish();
    }
    counted.finish()
}

/// Sums over the tetrahedra from the origin to every triangle (Eberly, Polyhedral Mass Properties, 2002, in
/// another form).
fn by_formula(mesh: &Mesh) -> Moments {
    let mut sum = Moments::NONE;
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| Vec3::from(mesh.vertices[v as usize]).as_dvec3());
        let volume = a.dot(b.cross(c)) / 6.0;
        let total = a + b + c;
        sum.volume += volume;
        sum.first += volume * total / 4.0;
        let squares = outer(a, a) + outer(b, b) + outer(c, c) + outer(total, total);
        sum.second += squares * (volume / 20.0);
    }
    sum
}

fn by_cells(field: &DistanceField) -> Moments {
    let mut sum = Moments::NONE;
    let cell = f64::from(field.cell_size);
    for (k, value) in field.values.iter().enumerate() {
        let part = (0.5 - value.x / field.cell_size).clamp(0.0, 1.0);
        if part > 0.0 {
            let [nx, ny, _] = field.nodes;
            let k = k as u32;
            let x = field.node(UVec3::new(k % nx, k / nx % ny, k / (nx * ny))).as_dvec3();
            let volume = f64::from(part) * cell * cell * cell;
            sum.volume += volume;
            sum.first += volume * x;
            sum.second += outer(x, x) * volume;
        }
    }
    sum
}

fn by_area(mesh: &Mesh, thickness: f64) -> Moments {
    let mut sum = Moments::NONE;
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| Vec3::from(mesh.vertices[v as usize]).as_dvec3());
        let volume = 0.5 * (b - a).cross(c - a).length() * thickness;
        let total = a + b + c;
        sum.volume += volume;
        sum.first += volume * total / 3.0;
        let squares = outer(a, a) + outer(b, b) + outer(c, c) + outer(total, total);
        sum.second += squares * (volume / 12.0);
    }
    sum
}
