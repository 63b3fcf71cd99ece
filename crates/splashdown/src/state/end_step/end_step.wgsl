#import sph/params
#import sph/steps

#bindings

@compute @workgroup_size(1)
fn end_step() {
    finish_step();
}
