use glam::{DVec3, Vec3, Vec4, Vec4Swizzles};
use splashdown::MouseForce;
use splashdown_gpu::DispatchSize;

use super::harness::{Case, Data, close, wide};
use super::sort_cases::pass;
use super::world::{World, params};

pub fn cases() -> Vec<Case> {
    vec![mouse_force()]
}

fn mouse_force() -> Case {
    let world = World::new(params(2.0), 1500);
    let mouse_force = MouseForce::new(
        Vec3::new(-0.05, 0.2, 0.3),
        Vec3::new(0.6, 0.0, 0.8),
        Vec3::new(1.0, -0.5, 0.7),
        0.12,
        9.0,
    );
    let accelerations: Vec<Vec4> = (0..world.len()).map(|i| world.normals[i] * 3.0).collect();
    let mut expected: Vec<f64> = wide(Data::Vec4(accelerations.clone()).floats());
    let mut stirred = 0;
    for i in 0..world.active() {
        // The component of the remaining velocity perpendicular to the axis, by two cross products.
        let (x, v): (DVec3, DVec3) =
            (world.positions[i].xyz().as_dvec3(), world.velocities[i].xyz().as_dvec3());
        let axis = mouse_force.direction.as_dvec3();
        let distance =
            (x - mouse_force.origin.as_dvec3()).cross(axis).length() / f64::from(mouse_force.radius);
        if distance < 1.0 {
            let weight = (1.0 - distance * distance).powi(2);
            let missing = mouse_force.velocity.as_dvec3() - v;
            let pull = f64::from(mouse_force.rate) * weight * axis.cross(missing.cross(axis));
            expected[4 * i..4 * i + 3].iter_mut().zip(pull.to_array()).for_each(|(a, more)| *a += more);
            stirred += 1;
        }
    }
    assert!(stirred > 20 && stirred < world.active() / 2, "{stirred}");
    let same = |a: &[f32], b: &[f64]| {
        let tolerance: Vec<f64> = b.iter().map(|b| 2e-6 * b.abs() + 2e-5).collect();
        close("accelerations", a, b, &tolerance)
    };
    Case {
        pass: pass("mouse_force.apply"),
        name: "a rod through the cloud".into(),
        size: DispatchSize::Items(world.len() as u32),
        input: vec![
            Data::Grid(world.grid),
            Data::State(world.state),
            Data::U32(world.cell_start.clone()),
            Data::MouseForce(mouse_force),
            Data::Vec4(world.positions.clone()),
            Data::Vec4(world.velocities.clone()),
            Data::Vec4(accelerations),
        ],
        compare: Box::new(move |a, b| same(a[0].floats(), &wide(b[0].floats()))),
        oracle: Box::new(move |out| same(out[0].floats(), &expected)),
        control: |input| {
            let Data::MouseForce(mouse_force) = &mut input[3] else { panic!("no mouse_force") };
            mouse_force.radius *= 1.001;
        },
    }
}
