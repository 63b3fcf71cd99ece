//! Floating models: a tug and a beacon buoy.

use glam::{DVec3, Vec3, vec2, vec3};
use splashdown_io::Mesh;

use super::polygonise::polygonise;
use super::shape::{
    bone, cuboid, cut, cylinder, distance_of, join, lathe, meet, profile, rectangle, ring, sector_y,
    smooth_step,
};

/// Moves the centre of mass of a closed mesh to the origin.
fn centred(mut mesh: Mesh) -> Mesh {
    let (mut volume, mut moment) = (0.0, DVec3::ZERO);
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|i| Vec3::from(mesh.vertices[i as usize]).as_dvec3());
        let part = a.dot(b.cross(c)) / 6.0;
        volume += part;
        moment += part / 4.0 * (a + b + c);
    }
    let center = (moment / volume).as_vec3();
    for vertex in &mut mesh.vertices {
        *vertex = (Vec3::from(*vertex) - center).to_array();
    }
    mesh
}

/// Half the length of the tug in m; its bow is at +x.
const HALF_LENGTH: f32 = 0.29;

/// Half its beam in m.
const HALF_BEAM: f32 = 0.105;

/// Height of the bulwark's top above the keel in m, at s = x / half length.
fn sheer(s: f32) -> f32 {
    0.118 + 0.05 * s.max(0.0).powi(2) + 0.022 * s.min(0.0).powi(2)
}

/// Height of the keel in m.
fn keel(s: f32) -> f32 {
    0.11 * smooth_step(0.55, 1.08, s).powi(2) + 0.075 * smooth_step(-0.62, -1.1, s)
}

/// An implicit function that is negative inside the hull shrunk by `inset` (m).
fn hull_form(p: Vec3, inset: f32) -> f32 {
    let s = (p.x / (HALF_LENGTH - inset)).clamp(-1.3, 1.3);
    let plan = if s > -0.15 {
        1.0 - ((s + 0.15) / 1.15).powf(2.3)
    } else {
        1.0 - 0.62 * ((-s - 0.15) / 0.85).powf(3.2)
    };
    let depth = ((p.y - keel(s)) / (sheer(s) - keel(s))).max(0.0);
    let fullness = 0.34 + 0.5 * smooth_step(0.1, 1.0, s) + 0.25 * smooth_step(-0.5, -1.0, s);
    let flare = 1.0 + 0.18 * smooth_step(0.2, 0.9, s) * (depth - 1.0);
    let width = (HALF_BEAM * plan * flare * (depth + 1e-4).powf(fullness)).max(-0.1) - inset;
    let stern = -HALF_LENGTH + inset - p.x;
    let below = keel(s) + inset - p.y;
    // The stem and the transom's edges are rounded.
    let side = vec2(p.z, 0.004).length() - width;
    meet(meet(side, below, 0.012), 0.9 * stern, 0.014)
}

pub(super) fn hull() -> Mesh {
    let mesh = polygonise(vec3(-0.33, -0.03, -0.13), vec3(0.33, 0.34, 0.13), 0.0052, |p| {
        let s = p.x / HALF_LENGTH;
        let body = distance_of(p, 1e-3, |q| hull_form(q, 0.0));
        let body = meet(body, p.y - sheer(s), 0.008);
        // The deck lies below the top of the bulwark, whose inner side follows the shape of the hull.
        let well = distance_of(p, 1e-3, |q| hull_form(q, 0.015)).max(sheer(s) - 0.028 - p.y);
        let mut d = cut(body, well, 0.005);
        // A rubbing strake around the hull, and a skeg below it.
        let strake =
            vec2(distance_of(p, 1e-3, |q| hull_form(q, 0.0)), p.y - sheer(s) + 0.03).length() - 0.009;
        d = join(d, strake, 0.004);
        let skeg = cuboid(p - vec3(-0.13, 0.02, 0.0), vec3(0.12, 0.024, 0.009), 0.006);
        d = join(d, skeg, 0.02);
        join(d, upper_works(p), 0.006)
    });
    centred(mesh)
}

fn upper_works(p: Vec3) -> f32 {
    let deck = 0.085;
    // The deckhouse: long and low, rounded in front.
    let house = rectangle(vec2(p.x + 0.035, p.z), vec2(0.125, 0.058), 0.04);
    let mut d = meet(house, (p.y - deck - 0.04).abs() - 0.045, 0.007);
    let roof = rectangle(vec2(p.x + 0.035, p.z), vec2(0.131, 0.064), 0.044);
    d = join(d, meet(roof, (p.y - deck - 0.083).abs() - 0.006, 0.004), 0.003);
    // The wheelhouse, with windows all round.
    let q = p - vec3(0.035, deck + 0.125, 0.0);
    let mut wheelhouse = meet(rectangle(vec2(q.x, q.z), vec2(0.044, 0.046), 0.02), q.y.abs() - 0.043, 0.005);
    for (x, z) in [(0.0, 0.0), (-0.024, 1.0), (0.016, 1.0)] {
        // Three windows in a row in front; z != 0 stands for windows on both sides.
        let window = if z > 0.0 {
            cuboid(vec3(q.x - x, q.y - 0.012, q.z.abs() - 0.05), vec3(0.0135, 0.0165, 0.0095), 0.004)
        } else {
            let middle = (q.z / 0.026).round().clamp(-1.0, 1.0) * 0.026;
            cuboid(vec3(q.x.abs() - 0.048, q.y - 0.012, q.z - middle), vec3(0.0095, 0.0165, 0.0095), 0.004)
        };
        wheelhouse = cut(wheelhouse, window, 0.003);
    }
    let cap = rectangle(vec2(q.x, q.z), vec2(0.053, 0.054), 0.024);
    wheelhouse = join(wheelhouse, meet(cap, (q.y - 0.046).abs() - 0.0065, 0.005), 0.003);
    d = join(d, wheelhouse, 0.005);
    // Portholes in the deckhouse.
    let x = ((p.x + 0.045) / 0.042).round().clamp(-1.0, 1.0) * 0.042 - 0.045;
    let porthole = vec3(p.x - x, p.y - deck - 0.046, 0.0).length() - 0.0135;
    d = cut(d, porthole.max(0.052 - p.z.abs()), 0.003);
    // The funnel leans back; it has a band and an open top.
    let lean = p - vec3(-0.075 - 0.16 * (p.y - deck - 0.08), 0.0, 0.0);
    let funnel = cylinder(lean, 0.029, deck + 0.05, deck + 0.172, 0.004);
    let funnel = join(funnel, cylinder(lean, 0.0335, deck + 0.136, deck + 0.158, 0.004), 0.003);
    let funnel = cut(funnel, cylinder(lean, 0.0195, deck + 0.15, deck + 0.3, 0.0), 0.004);
    d = join(d, funnel, 0.008);
    // Mast, towing bitts and an anchor winch.
    let mast = bone(p, vec3(0.012, deck + 0.16, 0.0), vec3(-0.004, deck + 0.245, 0.0), 0.0065, 0.0055);
    let yard = bone(p, vec3(0.001, deck + 0.218, -0.026), vec3(0.001, deck + 0.218, 0.026), 0.005, 0.005);
    d = join(d, join(mast, yard, 0.004), 0.006);
    let side = vec3(p.x, p.y, p.z.abs());
    let bitt = bone(side, vec3(-0.205, 0.08, 0.02), vec3(-0.205, 0.128, 0.02), 0.009, 0.009);
    let bar = bone(p, vec3(-0.205, 0.118, -0.036), vec3(-0.205, 0.118, 0.036), 0.0065, 0.0065);
    let winch = bone(p, vec3(0.165, 0.114, -0.022), vec3(0.165, 0.114, 0.022), 0.016, 0.016);
    d.min(join(bitt, bar, 0.004)).min(winch)
}

pub(super) fn buoy() -> Mesh {
    let float = profile(&[
        [0.0, -0.105],
        [0.045, -0.105],
        [0.12, -0.06],
        [0.151, -0.02],
        [0.151, 0.025],
        [0.13, 0.042],
        [0.05, 0.056],
        [0.0, 0.056],
    ]);
    let cap = profile(&[[0.0, 0.365], [0.04, 0.365], [0.03, 0.38], [0.008, 0.4], [0.0, 0.4]]);
    let mesh = polygonise(vec3(-0.18, -0.28, -0.18), vec3(0.18, 0.44, 0.18), 0.0056, |p| {
        let mut d = lathe(p, &float, 0.006);
        d = join(d, ring(p - vec3(0.0, 0.002, 0.0), 0.157, 0.012), 0.006);
        // Below: a tube with its counterweight.
        d = join(d, cylinder(p, 0.024, -0.2, -0.08, 0.0), 0.03);
        d = join(d, cylinder(p, 0.056, -0.252, -0.192, 0.018), 0.014);
        // Above: four legs with two rings, a platform, the lamp under its cap.
        let q = sector_y(p, 4.0);
        let leg = bone(q, vec3(0.105, 0.04, 0.0), vec3(0.038, 0.285, 0.0), 0.0095, 0.008);
        let lower = ring(p - vec3(0.0, 0.125, 0.0), 0.0815, 0.0065);
        let upper = ring(p - vec3(0.0, 0.205, 0.0), 0.06, 0.006);
        // Two lifting eyes.
        let eye = ring(vec3(p.x.abs() - 0.128, p.z, p.y - 0.054), 0.0135, 0.006);
        d = join(d, join(leg, lower.min(upper), 0.006), 0.012);
        d = join(d, eye, 0.004);
        d = join(d, cylinder(p, 0.054, 0.282, 0.298, 0.004), 0.006);
        d = join(d, cylinder(p, 0.027, 0.29, 0.375, 0.004), 0.008);
        let slat = sector_y(p, 8.0) - vec3(0.03, 0.332, 0.0);
        d = join(d, cuboid(slat, vec3(0.006, 0.04, 0.0055), 0.003), 0.004);
        d = join(d, lathe(p, &cap, 0.003), 0.004);
        join(d, (p - vec3(0.0, 0.409, 0.0)).length() - 0.011, 0.006)
    });
    centred(mesh)
}
