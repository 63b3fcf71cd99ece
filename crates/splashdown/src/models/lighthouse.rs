//! A lighthouse on its rock.

use glam::{Vec3, Vec3Swizzles as _, vec2, vec3};
use splashdown_io::Mesh;

use super::polygonise::polygonise;
use super::rock::{Boulder, noise};
use super::shape::{
    bone, cuboid, cut, cylinder, join, lathe, meet, polygon, profile, rectangle, ring, sector_y, turn_y,
};

/// Height of the rock's flat top, on which the tower stands, in m.
const TOP: f32 = 0.19;

/// Height of the gallery's floor in m.
const GALLERY: f32 = 0.735;

pub(super) fn lighthouse() -> Mesh {
    let stones = stones();
    let mut outline = vec![[0.0, TOP - 0.06], [0.128, TOP - 0.06], [0.126, TOP + 0.012], [0.112, TOP + 0.02]];
    for i in 0..=16_u8 {
        let t = f32::from(i) / 16.0;
        outline.push([tower_radius(t), TOP + 0.02 + t * (0.675 - TOP)]);
    }
    outline.extend([[0.076, 0.705], [0.098, 0.722], [0.108, 0.724], [0.108, GALLERY], [0.0, GALLERY]]);
    let tower = profile(&outline);
    let roof = profile(&[
        [0.0, 0.852],
        [0.062, 0.852],
        [0.068, 0.856],
        [0.066, 0.863],
        [0.052, 0.878],
        [0.038, 0.898],
        [0.024, 0.916],
        [0.01, 0.926],
        [0.0, 0.926],
    ]);
    polygonise(vec3(-0.39, -0.02, -0.36), vec3(0.39, 1.02, 0.39), 0.0071, |p| {
        let mut d = rock(p, &stones);
        if p.y > TOP - 0.08 && p.xz().length() < 0.16 {
            let body = openings(p, lathe(p, &tower, 0.003));
            d = join(d, body, 0.006).min(gallery(p)).min(lantern(p)).min(lathe(p, &roof, 0.002));
            d = join(d, (p - vec3(0.0, 0.94, 0.0)).length() - 0.017, 0.01);
            d = join(d, bone(p, vec3(0.0, 0.94, 0.0), vec3(0.0, 0.993, 0.0), 0.0075, 0.0055), 0.012);
        } else {
            d = d.min(cylinder(p, 0.135, TOP - 0.05, 1.0, 0.0));
        }
        meet(d, -p.y, 0.012)
    })
}

/// Radius of the tower in m, from its foot (t = 0) to the gallery (t = 1).
fn tower_radius(t: f32) -> f32 {
    0.062 + 0.04 * (1.0 - t).powf(1.7)
}

fn stones() -> Vec<Boulder> {
    let stone = |x, y, z, r: [f32; 3], seed| Boulder::new(vec3(x, y, z), Vec3::from(r), seed);
    vec![
        stone(0.0, 0.03, 0.0, [0.25, 0.17, 0.23], 1),
        stone(0.2, 0.0, 0.07, [0.13, 0.11, 0.12], 2),
        stone(-0.19, 0.01, -0.1, [0.14, 0.13, 0.13], 3),
        stone(-0.17, 0.0, 0.16, [0.12, 0.075, 0.1], 4),
        stone(0.13, 0.01, -0.18, [0.13, 0.12, 0.11], 5),
        stone(0.07, 0.0, 0.23, [0.1, 0.06, 0.09], 6),
        stone(-0.3, 0.0, 0.03, [0.06, 0.045, 0.06], 7),
        stone(0.29, 0.0, -0.1, [0.06, 0.055, 0.07], 8),
    ]
}

fn rock(p: Vec3, stones: &[Boulder]) -> f32 {
    // High above the rock a lower bound of the distance is sufficient.
    if p.y > TOP + 0.12 {
        return p.y - TOP - 0.03;
    }
    let d = stones.iter().fold(1.0, |d, stone| join(d, stone.distance(p, 0.012), 0.02));
    let top = cylinder(p, 0.15, 0.05, TOP, 0.015);
    // The stairs from the door down the rock.
    let stairs = (0..7_u8).fold(1.0_f32, |d, i| {
        let i = f32::from(i);
        let (height, z) = (0.5 * (TOP - 0.026 * i + 0.012), 0.115 + 0.026 * i);
        d.min(cuboid(p - vec3(0.0, height - 0.006, z), vec3(0.036, height, 0.02), 0.003))
    });
    // The rock above the stairs is cut away along a slope of 45 degrees.
    let slope = (TOP + 0.135 - p.z - p.y) * std::f32::consts::FRAC_1_SQRT_2;
    let d = cut(d, (p.x.abs() - 0.046).max(slope).max(0.1 - p.z), 0.02);
    let rough = if d.abs() < 0.05 { 0.006 * noise(28.0 * p) + 0.0025 * noise(61.0 * p) } else { 0.0 };
    join(join(d + rough, top, 0.03), stairs, 0.006)
}

/// Cuts a door and windows, each with an arch and a raised frame, and adds bands around the tower.
fn openings(p: Vec3, tower: f32) -> f32 {
    let mut d = tower;
    for y in [0.345, 0.505, 0.655] {
        let t = (y - TOP - 0.02) / (0.675 - TOP);
        d = join(d, ring(p - vec3(0.0, y, 0.0), tower_radius(t) - 0.001, 0.009), 0.005);
    }
    let arch = |p: Vec3, half_width: f32, height: f32| {
        let wall = rectangle(vec2(p.x, p.y - 0.5 * height), vec2(half_width, 0.5 * height), 0.0);
        wall.min(vec2(p.x, p.y - height).length() - half_width)
    };
    let mut hole = |q: Vec3, half_width: f32, height: f32, radius: f32| {
        if q.z > 0.0 {
            let frame = meet(arch(q, half_width + 0.012, height), q.z - radius - 0.009, 0.004);
            d = join(d, frame.max(radius - 0.03 - q.z), 0.003);
            let opening = arch(q, half_width, height).max(radius - 0.012 - q.z);
            d = cut(d, opening, 0.003);
        }
    };
    hole(p - vec3(0.0, TOP + 0.012, 0.0), 0.021, 0.056, 0.103);
    for (angle, y) in [(0.0, 0.405), (90.0, 0.31), (180.0, 0.42), (270.0, 0.31), (20.0, 0.57), (200.0, 0.57)]
    {
        let t = (y - TOP - 0.02) / (0.675 - TOP);
        hole(turn_y(p, angle) - vec3(0.0, y, 0.0), 0.0125, 0.03, tower_radius(t));
    }
    d
}

/// The railing round the gallery.
fn gallery(p: Vec3) -> f32 {
    let q = sector_y(p, 14.0);
    let (foot, head) = (vec3(0.1, GALLERY - 0.005, 0.0), vec3(0.1, GALLERY + 0.052, 0.0));
    let post = bone(q, foot, head, 0.0068, 0.0068);
    join(post, ring(p - head.with_x(0.0), 0.1, 0.007), 0.006)
}

/// The lantern room: a low wall, panes set back between mullions, and a cornice.
fn lantern(p: Vec3) -> f32 {
    let wall = cylinder(p, 0.054, GALLERY - 0.01, GALLERY + 0.034, 0.003);
    let glass = cylinder(p, 0.043, GALLERY, 0.86, 0.0);
    let q = sector_y(p, 8.0);
    let mullion = cuboid(q - vec3(0.047, 0.8, 0.0), vec3(0.0055, 0.06, 0.005), 0.002);
    let across = ring(p - vec3(0.0, 0.811, 0.0), 0.0465, 0.005);
    let cornice = polygon(
        vec2(p.xz().length(), p.y),
        &[vec2(-1.0, 0.84), vec2(0.05, 0.84), vec2(0.06, 0.853), vec2(0.06, 0.862), vec2(-1.0, 0.862)],
        0.001,
    );
    join(join(glass, mullion.min(across), 0.004), wall.min(cornice), 0.003)
}
