//! What was left out of a film and why, reported once at its end.

use std::collections::BTreeSet;

use splashdown_run::RunError;

use crate::console;
use crate::exit::{Exit, Failure};

/// Problems that are listed. More are counted.
const LISTED: usize = 12;

/// The problems of a film.
#[derive(Debug, Default)]
pub struct Problems {
    texts: Vec<String>,
    /// Frames in slow motion whose liquid has no velocities.
    still: BTreeSet<u32>,
    first: Option<Failure>,
}

impl Problems {
    /// Adds problems that are not known yet.
    pub fn extend(&mut self, problems: impl IntoIterator<Item = String>) {
        for problem in problems {
            if !self.texts.contains(&problem) {
                self.texts.push(problem);
            }
        }
    }

    /// A frame that is not drawn.
    pub fn left_out(&mut self, frame: u32, error: RunError) {
        self.extend([format!("frame {frame} is left out: {error}")]);
        self.first.get_or_insert_with(|| error.into());
    }

    /// A frame that is drawn without these files.
    pub fn drawn_without(&mut self, frame: u32, problems: &[String]) {
        self.extend(
            problems.iter().map(|problem| format!("frame {frame} is drawn without a file: {problem}")),
        );
    }

    /// A frame in slow motion whose liquid has no velocities.
    pub fn still(&mut self, frame: u32) {
        self.still.insert(frame);
    }

    /// The message about frames whose liquid has no velocities.
    fn standing(&self) -> Option<String> {
        let (first, last) = (self.still.first()?, self.still.last()?);
        let (frames, pronoun) = match self.still.len() {
            1 => (format!("frame {first} has"), "it"),
            count => (format!("{count} frames from {first} to {last} have"), "each"),
        };
        Some(format!(
            "{frames} no velocities of the liquid, which stands still after {pronoun} until the next frame: write surfaces as PLY, \
             or particles as PLY, VTU, VTK, BGEO or NPZ"
        ))
    }

    /// Prints the problems.
    pub fn report(&self) {
        if let Some(text) = self.standing() {
            console::note(format!("warning: {text}"));
        }
        for text in self.texts.iter().take(LISTED) {
            console::note(format!("warning: {text}"));
        }
        if self.texts.len() > LISTED {
            console::note(format!("warning: {} more problems like these", self.texts.len() - LISTED));
        }
    }

    /// Why the first frame that was left out could not be drawn, as the reason why there are no pictures.
    pub fn failure(self) -> Failure {
        self.first.unwrap_or_else(|| Failure::new(Exit::Scene, "there is nothing to draw"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_without_velocities_are_named() {
        let mut problems = Problems::default();
        assert_eq!(problems.standing(), None);
        problems.still(7);
        assert!(problems.standing().is_some_and(|text| text.starts_with("frame 7 has no velocities")));
        problems.still(9);
        problems.still(9);
        assert!(
            problems
                .standing()
                .is_some_and(|text| text.starts_with("2 frames from 7 to 9 have no velocities"))
        );
    }

    #[test]
    fn a_problem_is_listed_once() {
        let mut problems = Problems::default();
        let error = || RunError::Input("it is damaged".to_owned());
        for _ in 0..3 {
            problems.left_out(5, error());
            problems.drawn_without(6, &["no droplets".to_owned()]);
        }
        problems.left_out(7, error());
        let expected = [
            "frame 5 is left out: it is damaged",
            "frame 6 is drawn without a file: no droplets",
            "frame 7 is left out: it is damaged",
        ];
        assert_eq!(problems.texts, expected);
        assert_eq!(problems.failure().message, "it is damaged");
    }
}
