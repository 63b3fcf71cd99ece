//! Machine parts: a gear, a paddle wheel and a mixing drum with their axes along z, and a bent pipe.

use glam::{Mat2, Vec2, Vec3, Vec3Swizzles as _, vec2, vec3};
use splashdown_io::Mesh;

use super::polygonise::polygonise;
use super::shape::{cuboid, cut, extrude, join, polygon, rectangle, sector};

pub(super) fn gear() -> Mesh {
    let tooth = [
        vec2(0.16, 0.0205),
        vec2(0.185, 0.0165),
        vec2(0.216, 0.008),
        vec2(0.216, -0.008),
        vec2(0.185, -0.0165),
        vec2(0.16, -0.0205),
    ];
    polygonise(vec3(-0.235, -0.235, -0.06), vec3(0.235, 0.235, 0.06), 0.0048, |p| {
        let (flat, r, z) = (p.xy(), p.xy().length(), p.z.abs());
        let teeth = polygon(sector(flat, 20.0), &tooth, 0.003);
        let rim = join(teeth, r - 0.178, 0.01).max(0.148 - r);
        let mut d = extrude(rim, z - 0.034, 0.005);
        d = join(d, extrude(r - 0.155, z - 0.014, 0.005), 0.012);
        d = join(d, extrude(r - 0.062, z - 0.04, 0.006), 0.012);
        let hole = (sector(flat, 6.0) - vec2(0.105, 0.0)).length() - 0.027;
        d = cut(d, hole, 0.006);
        let bore = (r - 0.031).min(rectangle(flat - vec2(0.0, 0.03), vec2(0.009, 0.012), 0.0));
        cut(d, bore, 0.005)
    })
}

pub(super) fn paddle_wheel() -> Mesh {
    polygonise(vec3(-0.27, -0.27, -0.15), vec3(0.27, 0.27, 0.15), 0.0064, |p| {
        let (r, z) = (p.xy().length(), p.z.abs());
        let q = sector(p.xy(), 12.0).extend(p.z);
        // The boards are slightly inclined, as on mill wheels, and lie between two rims on spokes.
        let lean = Mat2::from_angle(0.18) * (q.xy() - vec2(0.2, 0.0));
        let board = cuboid(lean.extend(p.z), vec3(0.05, 0.0095, 0.086), 0.006);
        let rim = rectangle(vec2(r - 0.182, z - 0.062), vec2(0.014, 0.0098), 0.007);
        let inner = rectangle(vec2(r - 0.115, z - 0.062), vec2(0.0095, 0.0085), 0.007);
        let spoke = cuboid(vec3(q.x - 0.11, q.y, z - 0.062), vec3(0.085, 0.0088, 0.0088), 0.006);
        let frame = join(spoke, rim.min(inner), 0.006);
        let hub = extrude(r - 0.042, z - 0.082, 0.008);
        let hub = join(hub, extrude(r - 0.052, (z - 0.062).abs() - 0.014, 0.006), 0.006);
        let axle = extrude(r - 0.02, z - 0.125, 0.006);
        join(join(board, frame, 0.006), join(hub, axle, 0.008), 0.008)
    })
}

pub(super) fn drum() -> Mesh {
    polygonise(vec3(-0.28, -0.28, -0.24), vec3(0.28, 0.28, 0.2), 0.0088, |p| {
        let r = p.xy().length();
        let mut d = extrude(r - 0.25, p.z.abs() - 0.17, 0.02);
        // The cavity with the lifters, and the mouth.
        let cavity = extrude(r - 0.225, p.z.abs() - 0.145, 0.03);
        let q = sector(Mat2::from_angle(0.26) * p.xy(), 6.0);
        let lean = Mat2::from_angle(-0.35) * (q - vec2(0.205, 0.0));
        let lifter = rectangle(lean, vec2(0.045, 0.011), 0.006);
        d = cut(d, cut(cavity, lifter, 0.02), 0.01);
        let mouth = (r - 0.13).max(-p.z);
        d = cut(d, mouth, 0.012);
        // A lip around the mouth, two running rings, and the shaft at the back.
        let lip = rectangle(vec2(r - 0.142, p.z - 0.172), vec2(0.015, 0.014), 0.008);
        d = join(d, lip, 0.008);
        let tyre = rectangle(vec2(r - 0.253, p.z.abs() - 0.1), vec2(0.016, 0.018), 0.01);
        d = join(d, tyre, 0.006);
        let shaft = extrude(r - 0.034, (p.z + 0.19).abs() - 0.035, 0.006);
        let flange = extrude(r - 0.075, (p.z + 0.172).abs() - 0.012, 0.005);
        join(d, join(shaft, flange, 0.01), 0.008)
    })
}

/// The distance from the pipe's centre line, and the arc length along that line from the mouth, both in m.
/// The line runs up from the mouth, through a bend, and on along -x.
fn spout_line(p: Vec3) -> (f32, f32) {
    const RISE: f32 = 0.05;
    const BEND: f32 = 0.09;
    let q = p.xy() - vec2(-BEND, RISE);
    let (side, along) = if q.y < 0.0 && q.x > -BEND {
        (p.x, p.y)
    } else if q.x < 0.0 {
        (q.y - BEND, RISE + BEND * std::f32::consts::FRAC_PI_2 - q.x)
    } else {
        (q.length() - BEND, RISE + BEND * q.y.atan2(q.x))
    };
    (Vec2::new(side, p.z).length(), along)
}

pub(super) fn spout() -> Mesh {
    polygonise(vec3(-0.3, -0.02, -0.1), vec3(0.07, 0.24, 0.1), 0.0042, |p| {
        let (r, s) = spout_line(p);
        let end = 0.05 + 0.09 * std::f32::consts::FRAC_PI_2 + 0.16;
        let mut d = extrude(r - 0.039, (s - 0.5 * end).abs() - 0.5 * end, 0.006);
        d = join(d, rectangle(vec2(r - 0.034, s - 0.014), vec2(0.0125, 0.014), 0.006), 0.005);
        d = join(d, rectangle(vec2(r - 0.034, s - 0.215), vec2(0.011, 0.008), 0.004), 0.005);
        d = join(d, rectangle(vec2(r - 0.03, s - end + 0.009), vec2(0.05, 0.009), 0.004), 0.01);
        // Six bolts on the flange.
        let around = sector(vec2(p.y - 0.14, p.z), 6.0) - vec2(0.062, 0.0);
        let bolt = extrude(around.length() - 0.0085, (s - end + 0.022).abs() - 0.008, 0.003);
        d = join(d, bolt, 0.003);
        cut(d, r - 0.03, 0.006)
    })
}
