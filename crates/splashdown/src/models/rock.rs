//! A faceted boulder, and noise for rough surfaces.

use glam::{IVec3, Vec3, vec3};

use super::shape::meet;

/// Number of facets of a boulder.
const FACETS: u8 = 22;

/// A pseudo-random number in [0, 1), a hash of an integer (Wang 2007).
pub(super) fn random(seed: u32) -> f32 {
    let mut x = (seed ^ 61) ^ (seed >> 16);
    x = x.wrapping_mul(9);
    x ^= x >> 4;
    x = x.wrapping_mul(0x27d4_eb2d);
    x ^= x >> 15;
    (x >> 8) as f32 / 16_777_216.0
}

/// A convex stone, bounded by tangent planes of an ellipsoid with random offsets.
pub(super) struct Boulder {
    center: Vec3,
    /// Outward unit normal, and distance from the centre in m.
    planes: Vec<(Vec3, f32)>,
    /// Radius of the bounding sphere in m.
    reach: f32,
}

impl Boulder {
    /// Centre and radii in m; the seed decides where the facets lie.
    pub(super) fn new(center: Vec3, radii: Vec3, seed: u32) -> Self {
        let golden_angle = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
        let planes = (0..FACETS).map(|i| {
            let k = seed.wrapping_mul(977) + 3 * u32::from(i);
            let y = 1.0 - (2.0 * f32::from(i) + 1.0) / f32::from(FACETS);
            let flat = (1.0 - y * y).sqrt();
            let (sin, cos) = (golden_angle * f32::from(i) + random(seed) * 6.0).sin_cos();
            let wobble = 0.7 * (vec3(random(k), random(k + 1), 0.5) - 0.5);
            let normal = (vec3(flat * cos, y, flat * sin) + wobble).normalize_or(Vec3::Y);
            (normal, (radii * normal).length() * (0.88 + 0.2 * random(k + 2)))
        });
        Self { center, planes: planes.collect(), reach: 1.3 * radii.max_element() }
    }

    /// Distance in m; edges are rounded over `width` (m).
    pub(super) fn distance(&self, p: Vec3, width: f32) -> f32 {
        let q = p - self.center;
        // Far away the bounding sphere is accurate enough and much cheaper.
        let far = q.length() - self.reach;
        if far > 0.1 {
            return far;
        }
        self.planes.iter().fold(f32::MIN / 2.0, |d, (normal, reach)| meet(d, q.dot(*normal) - reach, width))
    }
}

/// Smooth noise in [-1, 1] with a wavelength of about 1.
pub(super) fn noise(p: Vec3) -> f32 {
    let cell = p.floor();
    let t = p - cell;
    let t = t * t * (3.0 - 2.0 * t);
    let cell = cell.as_ivec3();
    let at = |x: i32, y: i32, z: i32| {
        let c = (cell + IVec3::new(x, y, z)).as_uvec3();
        random(c.x.wrapping_mul(73_856_093) ^ c.y.wrapping_mul(19_349_663) ^ c.z.wrapping_mul(83_492_791))
    };
    let mix = |a: f32, b: f32, t: f32| a + t * (b - a);
    let along_x = |y: i32, z: i32| mix(at(0, y, z), at(1, y, z), t.x);
    let along_y = |z: i32| mix(along_x(0, z), along_x(1, z), t.y);
    2.0 * mix(along_y(0), along_y(1), t.z) - 1.0
}
