//! Drawing the pictures, one after the other.

use std::sync::Arc;
use std::time::Instant;

use splashdown_run::{FinishedFrame, FinishedRun, Orbit, Recorder, RunError, Stop};

use super::moments::Moment;
use super::problems::Problems;
use crate::interrupt::Interrupt;
use crate::{console, human};

/// How drawing has ended.
pub enum End {
    /// After the last picture.
    Finished,
    /// By Ctrl-C.
    Interrupted,
    /// By a failure of the device or the disk.
    Failed(RunError),
}

/// Pictures that are being drawn.
pub struct Drawing {
    pub finished: FinishedRun,
    pub recorder: Recorder,
    pub problems: Problems,
    pub orbit: Orbit,
    /// Whether pictures are drawn between frames.
    pub is_slowed: bool,
    /// The frame that was read last; `None` instead of one that is left out.
    pub current: Option<(u32, Option<FinishedFrame>)>,
}

impl Drawing {
    /// Draws the pictures until one fails or the user interrupts.
    pub fn draw_all(&mut self, moments: &[Moment], interrupt: &Interrupt) -> End {
        let begun = Instant::now();
        for (number, moment) in moments.iter().enumerate() {
            if interrupt.stop() != Stop::No {
                return End::Interrupted;
            }
            let progress = number as f32 / (moments.len() - 1).max(1) as f32;
            let drawn = match self.draw(moment, progress) {
                Ok(drawn) => drawn,
                Err(error) => return End::Failed(error),
            };
            let spent = begun.elapsed().as_secs_f64();
            let left = spent / (number + 1) as f64 * (moments.len() - number - 1) as f64;
            let (at, what) = (number + 1, if drawn { "" } else { " left out" });
            let left = human::duration(left);
            console::note(format!("[{at}/{}] frame {}{what}, {left} left", moments.len(), moment.frame));
        }
        End::Finished
    }

    /// Draws a picture, if its frame can be read and drawn.
    fn draw(&mut self, moment: &Moment, progress: f32) -> Result<bool, RunError> {
        if self.current.as_ref().is_none_or(|(number, _)| *number != moment.frame) {
            self.current = Some((moment.frame, self.read(moment.frame)));
        }
        let Some((number, Some(frame))) = &self.current else { return Ok(false) };
        let seconds = moment.offset / f64::from(self.finished.scene().frame_rate);
        match self.finished.draw_frame(frame, seconds, &self.orbit, progress) {
            Ok(picture) => {
                self.recorder.add(Arc::unwrap_or_clone(picture).rgba)?;
                Ok(true)
            }
            // One frame may have more triangles than the device can hold.
            Err(error @ RunError::Render(_)) => {
                self.problems.left_out(*number, error);
                self.current = Some((moment.frame, None));
                Ok(false)
            }
            Err(error) => Err(error),
        }
    }

    /// Reads a frame; `None` if it has to be left out.
    fn read(&mut self, number: u32) -> Option<FinishedFrame> {
        match self.finished.read(number) {
            Ok(frame) => {
                self.problems.drawn_without(number, frame.problems());
                if self.is_slowed && !frame.moves() {
                    self.problems.still(number);
                }
                Some(frame)
            }
            Err(error) => {
                self.problems.left_out(number, error);
                None
            }
        }
    }
}
