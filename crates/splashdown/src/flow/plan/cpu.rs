use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::flow::{Nozzle, Plan};
use crate::passes::{Params, StepState};

pub(super) fn plan(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [params, grid, state, cell_start, nozzles, plans] = slots else { unreachable!() };
    let (params, state) = (params.get::<Params>(), state.get::<StepState>());
    let nozzles = nozzles.read::<Nozzle>();
    let (plans, next) = plans.write::<u32>().split_at_mut(nozzles.len() * Plan::WORDS);
    let mut slot = cell_start.read::<u32>()[grid.get::<Grid>().cell_count as usize];
    for (nozzle, plan) in nozzles.iter().zip(plans.chunks_exact_mut(Plan::WORDS)) {
        plan[Plan::LAYER] = 0;
        if state.run_count == 0 || state.time < nozzle.start || state.time >= nozzle.end {
            continue;
        }
        if plan[Plan::EMITTED] + nozzle.points > nozzle.most {
            continue;
        }
        let mut phase = f32::from_bits(plan[Plan::PHASE]) + nozzle.speed * state.dt;
        if phase >= params.particle_spacing {
            phase -= params.particle_spacing;
            if slot + nozzle.points > params.particle_count {
                plan[Plan::REFUSED] += nozzle.points;
            } else {
                plan[Plan::LAYER] = nozzle.points;
                plan[Plan::SLOT] = slot;
                plan[Plan::ID] = next[0];
                plan[Plan::DISTANCE] = phase.to_bits();
                slot += nozzle.points;
                next[0] += nozzle.points;
            }
        }
        plan[Plan::PHASE] = phase.to_bits();
    }
}
