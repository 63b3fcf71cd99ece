//! Lists of neighbours from their definition, and the cases of the pass that makes them.

use glam::{UVec4, Vec4Swizzles};
use splashdown::state::Params;
use splashdown_gpu::DispatchSize;

use super::harness::{Case, Data, exact};
use super::sort_cases::pass;
use super::walls::{self, Reflection};
use super::world::{World, params};

/// Instead of the number of neighbours: there is no list, and a visit searches the candidates.
const BY_ROWS: u32 = 1 << 31;
/// Instead of a reflection: there is no neighbour.
const NO_NEIGHBOUR: u32 = 31;

fn entry(j: usize, image: u32) -> u32 {
    image << 27 | j as u32
}

/// The number whose digits of base 3 are 0 for no reflection, 1 for the lower and 2 for the upper side of an axis.
fn number(params: &Params, by: &Reflection) -> u32 {
    (0..3).fold(0, |number, axis| {
        let low = by.shift[axis] == 2.0 * f64::from(params.domain_min[axis]);
        let digit = if by.sign[axis] > 0.0 { 0 } else { 2 - u32::from(low) };
        number + digit * 3_u32.pow(axis as u32)
    })
}

/// The words of the list of a particle.
fn words(world: &World, i: usize, layers: usize) -> Vec<u32> {
    let reach = f64::from(world.params.support_radius);
    let position = |j: usize| world.positions[j].xyz().as_dvec3();
    let mut reflections = walls::reflections(&world.params);
    reflections.sort_by_key(|by| number(&world.params, by));
    let mut words = vec![0];
    for by in &reflections {
        let near = (0..world.active())
            .filter(|&j| position(i).distance(by.sign * position(j) + by.shift) < reach)
            .map(|j| entry(j, number(&world.params, by)));
        words.extend(near);
    }
    words[0] = words.len() as u32 - 1;
    if words.len() > 4 * layers {
        return vec![BY_ROWS, u32::MAX, u32::MAX, u32::MAX];
    }
    words.resize(words.len().next_multiple_of(4), entry(i, NO_NEIGHBOUR));
    words
}

/// The lists of all particles, with poison where there are no words.
pub fn lists(world: &World, layers: usize) -> Vec<UVec4> {
    let n = world.params.particle_count as usize;
    let mut lists = vec![UVec4::MAX; layers * n];
    for i in 0..world.active() {
        for (layer, four) in words(world, i, layers).chunks_exact(4).enumerate() {
            lists[layer * n + i] = UVec4::from_slice(four);
        }
    }
    lists
}

/// How many particles have a list, and how many have none.
pub fn kinds(world: &World, layers: usize) -> [usize; 2] {
    let rows = (0..world.active()).filter(|&i| words(world, i, layers)[0] == BY_ROWS).count();
    [world.active() - rows, rows]
}

/// The lists without words that follow the end of a list, which have no meaning.
fn meaningful(world: &World, data: &Data) -> Vec<UVec4> {
    let Data::UVec4(lists) = data else { panic!("no lists") };
    let n = world.len();
    let of_list = |k: usize| match lists[k % n].x {
        _ if k % n >= world.active() => UVec4::MAX,
        BY_ROWS if k < n => UVec4::new(BY_ROWS, u32::MAX, u32::MAX, u32::MAX),
        BY_ROWS => UVec4::MAX,
        count if k / n <= count as usize / 4 => lists[k],
        _ => UVec4::MAX,
    };
    (0..lists.len()).map(of_list).collect()
}

pub fn cases() -> Vec<Case> {
    let open = Params { closed: 0b110111, ..params(2.5) };
    let worlds = [
        ("closed", World::new(params(2.0), 1500), 60),
        ("few layers", World::new(params(2.0), 1500), 12),
        ("open above", World::new(open, 1500), 20),
        ("whole cubes", World::with_slices(params(2.0), 1500, 1), 60),
        ("halved cubes", World::with_slices(params(2.0), 1500, 2), 60),
        ("borders of cells", World::on_borders(params(2.0), 4), 60),
        ("borders of halved cubes", World::on_borders(params(2.0), 2), 60),
    ];
    worlds.into_iter().map(|(name, world, layers)| list(name, world, layers)).collect()
}

fn list(name: &str, world: World, layers: usize) -> Case {
    let expected = lists(&world, layers);
    let input = vec![
        Data::Params(world.params),
        Data::Grid(world.grid),
        Data::U32(world.cell_start.clone()),
        Data::Vec4(world.positions.clone()),
        Data::UVec4(vec![UVec4::MAX; expected.len()]),
    ];
    let items = DispatchSize::Items(world.len() as u32);
    let exact = move |a: &Data, b: &Data| {
        let [a, b] = [a, b].map(|data| Data::UVec4(meaningful(&world, data)));
        exact("the lists", a.words(), b.words())
    };
    let same = exact.clone();
    Case {
        pass: pass("neighbours"),
        name: name.into(),
        size: items,
        input,
        compare: Box::new(move |a, b| exact(&a[0], &b[0])),
        oracle: Box::new(move |out| same(&out[0], &Data::UVec4(expected.clone()))),
        control: |input| input[0].params().support_radius *= 1.001,
    }
}

#[test]
fn the_cases_contain_both_kinds_of_lists() {
    let both = |layers| kinds(&World::new(params(2.0), 1500), layers);
    for layers in [12, 60] {
        assert!(both(layers).iter().all(|&count| count > 100), "{layers} layers: {:?}", both(layers));
    }
}
