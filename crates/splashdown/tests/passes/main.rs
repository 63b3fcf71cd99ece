//! Every pass: on the GPU against the CPU from equal input, and both against brute force in f64.
//!
//! SPH is chaotic, so whole runs are never compared. Single passes are compared, from equal buffers with poisoned
//! output. Each comparison has a negative control: the smallest change of the input that must be detected. The
//! passes of the surface and of bodies have separate tests.

mod carried_cases;
mod cases;
mod corrected_oracle;
mod flow_cases;
mod foam_cases;
mod harness;
mod implicit_cases;
mod implicit_step_cases;
mod iterative;
mod mouse_force_cases;
mod neighbour_cases;
mod neighbour_lists;
mod oracle;
mod probe_cases;
mod sort_cases;
mod suspension_cases;
mod tension_force_cases;
mod viscous_cases;
mod viscous_solve;
mod walls;
mod whole_step;
mod world;

use std::collections::BTreeSet;

use harness::Case;
use splashdown_gpu::{CpuExecutor, Executor, testing};

fn all_cases() -> Vec<Case> {
    let all = [
        sort_cases::cases(),
        carried_cases::cases(),
        cases::cases(),
        neighbour_lists::cases(),
        neighbour_cases::cases(),
        tension_force_cases::cases(),
        implicit_cases::cases(),
        implicit_step_cases::cases(),
        viscous_cases::cases(),
        suspension_cases::cases(),
        flow_cases::cases(),
        foam_cases::cases(),
        probe_cases::cases(),
        mouse_force_cases::cases(),
    ];
    all.into_iter().flatten().collect()
}

fn cpu() -> Executor {
    let mut executor = Executor::from(CpuExecutor::new());
    executor.poison();
    executor
}

#[test]
fn every_pass_has_a_case() {
    let passes = splashdown::passes();
    let elsewhere = |label: &str| label.starts_with("surface") || label.starts_with("bodies");
    let expected: BTreeSet<&str> =
        passes.iter().map(|pass| pass.label).filter(|label| !elsewhere(label)).collect();
    let tested: BTreeSet<&str> = all_cases().iter().map(|case| case.pass.label).collect();
    assert_eq!(tested, expected);
    assert!(expected.len() > 15, "{expected:?}");
}

#[test]
fn every_pass_agrees_with_brute_force() {
    let mut wrong = Vec::new();
    for case in all_cases() {
        if let Err(what) = (case.oracle)(&case.run(&mut cpu())) {
            wrong.push(format!("{}: {what}", case.title()));
        }
        if (case.oracle)(&case.run_control(&mut cpu())).is_ok() {
            wrong.push(format!("{}: the control is not detected", case.title()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_pass_on_the_gpu_agrees_with_the_cpu() {
    let mut executors = testing::executors("every_pass_on_the_gpu_agrees_with_the_cpu");
    let Some((_, mut gpu)) = executors.drain(1..).next() else { return };
    let mut wrong = Vec::new();
    for case in all_cases() {
        let on_gpu = case.run(&mut gpu);
        let results = [
            ("against the CPU", (case.compare)(&on_gpu, &case.run(&mut cpu()))),
            ("against brute force", (case.oracle)(&on_gpu)),
        ];
        for (against, result) in results {
            if let Err(what) = result {
                wrong.push(format!("{}, {against}: {what}", case.title()));
            }
        }
        if (case.compare)(&on_gpu, &case.run_control(&mut cpu())).is_ok() {
            wrong.push(format!("{}: the control is not detected", case.title()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
