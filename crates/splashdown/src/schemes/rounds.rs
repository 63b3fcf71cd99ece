//! The numbers of iterations of implicit solvers in a submission.

use splashdown_gpu::Rounds;

use crate::Stats;
use crate::state::StepState;

/// Iterations of the pressure in the first steps on a GPU.
const FIRST_OF_PRESSURE: u32 = 8;
/// Iterations of the viscosity in the first steps on a GPU.
const FIRST_OF_VISCOSITY: u32 = 32;
/// The fewest iterations that a step records.
const FEWEST: u32 = 2;

/// How many iterations of the implicit pressure and of the implicit viscosity a step records.
///
/// A step that needs more is suspended and continues in the next round of the submission, with the same result
/// ([`passes::suspension`](crate::passes::suspension)).
#[derive(Clone, Debug)]
pub struct SolverRounds {
    /// Iterations of the pressure.
    pub pressure: Rounds,
    /// Iterations of the viscosity.
    pub viscosity: Rounds,
}

impl SolverRounds {
    /// These largest numbers, which no step exceeds.
    pub(super) fn new(most_of_pressure: u32, most_of_viscosity: u32) -> Self {
        Self { pressure: Rounds::new(most_of_pressure), viscosity: Rounds::new(most_of_viscosity) }
    }

    /// Records the most iterations of a step of the last frame. The numbers follow from the statistics alone: the rounds of
    /// a run that is resumed from a checkpoint are then those of one that was not interrupted, and so are the steps at
    /// which its foam changes.
    pub(crate) fn begin_frame(&self, last: &Stats) {
        let has_steps = last.steps_in_frame > 0;
        self.pressure.set(if has_steps { last.most_iterations.max(FEWEST) } else { FIRST_OF_PRESSURE });
        self.viscosity.set(if has_steps {
            last.most_viscous_iterations.max(FEWEST)
        } else {
            FIRST_OF_VISCOSITY
        });
    }

    /// Records as many iterations as the steps of the present frame needed so far.
    pub(crate) fn follow(&self, state: &StepState) {
        if state.steps > 0 {
            self.pressure.set(expected(state.iterations, state.most_iterations, state.steps));
            self.viscosity.set(expected(
                state.viscous_iterations,
                state.most_viscous_iterations,
                state.steps,
            ));
        }
    }

    /// Iterations of a step in a submission.
    pub(crate) fn total(&self, has_implicit_viscosity: bool) -> u32 {
        self.pressure.get() + if has_implicit_viscosity { self.viscosity.get() } else { 0 }
    }
}

/// The most that a step needed, but at most twice the mean and two. Recording more for a few long steps would cost more
/// than suspending them: a suspension costs about nine iterations without effect.
fn expected(sum: u32, most: u32, steps: u32) -> u32 {
    most.min(2 * sum / steps + 2).max(FEWEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_steps_with_many_iterations_do_not_determine_the_number() {
        assert_eq!(expected(50, 7, 10), 7);
        assert_eq!(expected(50, 30, 10), 12);
        assert_eq!(expected(10, 1, 10), FEWEST);
    }

    #[test]
    fn a_number_follows_the_steps_of_a_frame_up_to_its_largest() {
        let rounds = SolverRounds::new(40, 200);
        assert_eq!(rounds.total(true), 240);
        let mut last = Stats::default();
        rounds.begin_frame(&last);
        assert_eq!((rounds.total(false), rounds.total(true)), (8, 40));
        (last.steps_in_frame, last.most_iterations, last.most_viscous_iterations) = (3, 12, 20);
        rounds.begin_frame(&last);
        assert_eq!((rounds.total(false), rounds.total(true)), (12, 32));
        let mut state: StepState = bytemuck::Zeroable::zeroed();
        rounds.follow(&state);
        assert_eq!(rounds.total(true), 32, "no step is known");
        (state.steps, state.iterations, state.most_iterations) = (4, 40, 90);
        (state.viscous_iterations, state.most_viscous_iterations) = (400, 120);
        rounds.follow(&state);
        assert_eq!((rounds.pressure.get(), rounds.viscosity.get()), (22, 120));
        (state.iterations, state.most_iterations) = (400, 90);
        rounds.follow(&state);
        assert_eq!(rounds.pressure.get(), 40);
    }
}
