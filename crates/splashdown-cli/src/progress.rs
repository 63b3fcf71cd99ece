//! Progress on stderr: a bar in a terminal, else a plain line every few seconds.

use std::collections::VecDeque;
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use splashdown::run::{Progress, ProgressFn};

use crate::console::{self, Verbosity};
use crate::human;

/// The length of the bar: thousandths of the simulated time.
const LENGTH: u64 = 1000;

/// The time over which speeds are averaged.
const WINDOW: Duration = Duration::from_secs(10);

/// The time between two plain lines.
const PAUSE: Duration = Duration::from_secs(5);

/// Shows the progress of a run.
#[derive(Debug)]
pub struct Bar {
    bar: ProgressBar,
    /// Plain lines instead of a bar.
    plain: bool,
    last_line: Option<Instant>,
    speed: Speed,
}

impl Bar {
    /// A bar, plain lines, or nothing if quiet. In JSON mode plain lines need `--verbose`.
    pub fn new(verbosity: Verbosity, json: bool) -> Self {
        let terminal = std::io::stderr().is_terminal();
        let quiet = verbosity == Verbosity::Quiet;
        let target = if terminal && !quiet {
            ProgressDrawTarget::stderr_with_hz(5)
        } else {
            ProgressDrawTarget::hidden()
        };
        let bar = ProgressBar::with_draw_target(Some(LENGTH), target);
        if let Ok(style) = ProgressStyle::with_template("{bar:24.cyan/blue} {percent:>3} %  {msg}") {
            bar.set_style(style.progress_chars("━━─"));
        }
        let plain = !terminal && !quiet && (!json || verbosity == Verbosity::Verbose);
        Self { bar, plain, last_line: None, speed: Speed::default() }
    }

    /// Shows the current progress.
    pub fn update(&mut self, progress: &Progress) {
        self.speed.add(progress);
        let text = self.text(progress);
        let share = if progress.duration > 0.0 { progress.time / progress.duration } else { 1.0 };
        self.bar.set_position((share.clamp(0.0, 1.0) * LENGTH as f64) as u64);
        if self.plain && self.last_line.is_none_or(|last| last.elapsed() >= PAUSE) {
            self.last_line = Some(Instant::now());
            console::note(format!("{:3.0} %  {text}", share * 100.0));
        }
        self.bar.set_message(text);
    }

    /// Shows the progress of what precedes the first step, such as distance fields and the initial packing.
    pub fn preparation(&self) -> ProgressFn {
        let (bar, plain) = (self.bar.clone(), self.plain);
        let last_line = Mutex::new(Instant::now());
        ProgressFn::new(move |task, fraction| {
            bar.set_position((fraction.clamp(0.0, 1.0) * LENGTH as f32) as u64);
            let text = format!("preparing the {task}");
            // If another thread is printing, this line is not needed.
            if let (true, Ok(mut last)) = (plain, last_line.try_lock())
                && last.elapsed() >= PAUSE
            {
                *last = Instant::now();
                console::note(format!("{:3.0} %  {text}", fraction * 100.0));
            }
            bar.set_message(text);
        })
    }

    /// Prints a line above the bar.
    pub fn note(&self, text: &str) {
        self.bar.suspend(|| console::note(text));
    }

    /// Hides the bar while printing to stdout.
    pub fn suspend(&self, print: impl FnOnce()) {
        self.bar.suspend(print);
    }

    /// Shows what the run waits for.
    pub fn waiting(&self, what: &str) {
        self.bar.set_position(LENGTH);
        self.bar.set_message(what.to_owned());
        // No further progress arrives, so the bar is redrawn here.
        self.bar.tick();
    }

    /// Removes the bar.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }

    fn text(&self, progress: &Progress) -> String {
        let frame = format!("frame {}/{}", progress.frame, progress.frames);
        match self.speed.measure() {
            None => frame,
            Some((steps, simulated)) => {
                let left = (progress.duration - progress.time) / simulated;
                format!(
                    "{frame}  {} steps/s  {} simulated s/s  {} left",
                    human::scaled(steps).trim_end(),
                    human::three_digits(simulated),
                    human::duration(left.max(0.0))
                )
            }
        }
    }
}

/// Speeds over the last seconds.
#[derive(Debug, Default)]
struct Speed {
    /// Wall time, steps, simulated time.
    marks: VecDeque<(Duration, u64, f64)>,
}

impl Speed {
    fn add(&mut self, progress: &Progress) {
        self.marks.push_back((progress.wall, progress.steps, progress.time));
        while self.marks.len() > 2
            && self.marks.get(1).is_some_and(|mark| progress.wall.saturating_sub(mark.0) > WINDOW)
        {
            self.marks.pop_front();
        }
    }

    /// Steps and simulated seconds per second; `None` until the marks span 0.2 s.
    fn measure(&self) -> Option<(f64, f64)> {
        let (first, last) = (self.marks.front()?, self.marks.back()?);
        let wall = last.0.saturating_sub(first.0).as_secs_f64();
        let simulated = last.2 - first.2;
        (wall > 0.2 && simulated > 0.0).then(|| ((last.1 - first.1) as f64 / wall, simulated / wall))
    }
}

#[cfg(test)]
mod tests {
    use super::{Speed, WINDOW};
    use splashdown::run::Progress;
    use std::time::Duration;

    fn at(seconds: f64, steps: u64) -> Progress {
        let mut progress = Progress::default();
        (progress.time, progress.steps) = (steps as f64 * 1e-3, steps);
        progress.wall = Duration::from_secs_f64(seconds);
        progress
    }

    #[test]
    fn the_speed_is_averaged_over_the_last_seconds() {
        let mut speed = Speed::default();
        speed.add(&at(0.0, 0));
        assert_eq!(speed.measure(), None);
        // Ten steps a second at first, a hundred later.
        for second in 1..=30 {
            speed.add(&at(f64::from(second), 10 * second as u64));
        }
        for second in 31..=60 {
            speed.add(&at(f64::from(second), 300 + 100 * (second as u64 - 30)));
        }
        let (steps, simulated) = speed.measure().expect("there are marks");
        assert!((steps - 100.0).abs() < 1e-9 && (simulated - 0.1).abs() < 1e-12);
        assert!(speed.marks.len() <= WINDOW.as_secs() as usize + 2);
    }
}
