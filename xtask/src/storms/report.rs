//! The report of a search.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::{End, Judged};

/// The command that was run.
pub fn command(arguments: &[String]) -> String {
    std::iter::once("cargo xtask storms")
        .chain(arguments.iter().map(String::as_str))
        .collect::<Vec<_>>()
        .join(" ")
}

/// The counts of runs by their end and by the judgement.
#[derive(Default)]
struct Counts {
    all: usize,
    silent_plausible: usize,
    silent_failures: usize,
    warned_plausible: usize,
    warned_implausible: usize,
    stopped_plausible: usize,
    stopped_implausible: usize,
    refused: usize,
    crashed: usize,
}

impl Counts {
    fn add(&mut self, one: &Judged) {
        self.all += 1;
        *match (&one.end, one.reasons.is_empty()) {
            (End::Silent, true) => &mut self.silent_plausible,
            (End::Silent, false) => &mut self.silent_failures,
            (End::Warned(_), true) => &mut self.warned_plausible,
            (End::Warned(_), false) => &mut self.warned_implausible,
            (End::Stopped(_), true) => &mut self.stopped_plausible,
            (End::Stopped(_), false) => &mut self.stopped_implausible,
            (End::Refused(_), _) => &mut self.refused,
            (End::Crashed(_), _) => &mut self.crashed,
        } += 1;
    }
}

/// The page.
pub fn page(judged: &[Judged], command: &str, seconds: f64) -> String {
    let mut all = Counts::default();
    let mut by_trait: BTreeMap<&str, Counts> = BTreeMap::new();
    for one in judged {
        all.add(one);
        one.storm.traits.iter().for_each(|name| by_trait.entry(name).or_default().add(one));
    }
    let mut page = format!(
        "# Storms\n\nRandom scenes, run by the real program and judged by an independent check of the particles. Written by \
         `{command}` in {:.0} minutes. The generator and the limits of the judge are in `xtask/src/storms`; the same seed gives the \
         same scenes.\n\nThe judge reads speeds, energy, densities (by a sum over all pairs), particles behind walls, inside balls \
         or lost, and NaN from the files of each frame. A *silent failure* is a run that succeeds without a warning although the \
         judge finds it implausible. A plausible run that warns or stops is not always a false alarm: water is then compressed, or \
         particles are moved back by walls, below the limits of the judge.\n\n| result | scenes |\n|---|---|\n",
        seconds / 60.0
    );
    for (name, count) in [
        ("scenes", all.all),
        ("plausible, without a warning", all.silent_plausible),
        ("plausible, with a warning", all.warned_plausible),
        ("plausible, stopped", all.stopped_plausible),
        ("implausible, with a warning", all.warned_implausible),
        ("implausible, stopped", all.stopped_implausible),
        ("**implausible, silent**", all.silent_failures),
        ("refused before the first step", all.refused),
        ("crashed", all.crashed),
    ] {
        let _ = writeln!(page, "| {name} | {count} |");
    }
    page += "\n| scenes with | all | plausible | of these warned or stopped | implausible | of these silent |\n|---|---|---|---|---|---|\n";
    for (name, counts) in &by_trait {
        let alarms = counts.warned_plausible + counts.stopped_plausible;
        let failures = counts.warned_implausible + counts.stopped_implausible + counts.silent_failures;
        let _ = writeln!(
            page,
            "| {name} | {} | {} | {alarms} | {failures} | {} |",
            counts.all,
            counts.silent_plausible + alarms,
            counts.silent_failures
        );
    }
    page
}
