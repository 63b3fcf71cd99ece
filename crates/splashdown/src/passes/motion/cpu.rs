use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

use glam::{Vec2, Vec4};
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot, as_atomic};

use crate::boundary::WallKernel;
use crate::cells::Grid;
use crate::cells::census::{self, Enroller};
use crate::kernel::Kernel;
use crate::passes::momentum::cpu::Momentum;
use crate::passes::moving::{Found, advance};
use crate::passes::pairs::{self, PairSum, Sorted};
use crate::passes::{Params, StepState};
use crate::simd::Register;

/// Particles per task where they are counted.
const CHUNK: usize = 4096;

pub(super) fn motion<K: Kernel + WallKernel>(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [
        params,
        grid,
        state,
        wall_table,
        cell_start,
        sorted_positions,
        sorted_velocities,
        densities,
        positions,
        velocities,
        tally,
        census,
    ] = slots
    else {
        unreachable!()
    };
    let (params, grid, state) = (&params.get::<Params>(), &grid.get::<Grid>(), &state.get::<StepState>());
    if state.done != 0 {
        return;
    }
    let cell_start = cell_start.read::<u32>();
    let sorted_positions = sorted_positions.read::<Vec4>();
    let (living, n) = (cell_start[grid.cell_count as usize] as usize, state.run_count as usize);
    let (counts, cells) = census::split(grid, census.write());
    let cells = &mut cells[..n];
    // The dead stay as they are.
    positions.write::<Vec4>()[living..n].copy_from_slice(&sorted_positions[living..n]);
    let (sorted_velocities, densities) = (sorted_velocities.read::<Vec4>(), densities.read::<Vec2>());
    velocities.write::<Vec4>()[living..n].copy_from_slice(&sorted_velocities[living..n]);
    // After the last step of a frame there is no next one to count for.
    let counting = !state.is_last_step();
    if counting {
        cells[living..].fill(grid.cell_count);
    }
    let pass = Motion::<K> {
        momentum: Momentum::new(
            params,
            state,
            sorted_positions,
            sorted_velocities,
            densities,
            wall_table.read(),
        ),
        params,
        grid,
        dt: state.dt,
        old: (sorted_positions, sorted_velocities, densities),
        positions: positions.atomics(),
        velocities: velocities.atomics(),
        cells: counting.then(|| as_atomic(cells)),
        tally: tally.atomics(),
    };
    let sorted = Sorted::new(params, grid, cell_start, sorted_positions);
    pairs::for_each(sorted, &mut vec![(); living], &pass);
    Found::tell_moved(tally.write());
    if counting {
        cells.par_chunks(CHUNK).for_each(|cells| {
            let mut enroller = Enroller::new(counts);
            cells.iter().for_each(|&cell| enroller.add(cell));
        });
    }
}

/// Forces and motion. Every particle writes its own places, by relaxed atomic stores: these are plain ones that two threads
/// may make side by side.
struct Motion<'a, K> {
    momentum: Momentum<'a, K>,
    params: &'a Params,
    grid: &'a Grid,
    dt: f32,
    old: (&'a [Vec4], &'a [Vec4], &'a [Vec2]),
    positions: &'a [AtomicU32],
    velocities: &'a [AtomicU32],
    cells: Option<&'a [AtomicU32]>,
    tally: &'a [AtomicU32],
}

impl<K: Kernel> PairSum<7, 3> for Motion<'_, K> {
    type Output = ();

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 7] {
        self.momentum.load(j)
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 7]) -> [V; 3] {
        self.momentum.pair(i)
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 3], (): &mut ()) {
        let (positions, velocities, densities) = self.old;
        let a = self.momentum.acceleration(i, sums);
        let mut found = Found::default();
        let particle = (positions[i], velocities[i], densities[i].x, a);
        let moved = advance(self.params, self.grid, self.dt, particle, &mut found);
        store(self.positions, i, moved.position);
        store(self.velocities, i, moved.velocity);
        if let Some(cells) = self.cells {
            cells[i].store(moved.cell, Relaxed);
        }
        found.tell_at_once(self.tally);
    }
}

#[inline(always)]
fn store(words: &[AtomicU32], i: usize, value: Vec4) {
    for (word, component) in words[4 * i..4 * i + 4].iter().zip(value.to_array()) {
        word.store(component.to_bits(), Relaxed);
    }
}
