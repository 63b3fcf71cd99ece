//! How a run begins: anew, or from a checkpoint.

use std::path::PathBuf;

use splashdown::scene::{PictureKind, Scene};
use splashdown::{Checkpoint, Run, RunOptions};

use super::Session;
use super::earlier::Earlier;
use crate::args::RunArguments;
use crate::checkpoints::{self, Checkpoints, Found};
use crate::exit::{Exit, Failure};
use crate::files::Files;
use crate::layout::{Folders, Layout};
use crate::lock::FolderLock;
use crate::pictures::{self, Pictures};
use crate::probes::ProbeFiles;
use crate::report::Report;
use crate::sequence::is_same;
use crate::teller::Teller;
use crate::wishes::Wishes;
use crate::{human, memory, scene_file};

impl Session {
    pub(super) fn start(arguments: &RunArguments) -> Result<Self, Failure> {
        let found = arguments.resume.as_deref().map(checkpoints::find).transpose()?;
        let mut wishes = Wishes::of(arguments)?;
        let mut scene = match (&arguments.scene, &found) {
            (_, Some(found)) => {
                wishes = wishes.or(found.wishes.clone());
                found.checkpoint.scene()?
            }
            (Some(scene), None) => scene_file::load(scene)?,
            // The parser asks for one of the two.
            (None, None) => return Err(Failure::new(Exit::Usage, "name a scene, or --resume a run")),
        };
        wishes.change(&mut scene);
        let mut options = RunOptions::new(&scene);
        options.device = wishes.device();
        options.frames = wishes.frames;
        options.timing = arguments.timing;
        let kinds = wishes.pictures(&scene)?;
        memory::check(&scene, &options.device)?;

        // Going on where the run was, the frames up to the checkpoint stay; anywhere else they are missing.
        let old_root = found.as_ref().and_then(|found| found.root.clone());
        let root = arguments.out.clone().or_else(|| old_root.clone());
        let root = root.unwrap_or_else(|| PathBuf::from("out").join(&scene.name));
        let in_place = old_root.is_some_and(|old| is_same(&old, &root));
        let frames = options.frames.unwrap_or_else(|| scene.frame_count());
        let layout = match (in_place, wishes.digits) {
            // The names go on as they began.
            (true, Some(digits)) => Layout::with_digits(root, digits),
            _ => Layout::new(root, frames),
        };
        wishes.digits = Some(layout.digits());
        let report = Report::begin(&scene);
        let mut teller = Teller::new(arguments.json, arguments.verbosity.level(), report);
        for warning in &scene.warnings {
            teller.warn(&warning.to_string());
        }
        if found.is_some() {
            warn_of_changes(&scene, &teller);
        }
        for reason in found.iter().flat_map(|found| &found.passed_over) {
            teller.warn(&format!("a checkpoint was passed over: {reason}"));
        }
        let wanted = Folders::of(&scene, scene.surface.enabled, !kinds.is_empty());
        layout.make(wanted)?;
        let lock = FolderLock::take(layout.root())?;
        if wishes.checkpoint_every.is_some() {
            layout.make_checkpoints()?;
        }

        let surface = options.surface;
        options.listener = Some(teller.listener());
        let run = match &found {
            Some(found) => Run::resume(&found.checkpoint, &scene, options)?,
            None => Run::new(&scene, options)?,
        };
        if found.is_some() && run.first_frame() >= frames {
            let done = run.first_frame();
            let message = format!(
                "--resume: frame {done} is done already and the run ends with frame {frames}: give --frames a larger number to make it longer"
            );
            return Err(Failure::new(Exit::Usage, message));
        }
        if let Some(found) = &found {
            note_of_device(&found.checkpoint, &run, &teller)?;
            let as_before =
                (&wishes.formats, wishes.no_surface) == (&found.wishes.formats, found.wishes.no_surface);
            if !(in_place && as_before) {
                wishes.since = run.first_frame() + 1;
            }
        }
        let begins = if in_place { Some(run.first_frame()) } else { None };
        if let Some(frame) = begins {
            teller.resumed(frame as usize + 1);
        }
        // Where a run has been, what it left half-written is of no use to anybody.
        if begins.is_some() || layout.report().exists() {
            checkpoints::remove_partial(layout.root());
        }
        let mut files = Files::start(layout.clone(), &scene, surface, begins)?;
        if let Some(frame) = begins {
            files.resume(frame, scene.frame_rate);
        }
        let mut session = Self {
            run,
            files,
            probes: ProbeFiles::default(),
            checkpoints: Checkpoints::new(layout.clone(), wishes.clone()),
            frame: None,
            pictures: None,
            no_more_pictures: false,
            pictures_demanded: arguments.pictures.is_some(),
            timing: arguments.timing,
            layout,
            teller,
            earlier: Vec::new(),
            _lock: lock,
        };
        match session.start_pictures(&scene, kinds, wishes.no_film, begins) {
            Err(failure) if session.pictures_demanded => return Err(failure),
            Err(failure) => {
                session.teller.warn(&format!("no pictures: {failure}. Simulation and files go on"))
            }
            Ok(()) => {}
        }
        // Only now that nothing can refuse the run any more are the frames of an earlier one worth less than
        // room for its own.
        match begins {
            Some(frame) => {
                session.layout.remove_after(frame);
                if let Some(found) = &found {
                    session.look_back(found, frame)?;
                }
                session.probes = ProbeFiles::resume(&scene, &session.layout, &wishes.probe_bytes)?;
            }
            None => {
                session.replace_earlier(&scene, wanted, wishes.checkpoint_every.is_some())?;
                session.probes = ProbeFiles::create(&scene, &session.layout)?;
            }
        }
        Ok(session)
    }

    /// Finds the files of the frames before, and tells which are not there.
    fn look_back(&mut self, found: &Found, last: u32) -> Result<(), Failure> {
        let mut scene = found.checkpoint.scene()?;
        found.wishes.change(&mut scene);
        let pictures = found.wishes.pictures(&scene)?;
        let earlier = Earlier::find(&self.layout, &scene, &pictures, found.wishes.since, last);
        if let Some(warning) = earlier.warning(self.layout.root()) {
            self.teller.warn(&warning);
        }
        self.earlier = earlier.files;
        Ok(())
    }

    /// Removes what an earlier run left, and leaves the first word of this one.
    fn replace_earlier(&self, scene: &Scene, wanted: Folders, checkpoints: bool) -> Result<(), Failure> {
        let files = self.layout.remove_earlier();
        if files > 0 {
            let what = human::counted(files as u64, "file");
            self.teller
                .note(&format!("Removed {what} of an earlier run in {}.", self.layout.root().display()));
        }
        self.layout.make(wanted)?;
        if checkpoints {
            self.layout.make_checkpoints()?;
        }
        Report::begin(scene).write(&self.layout)?;
        Ok(())
    }

    fn start_pictures(
        &mut self,
        scene: &Scene,
        kinds: Vec<PictureKind>,
        no_film: bool,
        begins: Option<u32>,
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
        if let (Some(last), false) = (begins, films.is_empty()) {
            self.teller.waiting("putting the earlier pictures into the film");
            let missing = pictures::resume_films(&films, &kinds, &self.layout, last, &self.files.writer())?;
            if missing > 0 {
                self.teller
                    .warn(&format!("the film lacks {missing} of the earlier pictures: they are not there"));
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
}

/// A checkpoint goes on with the scene that is in it, whatever has become of the file since.
fn warn_of_changes(scene: &Scene, teller: &Teller) {
    let Some(path) = &scene.source else { return };
    if let Ok(text) = std::fs::read_to_string(path)
        && *text != *scene.text
    {
        let file = path.display();
        teller.warn(&format!(
            "`{file}` has changed since; the run goes on with the scene as it was. Run it anew for the changes"
        ));
    }
}

/// The bits are those of a run that did not stop only where they were made.
fn note_of_device(checkpoint: &Checkpoint, run: &Run, teller: &Teller) -> Result<(), Failure> {
    let now = run.gpu().map_or_else(|| "CPU".to_owned(), |gpu| gpu.name());
    if let Some(then) = checkpoint.device()?
        && then != now
    {
        teller.note(&format!(
            "The checkpoint was made on {then}, and the run goes on on {now}: from here on its numbers differ in their last digits."
        ));
    }
    Ok(())
}
