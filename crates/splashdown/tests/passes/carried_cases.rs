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
    vec![
        reorder(&world, "f32", Data::F32(shuffled.of(&scalars)), Data::F32(scalars.clone())),
        reorder(&world, "vec4", Data::Vec4(shuffled.of(&vectors)), Data::Vec4(vectors.clone())),
        store(&world, "f32", Data::F32(scalars)),
        store(&world, "vec4", Data::Vec4(vectors)),
    ]
}

fn reorder(world: &World, kind: &str, carried: Data, sorted: Data) -> Case {
    let mut input = before_reordering(world, &world.shuffled());
    input.extend([carried, sorted.poison()]);
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
