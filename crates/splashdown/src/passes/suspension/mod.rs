//! Steps of an implicit solver that span several rounds of a submission.
//!
//! A GPU executes all iterations of a submission, also those after the solver has stopped. Such an iteration costs three
//! dispatches without effect; with the largest number of iterations in every step, they took half of the time of a small
//! simulation. So the host records about as many iterations as recent steps needed. If the solver has not stopped after
//! these, [`suspend`] makes the step look like the end of a frame: no particle, empty cells, no prefix sum. All passes
//! of the rest of the step and of the beginning of the next round then have no effect. Where the iterations of the next
//! round begin, [`resume`] restores what was taken, and the solver continues.
//!
//! Before anything but the next round uses the particles, the suspended step must end: its ids are in a new order
//! already, its positions are not. [`suspend::HOLD`] before a round with all iterations, and [`resume::RELEASE`] after it, end
//! a suspended step without beginning another.
//!
//! The result does not depend on the number of iterations that the host recorded. The CPU tests the flag of a solver after
//! each iteration, and suspends no step. Nor is one suspended that sorts with the bitonic sort, which has no
//! prefix sum that can be turned off.

pub mod resume;
pub mod suspend;

use splashdown_gpu::PassDesc;

/// The passes of this module.
pub(super) fn passes() -> [&'static PassDesc; 6] {
    [
        &suspend::PRESSURE,
        &suspend::VISCOSITY,
        &suspend::HOLD,
        &resume::PRESSURE,
        &resume::VISCOSITY,
        &resume::RELEASE,
    ]
}
