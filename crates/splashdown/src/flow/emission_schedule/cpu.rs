use super::EmissionScheduleBindings;
use crate::flow::EmissionSchedule;

pub(super) fn emission_schedule(buffers: EmissionScheduleBindings<'_>) {
    let EmissionScheduleBindings { params, grid, state, cell_start, nozzles, schedules } = buffers;
    let (schedules, next) = schedules.split_at_mut(nozzles.len() * EmissionSchedule::WORDS);
    let mut slot = cell_start[grid.cell_count as usize];
    for (nozzle, schedule) in nozzles.iter().zip(schedules.chunks_exact_mut(EmissionSchedule::WORDS)) {
        schedule[EmissionSchedule::LAYER] = 0;
        // Such a step, after the end of a frame for example, has counted nothing.
        if state.run_count == 0 {
            continue;
        }
        schedule[EmissionSchedule::BESIDE] = schedule[EmissionSchedule::COUNTED];
        schedule[EmissionSchedule::COUNTED] = 0;
        if state.time < nozzle.start || state.time >= nozzle.end {
            continue;
        }
        if schedule[EmissionSchedule::EMITTED] + nozzle.points > nozzle.most {
            continue;
        }
        let mut phase = f32::from_bits(schedule[EmissionSchedule::PHASE]) + nozzle.speed * state.dt;
        if phase >= nozzle.interval {
            phase -= nozzle.interval;
            if slot + nozzle.points > params.particle_count {
                schedule[EmissionSchedule::REFUSED] += nozzle.points;
            } else {
                schedule[EmissionSchedule::LAYER] = nozzle.points;
                schedule[EmissionSchedule::SLOT] = slot;
                schedule[EmissionSchedule::ID] = next[0];
                schedule[EmissionSchedule::DISTANCE] = phase.to_bits();
                slot += nozzle.points;
                next[0] += nozzle.points;
            }
        }
        schedule[EmissionSchedule::PHASE] = phase.to_bits();
    }
}
