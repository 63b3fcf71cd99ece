//! Diffuse particles and bodies.

use glam::{DVec3, Quat, Vec2, Vec3};
use splashdown::bodies::Body;
use splashdown_gpu::{DispatchSize, bytemuck};

use super::super::harness::{Case, Data};
use super::super::sort_cases::pass;
use super::super::world::{World, params};
use super::now;
use super::pool::{alike, diffuse, numbers};

/// Nodes of a map per axis, and their distance in m.
const NODES: u32 = 9;
const CELL: f32 = 0.25;

/// A half-space, which interpolation reproduces exactly: a normal and an offset in the frame of the mesh.
struct HalfSpace {
    normal: Vec3,
    offset: f32,
    body: Body,
}

fn half_space(number: u32, normal: Vec3, offset: f32, rotation: Quat, velocity: Vec3) -> HalfSpace {
    let body = Body {
        position: Vec3::new(0.02, 0.23, 0.41),
        orientation: rotation.into(),
        velocity,
        angular_velocity: Vec3::new(0.5, -1.0, 2.0),
        center: Vec3::new(0.1, -0.2, 0.05),
        radius: 0.9,
        first_node: number * NODES.pow(3),
        nodes_x: NODES,
        nodes_y: NODES,
        nodes_z: NODES,
        field_min: Vec3::new(-0.9, -1.2, -0.95),
        cell_size: CELL,
        ..bytemuck::Zeroable::zeroed()
    };
    HalfSpace { normal: normal.normalize_or_zero(), offset, body }
}

impl HalfSpace {
    fn map(&self) -> impl Iterator<Item = Vec2> {
        let nodes = (0..NODES).flat_map(|z| (0..NODES).flat_map(move |y| (0..NODES).map(move |x| [x, y, z])));
        nodes.map(|[x, y, z]| {
            let place = self.body.field_min + CELL * Vec3::new(x as f32, y as f32, z as f32);
            Vec2::splat(self.normal.dot(place) - self.offset)
        })
    }
}

pub(super) fn collide() -> Case {
    let world = World::new(params(2.0), 500);
    let mut now = now();
    let n = 900;
    now.count = n - 50;
    let pool = diffuse(&world, n);
    let turned = Quat::from_rotation_z(0.4) * Quat::from_rotation_x(-1.1);
    let spaces = [
        half_space(0, Vec3::new(1.0, 2.0, -0.5), -0.35, turned, Vec3::new(0.5, 0.2, -0.1)),
        half_space(1, Vec3::new(-1.0, 0.3, 0.4), -0.3, Quat::IDENTITY, Vec3::ZERO),
    ];
    let mut expected: Vec<f64> = numbers(Data::Diffuse(pool.clone()).floats());
    let mut edge = vec![false; n as usize];
    let (mut stopped, mut dissolved) = (0, 0);
    for i in 0..now.count as usize {
        let (mut x, mut v) = (pool[i].position.as_dvec3(), pool[i].velocity.as_dvec3());
        let mut left = f64::from(pool[i].lifetime);
        for HalfSpace { normal, offset, body } in &spaces {
            let (rotation, position) = (body.rotation().as_dquat(), body.position.as_dvec3());
            let local = rotation.conjugate() * (x - position) + body.center.as_dvec3();
            let distance = normal.as_dvec3().dot(local) - f64::from(*offset);
            edge[i] |= distance.abs() < 1e-5;
            if distance >= 0.0 {
                continue;
            }
            let normal: DVec3 = rotation * normal.as_dvec3();
            x -= distance * normal;
            let of_body = body.velocity.as_dvec3() + body.angular_velocity.as_dvec3().cross(x - position);
            v -= (v - of_body).dot(normal).min(0.0) * normal;
            stopped += 1;
            if pool[i].tag & 3 == 0 {
                left = (left - f64::from(now.dt)).max(0.0);
                dissolved += u32::from(left == 0.0);
            }
        }
        expected[8 * i..8 * i + 7].copy_from_slice(&[x.x, x.y, x.z, left, v.x, v.y, v.z]);
    }
    assert!(stopped > 100 && dissolved > 5, "{stopped} stopped, {dissolved} dissolved");
    let same = move |a: &[Data], b: &[f64]| alike(a[0].floats(), b, &edge);
    let again = same.clone();
    Case {
        pass: pass("foam.collide"),
        name: "two half-spaces".into(),
        size: DispatchSize::Items(n),
        input: vec![
            Data::FoamState(now),
            Data::Bodies(spaces.iter().map(|space| space.body).collect()),
            Data::Vec2(spaces.iter().flat_map(HalfSpace::map).collect()),
            Data::Diffuse(pool),
        ],
        compare: Box::new(move |a, b| same(a, &numbers(b[0].floats()))),
        oracle: Box::new(move |out| again(out, &expected)),
        control: |input| {
            let Data::Bodies(bodies) = &mut input[1] else { panic!("no bodies") };
            bodies[0].position.y += 1e-3;
        },
    }
}
