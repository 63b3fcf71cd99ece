#import sph/params
#import sph/steps

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> state: StepState;
@group(0) @binding(2) var<storage, read_write> counters: array<u32>;

@compute @workgroup_size(1)
fn end_step() {
    finish_step();
}
