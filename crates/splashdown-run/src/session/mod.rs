//! A run in progress: one loop over the events of [`splashdown::Run`].

mod earlier;
mod start;

use std::sync::Arc;

use splashdown::monitor::Level;
use splashdown::run::Summary;
use splashdown::{Event, Run};
use splashdown_io::{Film, WrittenFile};

use crate::checkpoints::CheckpointWriter;
use crate::frames::FrameFiles;
use crate::lock::FolderLock;
use crate::pictures::Pictures;
use crate::report::{Report, pass_numbers};
use crate::tables::Tables;
use crate::{CompleteFrame, Reporter, RunEnd, RunError, RunFolder, RunOutcome, RunRequest, Stop, films};

/// Runs a scene or resumes a run, and writes its files. `stop` is polled after every event.
///
/// # Errors
/// As [`Session::start`]. A failure after the start is [`RunEnd::Failed`].
pub fn run(
    request: RunRequest,
    reporter: &mut dyn Reporter,
    stop: &dyn Fn() -> Stop,
) -> Result<RunOutcome, RunError> {
    Ok(Session::start(request, reporter)?.finish(reporter, stop))
}

/// A started run.
pub struct Session {
    run: Run,
    folder: RunFolder,
    files: FrameFiles,
    tables: Tables,
    /// The files of the bodies' meshes.
    body_meshes: Vec<WrittenFile>,
    checkpoints: CheckpointWriter,
    pictures: Option<Pictures>,
    /// The films of a run that draws no more pictures.
    films: Vec<Arc<Film>>,
    /// Whether drawing has failed and the failure is reported.
    pictures_failed: bool,
    /// Whether a failure to draw fails the run.
    pictures_required: bool,
    report: Report,
    /// The last frame that the simulation has completed.
    frame: Option<u32>,
    /// The last frame with complete files.
    last_complete: Option<CompleteFrame>,
    summary: Option<Summary>,
    /// Files of earlier frames of a resumed run.
    earlier: Vec<WrittenFile>,
    /// Whether droplets are in no file, and this has not been reported.
    loses_droplets: bool,
    /// Whether alarms of the monitor are warnings.
    warns_of_bursts: bool,
    /// Excludes other runs from the folder.
    _lock: FolderLock,
}

impl Session {
    /// Runs to the end, to a failure, or until `stop` requests it; writes the report.
    pub fn finish(mut self, reporter: &mut dyn Reporter, stop: &dyn Fn() -> Stop) -> RunOutcome {
        let mut failure = None;
        while let Some(event) = self.run.next() {
            let frame_ended = matches!(event, Ok(Event::Frame(_)));
            let finished = matches!(event, Ok(Event::Finished(_)));
            let handled = event.map_err(RunError::from).and_then(|event| self.handle(event, reporter));
            if let Err(error) = handled.and_then(|()| self.report_progress(reporter)) {
                // The computed frames are worth more than the failed one: the run can be resumed before it.
                if matches!(error, RunError::Simulation(_)) {
                    self.checkpoints.take_held();
                }
                failure = Some(error);
                break;
            }
            match stop() {
                Stop::AfterFrame if frame_ended && !finished => {
                    if let Some(frame) = self.frame {
                        failure = self.checkpoints.take(&mut self.run, frame, self.tables.bytes()).err();
                    }
                    break;
                }
                Stop::Now if !finished => break,
                _ => {}
            }
        }
        self.close(failure, reporter)
    }

    fn handle(&mut self, event: Event, reporter: &mut dyn Reporter) -> Result<(), RunError> {
        match event {
            Event::Started(started) => {
                self.report.device = Some(started.device.clone());
                reporter.started(&started);
            }
            Event::Progress(progress) => reporter.progress(&progress),
            Event::Frame(frame) => {
                (self.report.monitor.energy, self.report.monitor.level) = (frame.energy, frame.level);
                let pictures = self.pictures.as_ref().filter(|_| !self.pictures_failed);
                let names = pictures.map(|pictures| pictures.names(frame.index)).unwrap_or_default();
                self.frame = Some(frame.index);
                let has_droplets = frame.droplets.as_ref().is_some_and(|droplets| !droplets.is_empty());
                if has_droplets && std::mem::take(&mut self.loses_droplets) {
                    reporter.warning(
                        "isolated particles leave the surface and become droplets, which meshes in OBJ and STL files do not \
                         contain. Add ply, glb or usd to the formats to write them, or set min_blob = 0 and min_neighbours = 0 \
                         in [surface] to leave them in the mesh",
                    );
                }
                self.tables.write(&frame)?;
                if self.checkpoints.due(frame.index) {
                    self.tables.sync()?;
                    self.checkpoints.take(&mut self.run, frame.index, self.tables.bytes())?;
                }
                if frame.level < Level::Stop {
                    self.checkpoints.hold(&mut self.run, frame.index, self.tables.bytes())?;
                }
                self.files.submit(&frame, names)?;
                if let Some(pictures) = pictures {
                    pictures.submit(&frame);
                }
            }
            Event::Alarm(alarm) => {
                // Unusual values, such as the speed of a single particle in a jet, are only recorded.
                if alarm.level >= Level::Warning && self.warns_of_bursts {
                    reporter.warning(&alarm.message);
                } else if alarm.level >= Level::Warning {
                    reporter.note(&alarm.message);
                }
                // There is no further frame if the time step became too short.
                let highest = &mut self.report.monitor.level;
                *highest = alarm.level.max(*highest);
                // An alarm consists of numbers and words, which can always be represented.
                self.report.monitor.alarms.extend(serde_json::to_value(&alarm));
            }
            Event::Warning(message) => reporter.warning(&message),
            Event::Note(message) => reporter.note(&message),
            Event::Finished(summary) => {
                self.report.set_summary(&summary);
                self.summary = Some(summary);
            }
            // `Event` is non-exhaustive.
            _ => {}
        }
        Ok(())
    }

    /// Reports the first failure to draw, and frames whose files have become complete.
    fn report_progress(&mut self, reporter: &mut dyn Reporter) -> Result<(), RunError> {
        if let Some(failure) = self.pictures.as_ref().and_then(Pictures::failure)
            && !self.pictures_failed
        {
            self.pictures_failed = true;
            reporter.warning(&format!("no more pictures: {failure}"));
        }
        let frames = self.files.completed(self.pictures_failed)?;
        complete(frames, &mut self.report, &mut self.last_complete, reporter);
        if let Some(frame) = &self.last_complete {
            self.checkpoints.write(frame.summary.index, &self.files)?;
        }
        Ok(())
    }

    /// Waits for queued work and writes the report.
    fn close(self, mut failure: Option<RunError>, reporter: &mut dyn Reporter) -> RunOutcome {
        let Self {
            run,
            folder,
            files,
            tables,
            body_meshes,
            checkpoints,
            pictures,
            mut films,
            mut pictures_failed,
            pictures_required,
            mut report,
            frame: _,
            mut last_complete,
            summary,
            earlier: mut written,
            loses_droplets: _,
            warns_of_bursts: _,
            _lock,
        } = self;
        drop(run);
        reporter.waiting("finishing pictures and files");
        let drawn = pictures.map(Pictures::finish).unwrap_or_default();
        films.extend(drawn.films);
        report.picture_passes = pass_numbers(&drawn.timings.passes);
        if let Some(error) = drawn.failure {
            if !pictures_failed {
                reporter.warning(&format!("no more pictures: {error}"));
            }
            pictures_failed = true;
            if pictures_required {
                failure.get_or_insert(error);
            }
        }
        let ended = files.finish(pictures_failed);
        written.extend(ended.files);
        written.extend(tables.finish());
        written.extend(body_meshes);
        complete(ended.frames, &mut report, &mut last_complete, reporter);
        if let Some(error) = ended.failure {
            failure.get_or_insert(error.into());
        }
        if let Err(error) = ended.animated.sync() {
            failure.get_or_insert(error.into());
        }
        match checkpoints.finish(last_complete.as_ref().map(|frame| frame.summary.index)) {
            Ok(files) => written.extend(files),
            Err(error) => {
                failure.get_or_insert(error);
            }
        }
        // However the run ended, the frames written so far form complete scene files. They come after the checkpoint, because
        // they need as much space again as their data.
        for file in ended.animated.finish() {
            match file {
                Ok(file) => {
                    // A continued file replaces that of the earlier run.
                    written.retain(|other| other.path != file.path);
                    written.push(file);
                }
                Err(error) => {
                    failure.get_or_insert(error.into());
                }
            }
        }
        let films = films::finish(&films, reporter);
        // The writer has removed older checkpoints.
        written.retain(|file| file.path.exists());

        report.status = match (&failure, &summary) {
            (Some(_), _) => "failed",
            (None, Some(_)) => "finished",
            (None, None) => "interrupted",
        };
        report.error = failure.as_ref().map(ToString::to_string);
        report.files = written.len() + films.len();
        report.bytes = written.iter().chain(&films).map(|file| file.bytes).sum();
        if let Err(error) = report.write(&folder) {
            failure.get_or_insert(error.into());
        }
        RunOutcome {
            end: match (failure, summary) {
                (Some(failure), _) => RunEnd::Failed(failure),
                (None, Some(summary)) => RunEnd::Finished(Box::new(summary)),
                (None, None) => RunEnd::Interrupted,
            },
            complete_frames: report.complete_frames,
            resumable: !folder.checkpoints().is_empty(),
            folder,
            last_frame: last_complete,
            files: written,
            films,
            picture_timings: drawn.timings,
        }
    }
}

/// Reports frames whose files have become complete.
fn complete(
    frames: Vec<CompleteFrame>,
    report: &mut Report,
    last: &mut Option<CompleteFrame>,
    reporter: &mut dyn Reporter,
) {
    for frame in frames {
        report.complete_frames += 1;
        report.set_end(&frame.summary.stats);
        reporter.frame_complete(&frame);
        *last = Some(frame);
    }
}

/// A count with its noun: 1 file, 2 files.
fn count_of(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}
