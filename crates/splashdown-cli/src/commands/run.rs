//! `splashdown run`: one loop over the library's stream of events.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use splashdown::scene::{PictureKind, Scene};
use splashdown::{Event, Run, RunOptions};
use splashdown_io::Film;

use crate::args::RunArguments;
use crate::console::{self, Verbosity};
use crate::exit::{Exit, Failure};
use crate::files::Files;
use crate::interrupt::{Interrupt, Wish};
use crate::layout::{Folders, Layout};
use crate::lines::Line;
use crate::pictures::{self, Pictures};
use crate::probes::ProbeFiles;
use crate::report::Report;
use crate::teller::Teller;
use crate::{human, memory, scene_file};

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
    pictures: Option<Pictures>,
    /// Drawing has failed, and that was told.
    no_more_pictures: bool,
    /// A failure to draw is then one of the run.
    pictures_demanded: bool,
    timing: bool,
    layout: Layout,
    teller: Teller,
}

impl Session {
    fn start(arguments: &RunArguments) -> Result<Self, Failure> {
        let scene = scene_as_wanted(arguments)?;
        let mut options = RunOptions::new(&scene);
        options.device = arguments.device.device.clone();
        options.frames = arguments.frames;
        options.timing = arguments.timing;
        let kinds = pictures_wanted(&scene, options.surface, arguments)?;
        memory::check(&scene, &options.device)?;

        let root = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&scene.name));
        let layout = Layout::new(root, options.frames.unwrap_or_else(|| scene.frame_count()));
        let report = Report::begin(&scene);
        let teller = Teller::new(arguments.json, arguments.verbosity.level(), report);
        for warning in &scene.warnings {
            teller.warn(&warning.to_string());
        }
        let wanted = Folders::of(&scene, options.surface, !kinds.is_empty());
        layout.make(wanted)?;

        let timing = options.timing;
        options.listener = Some(teller.listener());
        let run = Run::new(&scene, options)?;
        let mut session = Self {
            run,
            files: Files::start(layout.clone(), scene.output.formats.clone())?,
            probes: ProbeFiles::default(),
            pictures: None,
            no_more_pictures: false,
            pictures_demanded: arguments.pictures.is_some(),
            timing,
            layout,
            teller,
        };
        match session.start_pictures(&scene, kinds, arguments.no_film) {
            Err(failure) if session.pictures_demanded => return Err(failure),
            Err(failure) => {
                session.teller.warn(&format!("no pictures: {failure}. Simulation and files go on"))
            }
            Ok(()) => {}
        }
        // Only now that nothing can refuse the run any more are the frames of an earlier one worth less than room for its own.
        session.replace_earlier(&scene, wanted)?;
        session.probes = ProbeFiles::create(&scene, &session.layout)?;
        Ok(session)
    }

    /// Removes what an earlier run left, and leaves the first word of this one.
    fn replace_earlier(&self, scene: &Scene, wanted: Folders) -> Result<(), Failure> {
        let files = self.layout.remove_earlier();
        if files > 0 {
            let what = human::counted(files as u64, "file");
            self.teller
                .note(&format!("Removed {what} of an earlier run in {}.", self.layout.root().display()));
        }
        self.layout.make(wanted)?;
        Report::begin(scene).write(&self.layout)?;
        Ok(())
    }

    fn start_pictures(
        &mut self,
        scene: &Scene,
        kinds: Vec<PictureKind>,
        no_film: bool,
    ) -> Result<(), Failure> {
        if kinds.is_empty() {
            return Ok(());
        }
        let gpu = pictures::drawing_device(self.run.gpu())?;
        let mut films = Vec::new();
        if scene.output.film && !no_film {
            let (started, obstacles) = pictures::start_films(scene, &kinds, &self.layout);
            films = started;
            for obstacle in obstacles {
                self.teller.warn(&obstacle);
            }
        }
        self.pictures = Some(Pictures::start(
            gpu,
            scene,
            self.run.bodies(),
            kinds,
            films,
            &self.layout,
            self.files.writer(),
        )?);
        Ok(())
    }

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
                Wish::StopAfterFrame if frame_ended && !finished => break,
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
                self.probes.write(&frame)?;
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
        Ok(())
    }

    /// Waits for what is under way, then says how it went.
    fn close(self, mut failure: Option<Failure>) -> Result<ExitCode, Failure> {
        let Self {
            run,
            files,
            probes,
            pictures,
            mut no_more_pictures,
            pictures_demanded,
            timing,
            layout,
            mut teller,
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
        ended.files.extend(probes.finish());
        teller.complete(ended.frames);
        if let Some(error) = ended.failure {
            failure.get_or_insert(error.into());
        }
        let films = finish_films(&films, &teller);
        teller.close(&layout, &ended.files, &films, failure, timing)
    }
}

/// The scene with the command line's wishes in place of its own.
fn scene_as_wanted(arguments: &RunArguments) -> Result<Scene, Failure> {
    let mut scene = scene_file::load(&arguments.scene)?;
    scene.surface.enabled &= !arguments.no_surface;
    if let Some(formats) = &arguments.formats {
        if formats.contains(&None) && formats.iter().any(Option::is_some) {
            let message = "--formats: `none` stands alone; leave it out to write the others";
            return Err(Failure::new(Exit::Usage, message));
        }
        scene.output.formats = once_each(formats.iter().flatten().copied());
    }
    if let Some(pictures) = &arguments.pictures {
        scene.output.pictures = once_each(pictures.iter().copied());
    }
    Ok(scene)
}

/// A file that is asked for twice is written once: two writers of one name would race.
fn once_each<T: PartialEq>(list: impl Iterator<Item = T>) -> Vec<T> {
    list.fold(Vec::new(), |mut found, item| {
        if !found.contains(&item) {
            found.push(item);
        }
        found
    })
}

/// The pictures to draw; those of the surface need one.
fn pictures_wanted(
    scene: &Scene,
    surface: bool,
    arguments: &RunArguments,
) -> Result<Vec<PictureKind>, Failure> {
    let mut kinds = if arguments.no_pictures { Vec::new() } else { scene.output.pictures.clone() };
    if surface || !kinds.contains(&PictureKind::Surface) {
        return Ok(kinds);
    }
    if arguments.pictures.is_some() {
        let message = "pictures of the surface need a surface: leave out --no-surface (or surface.enabled = false in the \
                       scene), or draw --pictures particles";
        return Err(Failure::new(Exit::Usage, message));
    }
    kinds.retain(|&kind| kind != PictureKind::Surface);
    Ok(kinds)
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
