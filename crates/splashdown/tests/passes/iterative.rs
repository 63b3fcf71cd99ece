//! What the cases of the implicit pressure and of the implicit viscosity share: random input, and cases with expected values.

use glam::Vec4;
use splashdown::state::Params;
use splashdown_gpu::{DispatchSize, testing};

use super::harness::{Case, Data, close, wide};
use super::neighbour_lists;
use super::oracle::Kernel;
use super::sort_cases::pass;
use super::world::World;

/// As for the other sums over neighbours.
pub const ROUNDING: f64 = 2e-5;

/// The kernels, and their names in the labels of the passes.
pub const KERNELS: [(Kernel, &str); 3] = [
    (Kernel::WendlandC2, "wendland_c2"),
    (Kernel::WendlandBlend, "wendland_blend"),
    (Kernel::CubicSpline, "cubic_spline"),
];

/// Numbers in [-1, 1].
pub fn signed(i: usize, k: usize) -> f32 {
    2.0 * (testing::noise((16 * i + k) as u32 + 9_000_000) as f32 / u32::MAX as f32) - 1.0
}

pub fn vectors(n: usize, k: usize) -> Vec<Vec4> {
    (0..n).map(|i| Vec4::new(signed(i, k), signed(i, k + 1), signed(i, k + 2), signed(i, k + 3))).collect()
}

/// The written bindings: name, expected values, tolerances, and the content before the pass.
pub struct Output {
    pub name: &'static str,
    pub values: Vec<f64>,
    pub tolerances: Vec<f64>,
    pub before: Data,
}

impl Output {
    pub fn new(name: &'static str, before: Data) -> Self {
        Self { name, values: Vec::new(), tolerances: Vec::new(), before }
    }

    /// One number, and the magnitude of its terms.
    pub fn push(&mut self, value: f64, size: f64) {
        self.values.push(value);
        self.tolerances.push(ROUNDING * size);
    }
}

pub fn case(
    label: String,
    name: &str,
    items: usize,
    mut input: Vec<Data>,
    outputs: Vec<Output>,
    control: fn(&mut [Data]),
) -> Case {
    let mut expected = Vec::new();
    for Output { name, mut values, mut tolerances, before } in outputs {
        // What the pass does not write keeps its content.
        let rest = wide(&before.floats()[values.len()..]);
        tolerances.resize(tolerances.len() + rest.len(), 0.0);
        values.extend(rest);
        input.push(before);
        expected.push((name, values, tolerances));
    }
    let tolerances: Vec<_> =
        expected.iter().map(|(name, _, tolerances)| (*name, tolerances.clone())).collect();
    Case {
        pass: pass(&label),
        name: name.into(),
        size: DispatchSize::Items(items as u32),
        input,
        compare: Box::new(move |a, b| {
            for ((a, b), (name, tolerances)) in a.iter().zip(b).zip(&tolerances) {
                close(name, a.floats(), &wide(b.floats()), tolerances)?;
            }
            Ok(())
        }),
        oracle: Box::new(move |out| {
            for (out, (name, values, tolerances)) in out.iter().zip(&expected) {
                close(name, out.floats(), values, tolerances)?;
            }
            Ok(())
        }),
        control,
    }
}

pub fn base(world: &World) -> Vec<Data> {
    vec![Data::Params(world.params), Data::Grid(world.grid), Data::State(world.state)]
}

/// The lists of neighbours. With wide supports those of most particles contain the rows of candidates.
pub fn lists(world: &World) -> Data {
    let layers = if world.params.support_radius > 2.2 * world.params.particle_spacing { 12 } else { 60 };
    Data::UVec4(neighbour_lists::lists(world, layers))
}

pub fn poisoned(n: usize) -> Data {
    Data::Vec4(vec![Vec4::ZERO; n]).poison()
}

pub fn world(params: Params) -> World {
    World::new(params, 1500)
}

/// The end of the label of a pass, with or without bodies.
pub fn suffix(bodies: bool) -> &'static str {
    if bodies { ".bodies" } else { "" }
}
