//! The window: shows the panels and executes their actions.

mod act;
#[cfg(not(target_arch = "wasm32"))]
mod desktop;
mod exporting;
mod files;
mod listen;
#[cfg(not(target_arch = "wasm32"))]
mod playing;
mod rate;
#[cfg(not(target_arch = "wasm32"))]
mod recording;

use std::sync::Arc;

use egui::{Context, TextureId, Ui};
use egui_wgpu::RenderState;
use glam::Vec3;
use splashdown::Checkpoint;
use splashdown::scene::Scene;
use splashdown_gpu::Gpu;

use crate::ViewerError;
use crate::camera::Orbit;
use crate::engine::{Command, Engine, Purpose, Simulate, Snapshot};
use crate::look::Look;
use crate::panels;
use crate::picture::Picture;
use crate::state::State;

/// Seconds between two backups.
const RESCUE_INTERVAL: f64 = 10.0;

/// The interactive program.
pub struct Viewer {
    gpu: Arc<Gpu>,
    engine: Engine,
    picture: Picture,
    texture: Option<TextureId>,
    state: State,
    requested: Requested,
    rate: rate::PictureRate,
    drawn: Option<PictureContent>,
    /// A recent checkpoint, in case the device is lost.
    rescue: Option<Box<Checkpoint>>,
    /// The picture's size in pixels at full resolution.
    size: [u32; 2],
    #[cfg(not(target_arch = "wasm32"))]
    recording: Option<recording::Recording>,
    #[cfg(not(target_arch = "wasm32"))]
    player: Option<playing::Player>,
    #[cfg(not(target_arch = "wasm32"))]
    desktop: desktop::Desktop,
}

/// All data that determine the picture.
struct PictureContent {
    snapshot: Arc<Snapshot>,
    size: [u32; 2],
    look: Look,
    camera: Orbit,
}

impl PictureContent {
    fn equals(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.snapshot, &other.snapshot)
            && (self.size, self.look, self.camera) == (other.size, other.look, other.camera)
    }
}

/// What was requested from the engine and from the window.
#[derive(Default)]
struct Requested {
    wants_surface: bool,
    wants_timing: bool,
    /// When the last picture was shown, in s of the window's clock.
    shown_at: f64,
    exporting: bool,
    /// When a backup was last requested, in s of the window's clock.
    rescue_requested: f64,
    /// The name of the scene in the title of the window.
    title: String,
    /// The caption whose characters were checked.
    caption: Option<String>,
}

impl Viewer {
    /// Opens a scene on the window's device.
    ///
    /// # Errors
    /// [`ViewerError`] if the device cannot draw.
    pub fn new(
        ctx: &Context,
        render_state: &RenderState,
        scene: Scene,
        simulate: Option<Simulate>,
    ) -> Result<Self, ViewerError> {
        let mut viewer = Self::idle(ctx, render_state, scene, simulate)?;
        viewer.restart();
        Ok(viewer)
    }

    /// As [`new`](Self::new), without a simulation.
    pub(crate) fn idle(
        ctx: &Context,
        render_state: &RenderState,
        scene: Scene,
        simulate: Option<Simulate>,
    ) -> Result<Self, ViewerError> {
        let gpu = Arc::new(Gpu::from_device(
            render_state.device.clone(),
            render_state.queue.clone(),
            render_state.adapter.get_info(),
        ));
        let picture = Picture::new(Arc::clone(&gpu))?;
        let repaint = ctx.clone();
        let simulate = simulate.unwrap_or(match gpu.is_software() && !cfg!(target_arch = "wasm32") {
            true => Simulate::OnCpu,
            false => Simulate::WhereDrawn,
        });
        let engine = Engine::start(Arc::clone(&gpu), simulate, move || repaint.request_repaint());
        Ok(Self {
            gpu,
            engine,
            picture,
            texture: None,
            state: State::new(scene),
            requested: Requested::default(),
            rate: rate::PictureRate::default(),
            drawn: None,
            rescue: None,
            size: [1, 1],
            #[cfg(not(target_arch = "wasm32"))]
            recording: None,
            #[cfg(not(target_arch = "wasm32"))]
            player: None,
            #[cfg(not(target_arch = "wasm32"))]
            desktop: desktop::Desktop::new(),
        })
    }

    /// Shows one frame of the window.
    pub fn show(&mut self, ui: &mut Ui, render_state: &RenderState) {
        let ctx = ui.ctx().clone();
        self.dropped_files(&ctx);
        self.listen(&ctx);
        #[cfg(not(target_arch = "wasm32"))]
        {
            self.update_desktop(&ctx);
            self.update_player(&ctx);
        }
        self.note_caption(&ctx);
        self.name_window(&ctx);
        let (viewport, actions) = panels::show(ui, &mut self.state, self.texture);
        for action in actions {
            self.act(action, &ctx);
        }
        if let Some(at) = viewport.touched {
            let size = glam::Vec2::new(viewport.rect.width(), viewport.rect.height());
            self.grab(self.state.orbit.ray(at, size));
        }
        self.request_displayed_data();
        self.request_rescue(&ctx);
        self.size = viewport.size;
        #[cfg(not(target_arch = "wasm32"))]
        self.record(&ctx);
        // A software driver draws at half resolution while the simulation runs.
        let plays = self.state.timeline.as_ref().map_or(self.state.playing, |timeline| timeline.playing);
        let coarse = self.gpu.is_software() && plays;
        let size = viewport.size.map(|side| if coarse { side.div_ceil(2) } else { side });
        self.draw(size, render_state, &ctx);
        self.engine.picture_drawn();
        #[cfg(target_arch = "wasm32")]
        crate::browser::set_figures(self.state.figures.to_json());
        self.requested.shown_at = ctx.input(|input| input.time);
        self.state.figures.frames_per_second = self.rate.count(self.requested.shown_at, plays);
        if self.state.playing {
            ctx.request_repaint();
        }
    }

    /// Shows the name of the scene in the title of the window, or of the page.
    fn name_window(&mut self, ctx: &Context) {
        if self.requested.title != self.state.scene.name {
            self.requested.title.clone_from(&self.state.scene.name);
            let title = title(&self.requested.title);
            #[cfg(target_arch = "wasm32")]
            {
                let _ = ctx;
                crate::browser::set_title(&title);
            }
            #[cfg(not(target_arch = "wasm32"))]
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title));
        }
    }

    /// Reports characters that the caption of the scene has and the font of pictures lacks, once per caption.
    fn note_caption(&mut self, ctx: &Context) {
        let caption = &self.state.scene.picture.caption;
        if self.requested.caption != *caption {
            self.requested.caption.clone_from(caption);
            if let Some(note) = splashdown_run::appearance::caption_problem(&self.state.scene) {
                self.state.notify(note, true, ctx.input(|input| input.time));
            }
        }
    }

    /// Requests a backup at regular intervals. A device may be lost by a driver update, when the machine sleeps, or when
    /// a browser needs the memory.
    fn request_rescue(&mut self, ctx: &Context) {
        let now = ctx.input(|input| input.time);
        if self.state.playing && now - self.requested.rescue_requested > RESCUE_INTERVAL {
            self.requested.rescue_requested = now;
            self.checkpoint(Purpose::Rescue, now);
        }
    }

    fn restart(&mut self) {
        self.leave_playback();
        self.engine.send(Command::Open(Box::new(self.state.scene.clone())));
        self.engine.send(Command::TimeScale(self.state.time_scale.into()));
        self.engine.send(Command::Play(self.state.playing));
    }

    fn open(&mut self, scene: Scene) {
        self.state.open(scene);
        self.engine.send(Command::MouseForce(None));
        self.restart();
    }

    /// Shows the simulation again instead of a run that was played, and ends the recording of what was shown.
    fn leave_playback(&mut self) {
        self.state.timeline = None;
        #[cfg(not(target_arch = "wasm32"))]
        {
            self.end_recording();
            self.player = None;
        }
    }

    /// What is drawn, and how: the frame of a run that is played, else the newest snapshot of the engine.
    fn shown(&self) -> Option<(Arc<Snapshot>, Look)> {
        #[cfg(not(target_arch = "wasm32"))]
        if let Some(player) = &self.player {
            return player.shown(self.state.look);
        }
        Some((self.engine.snapshot()?, self.state.look))
    }

    fn draw(&mut self, size: [u32; 2], render_state: &RenderState, ctx: &Context) {
        let Some((snapshot, look)) = self.shown() else { return };
        let mut camera = self.state.orbit;
        camera.target -= self.state.shaking.map_or(Vec3::ZERO, |shaking| shaking.offset);
        let content = PictureContent { snapshot: Arc::clone(&snapshot), size, look, camera };
        // An unchanged picture is not drawn again.
        if self.drawn.as_ref().is_some_and(|drawn| drawn.equals(&content)) {
            return;
        }
        let aspect = size[0] as f32 / size[1] as f32;
        let before = self.picture.view().cloned();
        let drawn = self.picture.draw(size, &snapshot, &look, camera.camera(aspect));
        if let Err(error) = drawn {
            let now = ctx.input(|input| input.time);
            self.state.notify(error.to_string(), true, now);
            return;
        }
        self.drawn = Some(content);
        let Some(view) = self.picture.view() else { return };
        if self.texture.is_some() && before.as_ref() == Some(view) {
            return;
        }
        let mut renderer = render_state.renderer.write();
        let (device, filter) = (&render_state.device, wgpu::FilterMode::Linear);
        match self.texture {
            Some(texture) => renderer.update_egui_texture_from_wgpu_texture(device, view, filter, texture),
            None => self.texture = Some(renderer.register_native_texture(device, view, filter)),
        }
    }
}

/// The title of a window that shows this scene.
pub(crate) fn title(scene: &str) -> String {
    format!("Splashdown - {scene}")
}

impl eframe::App for Viewer {
    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        if let Some(render_state) = frame.wgpu_render_state().cloned() {
            self.show(ui, &render_state);
        }
    }
}
