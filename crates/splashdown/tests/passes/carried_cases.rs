//! The passes that reorder and store carried quantities: copies, so all outputs are compared to the last bit.

use glam::Vec4;

use super::harness::{Case, Data};
use super::sort_cases::{before_reordering, case, swap_ids};
use super::world::{World, params};

pub fn cases() -> Vec<Case> {
    let world = World::new(params(2.0), 1500);
    let scalars: Vec<f32> = world.ids.iter().map(|&id| 0.5 * id as f32).collect();
    let vectors: Vec<Vec4> = scalars.iter().map(|&x| Vec4::new(x, -x, 1.0, x * x)).collect();
    let shuffled = world.shuffled();
    // Removed particles get the value of an emitted one.
    let active = world.active();
    let reset = |i: usize| i >= active;
    let (scalar, vector) = (-7.5, Vec4::new(1.5, -2.5, 3.5, -4.5));
    let sorted_scalars =
        scalars.iter().enumerate().map(|(i, &x)| if reset(i) { scalar } else { x }).collect();
    let sorted_vectors =
        vectors.iter().enumerate().map(|(i, &v)| if reset(i) { vector } else { v }).collect();
    vec![
        reorder(
            &world,
            "f32",
            [Data::F32(shuffled.of(&scalars)), Data::F32(vec![scalar])],
            Data::F32(sorted_scalars),
        ),
        reorder(
            &world,
            "vec4",
            [Data::Vec4(shuffled.of(&vectors)), Data::Vec4(vec![vector])],
            Data::Vec4(sorted_vectors),
        ),
        store(&world, "f32", Data::F32(scalars)),
        store(&world, "vec4", Data::Vec4(vectors)),
    ]
}

fn reorder(world: &World, kind: &str, carried_and_emitted: [Data; 2], sorted: Data) -> Case {
    let mut input = before_reordering(world, &world.shuffled());
    input.extend(carried_and_emitted);
    input.push(sorted.poison());
    let label = format!("cells.reorder_carried.{kind}");
    case(&label, "all", world.len(), input, vec![sorted], swap_ids)
}

fn store(world: &World, kind: &str, sorted: Data) -> Case {
    let input = vec![Data::State(world.state), sorted.clone(), sorted.poison()];
    // A step that processes one particle less stores one value less.
    let control = |input: &mut [Data]| {
        let Data::State(state) = &mut input[0] else { panic!("no state") };
        state.run_count -= 1;
    };
    case(&format!("cells.store_carried.{kind}"), "all", world.len(), input, vec![sorted], control)
}
