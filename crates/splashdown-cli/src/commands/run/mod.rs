//! `splashdown run`: one loop over the library's stream of events.

mod earlier;
mod start;

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use splashdown::{Event, Run};
use splashdown_io::{Film, WrittenFile};

use crate::args::RunArguments;
use crate::checkpoints::Checkpoints;
use crate::console::{self, Verbosity};
use crate::exit::Failure;
use crate::files::Files;
use crate::interrupt::{Interrupt, Wish};
use crate::layout::Layout;
use crate::lines::Line;
use crate::lock::FolderLock;
use crate::pictures::Pictures;
use crate::probes::ProbeFiles;
use crate::teller::Teller;

/// Runs a scene to its end, or as far as it goes.
pub fn run(arguments: &RunArguments) -> Result<ExitCode, Failure> {
    if arguments.verbosity.level() == Verbosity::Verbose {
        // Fails only if someone else has set one, and then that one speaks.
        let _ = tracing_subscriber::fmt()
            .with_writer(std::io::stderr)
            .with_target(false)
            .without_time()
            .try_init();
    }
    let outcome = Session::start(arguments).and_then(Session::finish);
    if let (Err(failure), true) = (&outcome, arguments.json) {
        console::print_json(&Line::error(failure));
    }
    outcome
}

/// A run under way.
struct Session {
    run: Run,
    files: Files,
    probes: ProbeFiles,
    checkpoints: Checkpoints,
    /// The last frame that the simulation has completed.
    frame: Option<u32>,
    pictures: Option<Pictures>,
    /// Drawing has failed, and that was told.
    no_more_pictures: bool,
    /// A failure to draw is then one of the run.
    pictures_demanded: bool,
    timing: bool,
    layout: Layout,
    teller: Teller,
    /// Files of the frames before, where the run goes on.
    earlier: Vec<WrittenFile>,
    /// Keeps other runs out of the folder.
    _lock: FolderLock,
}

impl Session {
    /// Runs to the end, to a failure, or to Ctrl-C.
    fn finish(mut self) -> Result<ExitCode, Failure> {
        let interrupt = Interrupt::listen();
        let mut failure = None;
        while let Some(event) = self.run.next() {
            let frame_ended = matches!(event, Ok(Event::Frame(_)));
            let finished = matches!(event, Ok(Event::Finished(_)));
            let handled = event.map_err(Failure::from).and_then(|event| self.handle(event));
            if let Err(error) = handled.and_then(|()| self.announce()) {
                failure = Some(error);
                break;
            }
            match interrupt.wish() {
                Wish::StopAfterFrame if frame_ended && !finished => {
                    if let Some(frame) = self.frame {
                        let taken = self.checkpoints.take(&mut self.run, frame, self.probes.bytes());
                        failure = taken.err();
                    }
                    break;
                }
                Wish::StopNow if !finished => break,
                _ => {}
            }
        }
        self.close(failure)
    }

    fn handle(&mut self, event: Event) -> Result<(), Failure> {
        match event {
            Event::Started(started) => self.teller.started(&started),
            Event::Progress(progress) => self.teller.progress(&progress),
            Event::Frame(frame) => {
                let pictures = self.pictures.as_ref().filter(|_| !self.no_more_pictures);
                let names = pictures.map(|pictures| pictures.names(frame.index)).unwrap_or_default();
                self.frame = Some(frame.index);
                self.probes.write(&frame)?;
                if self.checkpoints.due(frame.index) {
                    self.checkpoints.take(&mut self.run, frame.index, self.probes.bytes())?;
                }
                self.files.submit(&frame, names)?;
                if let Some(pictures) = pictures {
                    pictures.submit(&frame);
                }
            }
            Event::Warning(message) => self.teller.warn(&message),
            Event::Note(message) => self.teller.note(&message),
            Event::Finished(summary) => self.teller.finished(summary),
            // The library may learn to tell more than this program knows.
            _ => {}
        }
        Ok(())
    }

    /// Tells of drawing that has failed, once, and of frames whose files have become complete.
    fn announce(&mut self) -> Result<(), Failure> {
        if let Some(failure) = self.pictures.as_ref().and_then(Pictures::failure)
            && !self.no_more_pictures
        {
            self.no_more_pictures = true;
            self.teller.warn(&format!("no more pictures: {failure}"));
        }
        self.teller.complete(self.files.completed(self.no_more_pictures)?);
        if let Some(complete) = self.teller.last_complete() {
            self.checkpoints.write(complete, &self.files.writer())?;
        }
        Ok(())
    }

    /// Waits for what is under way, then says how it went.
    fn close(self, mut failure: Option<Failure>) -> Result<ExitCode, Failure> {
        let Self {
            run,
            files,
            probes,
            checkpoints,
            frame: _,
            pictures,
            mut no_more_pictures,
            pictures_demanded,
            timing,
            layout,
            mut teller,
            mut earlier,
            _lock,
        } = self;
        drop(run);
        teller.waiting("finishing pictures and files");
        let (films, drawing) = pictures.map(Pictures::finish).unwrap_or_default();
        if let Some(error) = drawing {
            if !no_more_pictures {
                teller.warn(&format!("no more pictures: {error}"));
            }
            no_more_pictures = true;
            if pictures_demanded {
                failure.get_or_insert(error);
            }
        }
        let mut ended = files.finish(no_more_pictures);
        earlier.append(&mut ended.files);
        earlier.extend(probes.finish());
        teller.complete(ended.frames);
        if let Some(error) = ended.failure {
            failure.get_or_insert(error.into());
        }
        match checkpoints.finish(teller.last_complete()) {
            Ok(mut written) => earlier.append(&mut written),
            Err(error) => {
                failure.get_or_insert(error);
            }
        }
        teller.can_go_on(!layout.checkpoints().is_empty());
        let films = finish_films(&films, &teller);
        // Of the checkpoints only the last stay.
        earlier.retain(|file| file.path.exists());
        teller.close(&layout, &earlier, &films, failure, timing)
    }
}

/// Ends the films; one that failed costs a warning, the pictures are what matters.
fn finish_films(films: &[Arc<Film>], teller: &Teller) -> Vec<(PathBuf, u64)> {
    let mut done = Vec::new();
    for film in films {
        match film.finish() {
            Ok(bytes) => done.push((film.options().path.clone(), bytes)),
            Err(error) => teller.warn(&error.to_string()),
        }
    }
    done
}
