#import sph/params
#import sph/grid
#import sph/flow

#bindings

@compute @workgroup_size(1)
fn emission_schedule() {
    let count = arrayLength(&nozzles);
    var slot = cell_start[grid.cell_count];
    var id = schedules[count * SCHEDULE_WORDS];
    for (var k = 0u; k < count; k++) {
        let nozzle = nozzles[k];
        let w = k * SCHEDULE_WORDS;
        schedules[w + SCHEDULE_LAYER] = 0u;
        // Such a step, after the end of a frame for example, has counted nothing.
        if (state.run_count == 0u) {
            continue;
        }
        schedules[w + SCHEDULE_BESIDE] = schedules[w + SCHEDULE_COUNTED];
        schedules[w + SCHEDULE_COUNTED] = 0u;
        if (state.time < nozzle.start || state.time >= nozzle.end) {
            continue;
        }
        if (schedules[w + SCHEDULE_EMITTED] + nozzle.points > nozzle.most) {
            continue;
        }
        var phase = bitcast<f32>(schedules[w + SCHEDULE_PHASE]) + nozzle.speed * state.dt;
        if (phase >= nozzle.interval) {
            phase -= nozzle.interval;
            if (slot + nozzle.points > params.particle_count) {
                schedules[w + SCHEDULE_REFUSED] += nozzle.points;
            } else {
                schedules[w + SCHEDULE_LAYER] = nozzle.points;
                schedules[w + SCHEDULE_SLOT] = slot;
                schedules[w + SCHEDULE_ID] = id;
                schedules[w + SCHEDULE_DISTANCE] = bitcast<u32>(phase);
                slot += nozzle.points;
                id += nozzle.points;
            }
        }
        schedules[w + SCHEDULE_PHASE] = bitcast<u32>(phase);
    }
    schedules[count * SCHEDULE_WORDS] = id;
}
