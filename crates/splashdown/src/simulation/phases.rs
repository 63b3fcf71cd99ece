//! A step as a list of phases: passes on the device, and actions of the host.
//!
//! Neighbouring device phases become one submission. If the host acts between batches of steps only, several steps
//! become one submission too: a [`Repeat`](splashdown_gpu::Command::Repeat) whose number of rounds the host sets
//! before each submission.

use splashdown_gpu::{Flag, Recording, Rounds};

/// An action of the host between device phases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HostAction {
    /// Resolves collisions of bodies.
    ResolveCollisions,
}

/// A part of a step.
pub(super) enum Phase {
    /// Passes that run on the device.
    Device(Recording),
    /// The host waits for the device and acts.
    Host {
        /// The action.
        action: HostAction,
        /// The largest number of steps between two actions; 1 for every step.
        steps: u32,
    },
}

/// Work of the device, and the action of the host after it.
pub(super) struct Submission {
    recording: Recording,
    action: Option<HostAction>,
}

impl Submission {
    /// The passes of the device.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// The action of the host, once the device is done.
    pub fn action(&self) -> Option<HostAction> {
        self.action
    }
}

/// The submissions that advance a simulation.
pub(super) struct Schedule {
    submissions: Vec<Submission>,
    rounds: Rounds,
    most_steps: u32,
}

impl Schedule {
    /// Schedules a step of these phases, which repeats until `done` and at most `most_steps` times in a submission.
    /// `end` follows the last step of each submission.
    pub fn new(phases: Vec<Phase>, end: &Recording, done: Flag, most_steps: u32) -> Self {
        let (mut merged, most_steps) = merge(phases, most_steps);
        let rounds = Rounds::new(most_steps);
        // A step with a host action inside is submitted in parts; any other step is repeated as a whole.
        if let [only] = merged.as_mut_slice() {
            let mut steps = Recording::new("steps");
            steps.repeat(&only.recording, &rounds, done);
            only.recording = steps;
        }
        if let Some(last) = merged.last_mut() {
            last.recording.append(end);
        }
        Self { submissions: merged, rounds, most_steps }
    }

    /// A schedule without phases.
    pub fn empty() -> Self {
        Self { submissions: Vec::new(), rounds: Rounds::new(0), most_steps: 0 }
    }

    /// The largest number of steps that the host may submit before it acts.
    pub fn most_steps(&self) -> u32 {
        self.most_steps
    }

    /// The submissions of this many steps; the number is limited to [`most_steps`](Self::most_steps).
    pub fn submissions(&self, steps: u32) -> &[Submission] {
        self.rounds.set(steps.min(self.most_steps));
        &self.submissions
    }
}

/// Merges neighbouring device phases. Also returns the largest number of steps between two actions of the host.
fn merge(phases: Vec<Phase>, most_steps: u32) -> (Vec<Submission>, u32) {
    let mut merged: Vec<Submission> = Vec::new();
    let mut most = most_steps;
    for phase in phases {
        match phase {
            Phase::Device(recording) => match merged.last_mut() {
                Some(last) if last.action.is_none() => last.recording.append(&recording),
                _ => merged.push(Submission { recording, action: None }),
            },
            Phase::Host { action, steps } => {
                most = most.min(steps);
                match merged.last_mut() {
                    Some(last) if last.action.is_none() => last.action = Some(action),
                    _ => merged.push(Submission { recording: Recording::new("host"), action: Some(action) }),
                }
            }
        }
    }
    let most = if merged.len() > 1 { 1 } else { most };
    (merged, most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown_gpu::{Buffer, Command, CpuExecutor, Executor};

    fn device(buffer: Buffer<u32>) -> Phase {
        let mut recording = Recording::new("device");
        recording.clear(buffer);
        Phase::Device(recording)
    }

    fn host(steps: u32) -> Phase {
        Phase::Host { action: HostAction::ResolveCollisions, steps }
    }

    #[test]
    fn device_phases_merge_unless_the_host_acts_between_them() {
        let mut executor = Executor::from(CpuExecutor::new());
        let buffer = executor.create::<u32>("numbers", 4).unwrap();
        let count = |phases| {
            let (merged, most) = merge(phases, 64);
            let commands: Vec<usize> = merged.iter().map(|part| part.recording.commands.len()).collect();
            (commands, most)
        };
        assert_eq!(count(vec![device(buffer), device(buffer)]), (vec![2], 64));
        // A host action after the step allows several steps per submission; one inside the step allows one.
        assert_eq!(count(vec![device(buffer), device(buffer), host(16)]), (vec![2], 16));
        assert_eq!(count(vec![device(buffer), host(1), device(buffer)]), (vec![1, 1], 1));
        assert_eq!(count(vec![device(buffer), host(16), device(buffer)]), (vec![1, 1], 1));
    }

    #[test]
    fn whole_steps_are_repeated_and_interrupted_ones_are_not() {
        let mut executor = Executor::from(CpuExecutor::new());
        let buffer = executor.create::<u32>("numbers", 4).unwrap();
        let end = Recording::new("end");
        let flag = || Flag::new(buffer, 0);
        let whole = Schedule::new(vec![device(buffer), host(16)], &end, flag(), 64);
        let [only] = whole.submissions(99) else { panic!("one submission") };
        assert!(
            matches!(&only.recording().commands[..], [Command::Repeat { rounds, .. }] if rounds.get() == 16)
        );
        assert_eq!(only.action(), Some(HostAction::ResolveCollisions));
        let parts = Schedule::new(vec![device(buffer), host(1), device(buffer)], &end, flag(), 64);
        assert_eq!(parts.submissions(5).len(), 2);
        assert!(
            parts
                .submissions(5)
                .iter()
                .all(|part| matches!(&part.recording().commands[..], [Command::Clear { .. }]))
        );
    }
}
