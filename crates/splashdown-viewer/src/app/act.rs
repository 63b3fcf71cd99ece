//! Executing the actions of panels.

use egui::Context;
use splashdown::scene::{Scene, presets};

use super::Viewer;
use crate::engine::{Command, Purpose};
use crate::state::Action;
use crate::{mouse, problem};

impl Viewer {
    pub(super) fn act(&mut self, action: Action, ctx: &Context) {
        let now = ctx.input(|input| input.time);
        match action {
            Action::OpenPreset(name) => {
                let Some((name, text)) = presets().iter().find(|(preset, _)| *preset == name) else { return };
                match Scene::parse(text, name) {
                    Ok(scene) => {
                        self.open(scene);
                        #[cfg(target_arch = "wasm32")]
                        crate::browser::set_address(&format!("?scene={name}"));
                    }
                    Err(errors) => self.state.notify(problem::of_file(&errors), true, now),
                }
            }
            Action::Restart => self.restart(),
            Action::Change => self.change(),
            Action::Play(playing) => {
                self.state.playing = playing;
                self.engine.send(Command::Play(playing));
            }
            Action::Step => {
                self.state.playing = false;
                self.engine.send(Command::Advance(self.state.scene.frame_duration()));
            }
            Action::DiscardChanges => {
                let source = self.state.scene.source.clone();
                let name = source
                    .as_ref()
                    .map_or_else(|| self.state.scene.name.clone(), |path| path.display().to_string());
                match Scene::parse(&self.state.scene.text, &name) {
                    Ok(mut scene) => {
                        scene.source = source;
                        self.open(scene);
                    }
                    Err(errors) => self.state.notify(problem::of_file(&errors), true, now),
                }
            }
            Action::TimeScale => self.engine.send(Command::TimeScale(self.state.time_scale.into())),
            Action::Drag { ray, velocity } => {
                let force = mouse::force(&self.state.scene, ray, velocity);
                self.engine.send(Command::MouseForce(Some(force)));
            }
            Action::Release => {
                self.engine.send(Command::MouseForce(None));
                self.engine.send(Command::Grip(None));
            }
            Action::Grip(mut grip) => {
                let domain = &self.state.scene.domain;
                grip.target = grip.target.clamp(domain.min, domain.max);
                self.engine.send(Command::Grip(Some(grip)));
            }
            Action::ExportPicture => self.screenshot(now),
            Action::SaveScene => self.save_scene(now),
            Action::ExportSurface => {
                self.requested.exporting = true;
                self.engine.send(Command::Export);
            }
            Action::ExportCheckpoint => self.checkpoint(Purpose::Export, now),
            Action::Share => self.share(now),
            Action::Record => self.toggle_recording(now),
            #[cfg(not(target_arch = "wasm32"))]
            Action::OpenFile { path, scene } => self.want_recent(path, scene),
            #[cfg(not(target_arch = "wasm32"))]
            Action::Ask(ask) => self.ask(ask, ctx),
            #[cfg(not(target_arch = "wasm32"))]
            Action::ShowFiles => self.list_files(ctx),
            #[cfg(not(target_arch = "wasm32"))]
            Action::ForgetRecent => self.forget_recent(ctx),
            #[cfg(not(target_arch = "wasm32"))]
            Action::Continue => self.continue_run(),
            // A web page has no folders and no dialogs; files are dropped onto it.
            #[cfg(target_arch = "wasm32")]
            Action::OpenFile { .. }
            | Action::Ask(_)
            | Action::ShowFiles
            | Action::ForgetRecent
            | Action::Continue => {}
            Action::SwapTheme => {
                let theme = match ctx.theme() {
                    egui::Theme::Dark => egui::Theme::Light,
                    egui::Theme::Light => egui::Theme::Dark,
                };
                ctx.set_theme(theme);
            }
        }
    }

    pub(super) fn change(&mut self) {
        self.engine.send(Command::Change(Box::new(self.state.scene.clone())));
    }
}
