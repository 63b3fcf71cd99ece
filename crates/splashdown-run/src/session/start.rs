//! Starting a run, from the scene or from a checkpoint.

use std::path::PathBuf;

use splashdown::scene::{OnBurst, PictureKind, Scene};
use splashdown::{Run, RunOptions};

use super::earlier::Earlier;
use super::{Session, count_of};
use crate::body_meshes;
use crate::checkpoints::CheckpointWriter;
use crate::folder::{Subfolders, remove_partial};
use crate::frames::FrameFiles;
use crate::lock::FolderLock;
use crate::pictures::{self, FrameRenderer, Pictures};
use crate::report::{Report, alarms_until, is_finished};
use crate::sequence::is_same;
use crate::tables::Tables;
use crate::{FoundCheckpoint, Reporter, RunError, RunFolder, RunRequest, appearance, films};

impl Session {
    /// Locks the output folder, prepares the simulation and the device that draws, and removes the files of an earlier
    /// run.
    ///
    /// # Errors
    /// [`RunError`], if the run cannot start. The files of an earlier run are then intact.
    pub fn start(request: RunRequest, reporter: &mut dyn Reporter) -> Result<Self, RunError> {
        let kinds = request.pictures()?;
        let mut notes = request.notes();
        let (device, frames) = (request.device(), request.last_frame());
        let RunRequest { out, timing, scene, settings, pictures_required, checkpoint: found } = request;

        // A run resumed in its own folder continues the series of files. In another folder it starts new series.
        let old_root = found.as_ref().and_then(|found| found.root.clone());
        let root = out.or_else(|| old_root.clone());
        let root = root.unwrap_or_else(|| PathBuf::from("out").join(&scene.name));
        let in_place = old_root.is_some_and(|old| is_same(&old, &root));
        let folder = match (in_place, notes.digits) {
            (true, Some(digits)) => RunFolder::with_digits(root, digits),
            _ => RunFolder::new(root, frames),
        };
        notes.digits = Some(folder.digits());
        for warning in &scene.warnings {
            reporter.warning(&warning.to_string());
        }
        if let Some(found) = &found {
            warn_of_changes(&scene, reporter);
            for reason in &found.skipped {
                reporter.warning(&format!("a checkpoint was skipped: {reason}"));
            }
        }
        let subfolders = Subfolders::of(&scene, !kinds.is_empty(), settings.checkpoint_every.is_some());
        folder.create_subfolders(Subfolders { checkpoints: false, ..subfolders })?;
        let lock = FolderLock::take(folder.root())?;
        folder.create_subfolders(subfolders)?;

        let mut options = RunOptions::new(&scene);
        (options.device, options.frames, options.timing) = (device, settings.frames, timing);
        let on_burst = settings.on_burst.unwrap_or(OnBurst::Stop);
        options.on_burst = on_burst;
        options.vertex_velocities |= kinds.contains(&PictureKind::Surface) && pictures::is_blurred(&scene);
        options.progress = reporter.preparation();
        let run = match &found {
            Some(found) => Run::resume(&found.checkpoint, &scene, options)?,
            None => Run::new(&scene, options)?,
        };
        if let Some(found) = &found {
            let lacks_files = || in_place && is_unfinished(&folder, &scene, &kinds, settings.film);
            if run.first_frame() > frames || (run.first_frame() == frames && !lacks_files()) {
                return Err(RunError::AlreadyFinished { done: run.first_frame(), frames });
            }
            note_device(found, &run, reporter)?;
            let before = found.notes.settings();
            let same_output = (&settings.formats, settings.surface) == (&before.formats, before.surface);
            if !(in_place && same_output) {
                notes.since = run.first_frame() + 1;
            }
        }
        let resumed_after = in_place.then(|| run.first_frame());
        let mut report = Report::new(&scene, &settings);
        if in_place {
            let time = f64::from(run.first_frame()) / f64::from(scene.frame_rate);
            report.monitor.alarms = alarms_until(&folder, time + 1e-9);
        }
        report.complete_frames = resumed_after.map_or(0, |frame| frame as usize + 1);
        if in_place || folder.report().exists() {
            remove_partial(folder.root());
        }
        let keep = settings.checkpoint_every.is_some();
        let files = FrameFiles::start(folder.clone(), &scene, run.bodies(), resumed_after, keep)?;
        let table_bytes = std::mem::take(&mut notes.table_bytes);
        let mut session = Self {
            run,
            files,
            tables: Tables::default(),
            body_meshes: Vec::new(),
            checkpoints: CheckpointWriter::new(folder.clone(), settings.checkpoint_every, notes),
            pictures: None,
            films: Vec::new(),
            pictures_failed: false,
            pictures_required,
            report,
            frame: None,
            last_complete: None,
            summary: None,
            earlier: Vec::new(),
            loses_droplets: loses_droplets(&scene),
            warns_of_bursts: on_burst != OnBurst::Ignore,
            folder,
            _lock: lock,
        };
        let draws = session.run.first_frame() < frames;
        match session.start_pictures(&scene, kinds, settings.film, resumed_after, (draws, timing), reporter) {
            Err(error) if pictures_required => return Err(error),
            Err(error) => reporter.warning(&format!("no pictures: {error}. The run continues without them")),
            Ok(()) => {}
        }
        // All checks have passed. From here on the files of an earlier run are removed.
        match resumed_after {
            Some(frame) => {
                session.folder.remove_after(frame);
                if let Some(found) = &found {
                    session.find_earlier(found, frame, reporter)?;
                }
            }
            None => session.replace_earlier(subfolders, reporter)?,
        }
        // A killed run must not leave the report of an earlier run.
        session.report.write(&session.folder)?;
        session.tables = match resumed_after {
            Some(_) => Tables::resume(&scene, &session.folder, &table_bytes, reporter)?,
            None => Tables::create(&scene, &session.folder)?,
        };
        session.body_meshes = body_meshes::write(session.run.bodies(), &session.folder)?;
        Ok(session)
    }

    /// Finds the files of earlier frames and warns of missing ones.
    fn find_earlier(
        &mut self,
        found: &FoundCheckpoint,
        last: u32,
        reporter: &mut dyn Reporter,
    ) -> Result<(), RunError> {
        let mut scene = found.checkpoint.scene()?;
        let settings = found.notes.settings();
        settings.apply_to(&mut scene);
        let pictures = settings.pictures_of(&scene)?;
        let earlier = Earlier::find(&self.folder, &scene, &pictures, found.notes.since, last);
        if let Some(warning) = earlier.warning(self.folder.root()) {
            reporter.warning(&warning);
        }
        self.earlier = earlier.files;
        Ok(())
    }

    /// Removes the files of an earlier run.
    fn replace_earlier(&self, subfolders: Subfolders, reporter: &mut dyn Reporter) -> Result<(), RunError> {
        let files = self.folder.remove_earlier();
        if files > 0 {
            let (files, root) = (count_of(files, "file"), self.folder.root().display());
            reporter.note(&format!("Removed {files} of an earlier run in {root}."));
        }
        Ok(self.folder.create_subfolders(subfolders)?)
    }

    fn start_pictures(
        &mut self,
        scene: &Scene,
        kinds: Vec<PictureKind>,
        film: bool,
        resumed_after: Option<u32>,
        (draws, timing): (bool, bool),
        reporter: &mut dyn Reporter,
    ) -> Result<(), RunError> {
        if kinds.is_empty() {
            return Ok(());
        }
        if let Some(problem) = appearance::caption_problem(scene) {
            reporter.warning(&problem);
        }
        // No device is needed if only the film is missing.
        let gpu = if draws { Some(pictures::drawing_device(self.run.gpu())?) } else { None };
        let mut films = Vec::new();
        if scene.output.film && film {
            let (started, failures) = films::start(scene, &kinds, &self.folder);
            films = started;
            for failure in failures {
                reporter.warning(&failure);
            }
        }
        if let (Some(last), false) = (resumed_after, films.is_empty()) {
            reporter.waiting("adding the earlier pictures to the film");
            let missing = films::add_existing(&films, &kinds, &self.folder, last, &self.files.writer())?;
            if missing > 0 {
                let missing = count_of(missing as usize, "earlier picture");
                reporter.warning(&format!("{missing} cannot be found and will be missing in the film"));
            }
        }
        let Some(gpu) = gpu else {
            self.films = films;
            return Ok(());
        };
        let mut renderer = FrameRenderer::new(gpu, scene, self.run.bodies(), kinds.clone())?;
        if timing && !renderer.enable_timing() {
            reporter.warning(
                "the device that draws has no timestamps: the passes of the pictures are not measured",
            );
        }
        let writer = self.files.writer();
        self.pictures = Some(Pictures::start(renderer, kinds, films, &self.folder, writer)?);
        Ok(())
    }
}

/// Whether isolated particles leave the surface, and no file of the run contains them: OBJ and STL files have no points.
fn loses_droplets(scene: &Scene) -> bool {
    let formats = &scene.output.formats;
    let has_surface = formats.iter().any(|format| format.has_surface());
    scene.surface.separates() && has_surface && !formats.iter().any(|format| format.has_points())
}

/// Whether a run whose frames are all complete lacks other files: it was killed or failed, or a film is missing.
fn is_unfinished(folder: &RunFolder, scene: &Scene, kinds: &[PictureKind], film: bool) -> bool {
    let can_film = film && scene.output.film;
    let lacks_film = |&kind: &PictureKind| folder.picture(kind, 0).exists() && !folder.film(kind).exists();
    !is_finished(folder)
        || !folder.scene_parts().is_empty()
        || (can_film && films::can_encode() && kinds.iter().any(lacks_film))
}

/// A resumed run uses the scene in its checkpoint, even if the file has changed.
fn warn_of_changes(scene: &Scene, reporter: &mut dyn Reporter) {
    let Some(path) = &scene.source else { return };
    if path.is_file()
        && let Ok(text) = std::fs::read_to_string(path)
        && *text != *scene.text
    {
        let file = path.display();
        reporter.warning(&format!(
            "`{file}` has changed since the checkpoint; the resumed run uses the scene in the checkpoint. Start a new run to apply the changes"
        ));
    }
}

/// A resumed run is bit-identical to an uninterrupted one on the same device only.
fn note_device(found: &FoundCheckpoint, run: &Run, reporter: &mut dyn Reporter) -> Result<(), RunError> {
    let now = run.gpu().map_or_else(|| "CPU".to_owned(), |gpu| gpu.name());
    if let Some(then) = found.checkpoint.device()?
        && then != now
    {
        reporter.note(&format!(
            "The checkpoint was made on {then}, and the run continues on {now}: from here on results differ in rounding."
        ));
    }
    Ok(())
}
