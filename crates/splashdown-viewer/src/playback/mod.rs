//! Playing the frames of a finished run from its folder.
//!
//! A thread reads the frames that follow the position of the [`Timeline`], and a cache keeps them up to a limit of
//! memory. None of it needs a device: the app uploads the frame that it shows.

mod cache;
mod loader;

use std::collections::BTreeSet;
use std::sync::Arc;

use splashdown::BodyMesh;
use splashdown_run::{PlayedFrame, RunFrames};

use crate::timeline::Timeline;
use cache::Cache;
use loader::{Loaded, Loader, Source};

/// Bytes of the frames in memory.
pub const MEMORY: usize = 512 << 20;

impl Source for Arc<RunFrames> {
    fn bodies(&self) -> Result<Vec<BodyMesh>, String> {
        self.body_meshes().map_err(|error| error.to_string())
    }

    fn frame(&self, number: u32) -> Result<PlayedFrame, String> {
        self.read(number).map_err(|error| error.to_string())
    }
}

/// A run that is played.
pub struct Playback {
    frames: Arc<RunFrames>,
    loader: Loader,
    cache: Cache<Arc<PlayedFrame>>,
    bodies: Option<Arc<[BodyMesh]>>,
    /// Frames that cannot be read.
    failed: BTreeSet<u32>,
    /// Whether a file that cannot be read was reported.
    reported: bool,
}

impl Playback {
    /// Starts to read the frames. At most `memory` bytes of them stay in memory, but always two frames. `repaint` is
    /// called when there is something new to show. Returns also the timeline, and what is missing in the folder.
    ///
    /// # Errors
    /// If no thread can be started.
    pub fn start(
        frames: RunFrames,
        memory: usize,
        repaint: impl Fn() + Send + 'static,
    ) -> Result<(Self, Timeline, Option<String>), String> {
        let frames = Arc::new(frames);
        let source = Arc::clone(&frames);
        Self::start_from(frames, source, memory, repaint)
    }

    fn start_from(
        frames: Arc<RunFrames>,
        source: impl Source,
        memory: usize,
        repaint: impl Fn() + Send + 'static,
    ) -> Result<(Self, Timeline, Option<String>), String> {
        let (has_particles, has_meshes) = frames.has_particles_and_meshes();
        let mut timeline = Timeline::new(frames.numbers().collect(), frames.scene().frame_rate)
            .ok_or_else(|| format!("`{}` has no frames", frames.folder().display()))?;
        timeline.can_continue = frames.has_checkpoint();
        (timeline.has_particles, timeline.has_meshes) = (has_particles, has_meshes);
        let problems: Vec<String> = frames.problems().collect();
        let problem = (!problems.is_empty())
            .then(|| format!("`{}`: {}", frames.folder().display(), problems.join("; ")));
        let loader = Loader::start(source, repaint)
            .map_err(|error| format!("no thread could be started to read the frames: {error}"))?;
        let playback = Self {
            frames,
            loader,
            cache: Cache::new(memory),
            bodies: None,
            failed: BTreeSet::new(),
            reported: false,
        };
        Ok((playback, timeline, problem))
    }

    /// Receives what was read and requests what is needed next. Returns the messages to show. Of the files that cannot be
    /// read only the first is reported; later ones are counted in [`Timeline::left_out`].
    pub fn update(&mut self, timeline: &mut Timeline) -> Vec<String> {
        let mut messages = Vec::new();
        for loaded in self.loader.take() {
            match loaded {
                Loaded::Bodies(Ok(meshes)) => self.bodies = Some(meshes.into()),
                Loaded::Bodies(Err(reason)) => {
                    self.bodies = Some(Arc::from([]));
                    messages.push(format!("the bodies are not shown: {reason}"));
                }
                Loaded::Frame(number, Ok(frame)) => {
                    if let Some(problem) = frame.problems.first() {
                        let problem = format!("frame {number} is shown without a file: {problem}");
                        messages.extend(self.report(&problem));
                    }
                    let bytes = frame.bytes();
                    let distance = |number| timeline.distance(number);
                    self.cache.insert(number, frame, bytes, distance);
                }
                Loaded::Frame(number, Err(reason)) => {
                    self.failed.insert(number);
                    timeline.leave_out(number);
                    let problem = format!("frame {number} is left out: {reason}");
                    messages.extend(self.report(&problem));
                }
                Loaded::Stopped(reason) => {
                    timeline.playing = false;
                    messages.push(format!("no more frames are read: {reason}. Open the run again"));
                }
            }
        }
        let is_wanted = |&number: &u32| self.cache.get(number).is_none() && !self.failed.contains(&number);
        self.loader.want(timeline.upcoming(self.cache.capacity()).filter(is_wanted).collect());
        messages
    }

    /// The message, unless one was reported.
    fn report(&mut self, message: &str) -> Option<String> {
        let is_first = !std::mem::replace(&mut self.reported, true);
        is_first.then(|| format!("{message}. Others like it are not reported"))
    }

    /// A frame, if it is in memory and the meshes of the bodies are known.
    pub fn frame(&self, number: u32) -> Option<Arc<PlayedFrame>> {
        self.bodies.as_ref()?;
        self.cache.get(number).map(Arc::clone)
    }

    /// The meshes of the bodies, in the order of the states in a frame.
    pub fn bodies(&self) -> Option<Arc<[BodyMesh]>> {
        self.bodies.clone()
    }

    /// The run.
    pub fn run(&self) -> &RunFrames {
        &self.frames
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, Instant};

    /// A run whose first frame is damaged, and whose second frame reaches a bug of this program.
    struct Broken;

    impl Source for Broken {
        fn bodies(&self) -> Result<Vec<BodyMesh>, String> {
            Ok(Vec::new())
        }

        fn frame(&self, number: u32) -> Result<PlayedFrame, String> {
            assert_eq!(number, 0, "this frame cannot be handled");
            Err("it is damaged".to_owned())
        }
    }

    #[test]
    fn a_panic_of_the_loading_thread_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("particles")).unwrap();
        for number in 0..3 {
            let name = format!("particles/particles_{number:04}.ply");
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let (name, text) = splashdown::scene::presets()[0];
        let scene = splashdown::scene::Scene::parse(text, name).unwrap();
        let frames = Arc::new(RunFrames::open(folder.path(), Some(scene)).unwrap());
        let (mut playback, mut timeline, _) = Playback::start_from(frames, Broken, MEMORY, || {}).unwrap();
        let (begun, mut messages) = (Instant::now(), Vec::new());
        while timeline.playing && begun.elapsed() < Duration::from_secs(30) {
            messages.extend(playback.update(&mut timeline));
            std::thread::sleep(Duration::from_millis(1));
        }
        // Also after another problem was reported, which hides later problems of files.
        assert!(messages.len() == 2 && messages[0].contains("it is damaged"), "{messages:?}");
        assert!(messages[1].contains("bug") && messages[1].contains("cannot be handled"), "{messages:?}");
    }
}
