//! Recording a film frame by frame: the engine continues after each frame is drawn.

use std::sync::Arc;

use egui::Context;
use splashdown_run::Recorder;

use super::Viewer;
use crate::engine::{Command, Snapshot};

/// A recording in progress, and its last frame.
pub(super) struct Recording {
    recorder: Recorder,
    last: Option<Arc<Snapshot>>,
}

impl Viewer {
    /// Completes the film that is being recorded, if any.
    pub(super) fn end_recording(&mut self) {
        let Some(Recording { recorder, .. }) = self.recording.take() else { return };
        self.state.recorded = None;
        let folder = format!("{} ({} pictures)", recorder.folder().display(), recorder.frames());
        let exported = recorder.finish().map(|()| folder).map_err(|error| error.to_string());
        self.report_export("the film", exported, self.requested.shown_at);
    }

    pub(super) fn toggle_recording(&mut self, now: f64) {
        if self.recording.is_some() {
            self.end_recording();
            return;
        }
        let name = std::path::PathBuf::from(format!("{}-film", self.state.scene.name));
        match Recorder::start(
            &name,
            self.size,
            splashdown_run::films::frame_rate(self.state.scene.frame_rate),
        ) {
            Ok((recorder, failure)) => {
                if let Some(failure) = failure {
                    self.state.notify(failure, true, now);
                }
                self.state.playing = false;
                self.state.recorded = Some(0);
                self.engine.send(Command::Play(false));
                self.recording = Some(Recording { recorder, last: None });
            }
            Err(reason) => self.state.notify(format!("recording is not possible: {reason}"), true, now),
        }
    }

    /// Adds a new frame to the recording and requests the next one.
    pub(super) fn record(&mut self, ctx: &Context) {
        let Some(recording) = &mut self.recording else { return };
        let Some(snapshot) = self.engine.snapshot().filter(|snapshot| !snapshot.playing) else { return };
        if recording.last.as_ref().is_some_and(|last| Arc::ptr_eq(last, &snapshot)) {
            return;
        }
        let size = recording.recorder.size();
        let aspect = size[0] as f32 / size[1] as f32;
        self.drawn = None;
        let drawn = self.picture.draw(size, &snapshot, &self.state.look, self.state.orbit.camera(aspect));
        let added = drawn.map_err(|error| error.to_string()).and_then(|()| {
            let rgba = self.picture.read().ok_or("the picture could not be read from the device")?;
            recording.recorder.add(rgba).map_err(|error| error.to_string())
        });
        recording.last = Some(snapshot);
        self.state.recorded = Some(recording.recorder.frames());
        if let Err(reason) = added {
            let now = ctx.input(|input| input.time);
            (self.recording, self.state.recorded) = (None, None);
            self.state.notify(format!("the recording ended: {reason}"), true, now);
            return;
        }
        self.engine.send(Command::Advance(self.state.scene.frame_duration()));
        ctx.request_repaint();
    }
}
