//! The window: asks the panels what is to be done and does it.

use std::sync::Arc;

use egui::{Context, TextureId, Ui};
use egui_wgpu::RenderState;
use glam::Vec3;
use splashdown::Hand;
use splashdown::scene::{Scene, presets};
use splashdown_gpu::Gpu;

use crate::ViewerError;
use crate::camera::Orbit;
use crate::edit;
use crate::engine::{Command, Engine, Message, Simulate, Snapshot};
use crate::keep;
use crate::look::Look;
use crate::panels;
use crate::pick;
use crate::picture::Picture;
#[cfg(target_arch = "wasm32")]
use crate::pixels;
use crate::save;
use crate::state::{Action, State};

/// How quickly water takes the hand's velocity, in 1/s.
const HAND_RATE: f32 = 14.0;
/// Radius of the hand over the smallest edge of the box.
const HAND_SIZE: f32 = 0.16;

/// The interactive program.
pub struct Viewer {
    gpu: Arc<Gpu>,
    engine: Engine,
    picture: Picture,
    texture: Option<TextureId>,
    state: State,
    /// What the scene file said, for saving.
    text: String,
    seen: Seen,
    drawn: Option<Drawn>,
    /// The picture's size in pixels at full resolution.
    size: [u32; 2],
}

/// What the picture shows.
struct Drawn {
    snapshot: Arc<Snapshot>,
    size: [u32; 2],
    look: Look,
    camera: Orbit,
}

impl Drawn {
    fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.snapshot, &other.snapshot)
            && (self.size, self.look, self.camera) == (other.size, other.look, other.camera)
    }
}

/// What has been sent to the engine, or come from it.
#[derive(Default)]
struct Seen {
    wants_surface: bool,
    wants_timing: bool,
    frames_per_second: f32,
    exporting: bool,
}

impl Viewer {
    /// Opens a scene on the window's device. `text` is the scene's file.
    ///
    /// # Errors
    /// [`ViewerError`] if the device cannot draw.
    pub fn new(
        ctx: &Context,
        render_state: &RenderState,
        scene: Scene,
        text: String,
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
        let mut viewer = Self {
            gpu,
            engine,
            picture,
            texture: None,
            state: State::new(scene),
            text,
            seen: Seen::default(),
            drawn: None,
            size: [1, 1],
        };
        viewer.restart();
        Ok(viewer)
    }

    /// One picture of the window.
    pub fn show(&mut self, ui: &mut Ui, render_state: &RenderState) {
        let ctx = ui.ctx().clone();
        self.dropped_files(&ctx);
        self.listen(&ctx);
        let (viewport, actions) = panels::show(ui, &mut self.state, self.texture);
        for action in actions {
            self.act(action, &ctx);
        }
        if let Some(at) = viewport.touched {
            let size = glam::Vec2::new(viewport.rect.width(), viewport.rect.height());
            self.take_hold(self.state.orbit.ray(at, size));
        }
        self.ask_for_what_is_shown();
        // A software driver draws as many pixels as it can while the water moves, and all of them when it stands still.
        self.size = viewport.size;
        let coarse = self.gpu.is_software() && self.state.playing;
        let size = viewport.size.map(|side| if coarse { side.div_ceil(2) } else { side });
        self.draw(size, render_state, &ctx);
        self.engine.picture_drawn();
        #[cfg(target_arch = "wasm32")]
        crate::page::set_figures(self.state.figures.to_json());
        let passed = ctx.input(|input| input.stable_dt).max(1e-4);
        self.seen.frames_per_second += 0.1 * (1.0 / passed - self.seen.frames_per_second);
        if self.state.playing {
            ctx.request_repaint();
        }
    }

    /// What the window knows and shows.
    pub fn state(&mut self) -> &mut State {
        &mut self.state
    }

    /// The newest state of the fluid.
    pub fn snapshot(&self) -> Option<Arc<Snapshot>> {
        self.engine.snapshot()
    }

    fn restart(&mut self) {
        self.engine.send(Command::Open(Box::new(self.state.scene.clone())));
        self.engine.send(Command::TimeScale(self.state.time_scale.into()));
        self.engine.send(Command::Play(self.state.playing));
    }

    fn open(&mut self, scene: Scene, text: String) {
        self.state.open(scene);
        self.text = text;
        self.engine.send(Command::Hand(None));
        self.restart();
    }

    fn act(&mut self, action: Action, ctx: &Context) {
        let now = ctx.input(|input| input.time);
        match action {
            Action::OpenPreset(name) => {
                let Some((name, text)) = presets().iter().find(|(preset, _)| *preset == name) else { return };
                match Scene::parse(text, name) {
                    Ok(scene) => self.open(scene, (*text).to_owned()),
                    Err(error) => self.state.tell(error.to_string(), true, now),
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
            Action::Reset => {
                let source = self.state.scene.source.clone();
                let name = source
                    .as_ref()
                    .map_or_else(|| self.state.scene.name.clone(), |path| path.display().to_string());
                let text = self.text.clone();
                match Scene::parse(&text, &name) {
                    Ok(scene) => self.open(Scene { source, ..scene }, text),
                    Err(error) => self.state.tell(error.to_string(), true, now),
                }
            }
            Action::TimeScale => self.engine.send(Command::TimeScale(self.state.time_scale.into())),
            Action::Stir { ray, velocity } => {
                let scene = &self.state.scene;
                let radius =
                    (HAND_SIZE * scene.domain.size().min_element()).max(3.0 * scene.fluid.particle_spacing);
                // Half the speed of sound would tear the water.
                let velocity = velocity.clamp_length_max(3.0 * scene.domain.size().max_element());
                let hand = Hand::new(ray.0, ray.1, velocity, radius, HAND_RATE);
                self.engine.send(Command::Hand(Some(hand)));
            }
            Action::LetGo => {
                self.engine.send(Command::Hand(None));
                self.engine.send(Command::Grip(None));
            }
            Action::Grip(mut grip) => {
                let domain = &self.state.scene.domain;
                grip.target = grip.target.clamp(domain.min, domain.max);
                self.engine.send(Command::Grip(Some(grip)));
            }
            Action::DropBall => {
                edit::add_ball(&mut self.state.scene);
                self.change();
            }
            Action::Pour => {
                self.state.pouring = edit::turn_tap(&mut self.state.scene);
                self.change();
            }
            Action::Screenshot => self.screenshot(now),
            Action::SaveScene => self.save_scene(now),
            Action::SaveMesh => {
                self.seen.exporting = true;
                self.engine.send(Command::Export);
            }
            Action::SwapTheme => {
                let theme = match ctx.theme() {
                    egui::Theme::Dark => egui::Theme::Light,
                    egui::Theme::Light => egui::Theme::Dark,
                };
                ctx.set_theme(theme);
            }
        }
    }

    fn change(&mut self) {
        self.engine.send(Command::Change(Box::new(self.state.scene.clone())));
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn screenshot(&mut self, now: f64) {
        let name = format!("{}.png", self.state.scene.name);
        self.draw_in_full();
        let size = self.picture.texture_drawn().map_or([0, 0], |(_, size)| size);
        let picture = self.picture.read().ok_or_else(|| "the device did not hand it out".to_owned());
        let kept = picture.and_then(|rgba| keep::png(&name, size, rgba));
        self.tell_kept("the picture", kept, now);
    }

    /// The page gets the picture when the browser has it.
    #[cfg(target_arch = "wasm32")]
    fn screenshot(&mut self, now: f64) {
        self.draw_in_full();
        let Some((texture, size)) = self.picture.texture_drawn() else { return };
        let (gpu, name) = (Arc::clone(&self.gpu), format!("{}.png", self.state.scene.name));
        self.state.tell(format!("the picture is in your downloads, as {name}"), false, now);
        wasm_bindgen_futures::spawn_local(async move {
            if let Some(rgba) = pixels::read(gpu, texture, size).await {
                // It has been told already where it is; without it the browser says why.
                let _ = keep::png(&name, size, rgba);
            }
        });
    }

    /// Draws with all pixels what is shown with fewer while the water moves. The next picture of the window is drawn anew.
    fn draw_in_full(&mut self) {
        let Some(drawn) = self.drawn.take() else { return };
        let aspect = self.size[0] as f32 / self.size[1] as f32;
        // An error of this picture was told when it was drawn for the window.
        let _ = self.picture.draw(self.size, &drawn.snapshot, &drawn.look, drawn.camera.camera(aspect));
    }

    fn save_scene(&mut self, now: f64) {
        // Beside the file that it came from: its meshes are named from there.
        let folder = self.state.scene.source.as_deref().and_then(std::path::Path::parent);
        let name = folder.unwrap_or(std::path::Path::new("")).join(format!("{}.toml", self.state.scene.name));
        let name = name.to_string_lossy().into_owned();
        let kept = save::scene(&self.text, &self.state.scene, &self.state.orbit)
            .and_then(|text| keep::text(&name, &text));
        self.tell_kept("the scene", kept, now);
    }

    fn tell_kept(&mut self, what: &str, kept: Result<String, String>, now: f64) {
        match kept {
            Ok(place) => self.state.tell(format!("{what} is in {place}"), false, now),
            Err(reason) => self.state.tell(format!("{what} was not written: {reason}"), true, now),
        }
    }

    /// Asks for what this way of seeing needs.
    fn ask_for_what_is_shown(&mut self) {
        let surface = self.state.look.way.needs_surface();
        if std::mem::replace(&mut self.seen.wants_surface, surface) != surface {
            self.engine.send(Command::Surface(surface));
        }
        let timing = self.state.shown.timings;
        if std::mem::replace(&mut self.seen.wants_timing, timing) != timing {
            self.engine.send(Command::Timing(timing));
        }
        let times = self.picture.time_passes(timing);
        self.state.figures.drawing = times.iter().map(|pass| (pass.label, pass.milliseconds)).collect();
    }

    /// Takes in what the engine tells.
    fn listen(&mut self, ctx: &Context) {
        let now = ctx.input(|input| input.time);
        for message in self.engine.take_messages() {
            match message {
                Message::Note(text) => self.state.tell(text, false, now),
                Message::Failed(text) => {
                    self.state.playing = false;
                    self.state.preparing = None;
                    self.back_to_what_runs();
                    self.state.tell(text, true, now);
                }
                Message::Refused(text) => {
                    self.back_to_what_runs();
                    self.state.tell(text, true, now);
                }
                Message::Stopped => {
                    self.state.playing = false;
                    let text = "the simulation has ended by a fault of this program; open the window again";
                    self.state.tell(text, true, now);
                }
                Message::Preparing(body, part) => self.state.preparing = (part < 1.0).then_some((body, part)),
                Message::Exported { mesh, .. } => {
                    if std::mem::take(&mut self.seen.exporting) {
                        let name = format!("{}.ply", self.state.scene.name);
                        let kept = keep::mesh(&name, &mesh);
                        self.tell_kept("the mesh", kept, now);
                    }
                }
            }
        }
        if let Err(error) = self.gpu.health("the window") {
            self.state.tell(error.to_string(), true, now);
        }
        let Some(snapshot) = self.engine.snapshot() else { return };
        let figures = &mut self.state.figures;
        figures.frames_per_second = self.seen.frames_per_second;
        figures.steps_per_second = snapshot.steps_per_second;
        figures.speed = snapshot.speed;
        figures.time = snapshot.stats.time;
        figures.playing = snapshot.playing;
        figures.dt = snapshot.stats.dt;
        figures.particles = snapshot.stats.particles;
        figures.density_error = snapshot.stats.density_error;
        figures.triangles = snapshot.drawn.mesh().map(|mesh| mesh.stats.triangles);
        figures.timings = Arc::clone(&snapshot.timings);
        figures.timed_steps = snapshot.timed_steps;
        figures.mean_height = snapshot.mean_height;
        figures.memory = snapshot.opened.memory;
        figures.device.clone_from(&snapshot.opened.device);
    }

    /// Forgets changes that were not accepted.
    fn back_to_what_runs(&mut self) {
        if let Some(snapshot) = self.engine.snapshot() {
            self.state.scene = snapshot.opened.scene.clone();
            self.state.pouring = edit::has_tap(&self.state.scene);
        }
    }

    /// The hand takes what the ray meets first: a free body by the point, else the water.
    fn take_hold(&mut self, ray: (Vec3, Vec3)) {
        let Some(snapshot) = self.engine.snapshot() else { return };
        if let Some((grip, distance)) = pick::body(&snapshot.opened, &snapshot.bodies, ray) {
            self.state.grip = Some((grip, distance));
            self.engine.send(Command::Grip(Some(grip)));
        }
    }

    #[cfg(target_arch = "wasm32")]
    fn dropped_files(&mut self, ctx: &Context) {
        if ctx.input(|input| !input.raw.dropped_files.is_empty()) {
            let now = ctx.input(|input| input.time);
            self.state.tell("a page takes no files yet; the desktop's `splashdown view` does", true, now);
        }
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn dropped_files(&mut self, ctx: &Context) {
        let now = ctx.input(|input| input.time);
        let files = ctx.input(|input| input.raw.dropped_files.clone());
        for file in files {
            let path = file.path().to_path_buf();
            let is_scene = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
            if is_scene {
                let opened = Scene::load(&path).map_err(|error| error.to_string());
                let text = std::fs::read_to_string(&path).map_err(|error| error.to_string());
                match opened.and_then(|scene| Ok((scene, text?))) {
                    Ok((scene, text)) => self.open(scene, text),
                    Err(error) => self.state.tell(error, true, now),
                }
                continue;
            }
            match splashdown_io::read_mesh(&path) {
                Ok(mesh) => {
                    let corners = mesh.vertices.iter().map(|&v| Vec3::from(v));
                    let low = corners.clone().fold(Vec3::INFINITY, Vec3::min);
                    let high = corners.fold(Vec3::NEG_INFINITY, Vec3::max);
                    edit::add_mesh(&mut self.state.scene, path, low, high);
                    self.change();
                }
                Err(error) => self.state.tell(error.to_string(), true, now),
            }
        }
    }

    fn draw(&mut self, size: [u32; 2], render_state: &RenderState, ctx: &Context) {
        let Some(snapshot) = self.engine.snapshot() else { return };
        let mut camera = self.state.orbit;
        camera.target -= self.state.shaking.map_or(Vec3::ZERO, |shaking| shaking.offset);
        // A picture of what was drawn last is there already.
        let shown = Drawn { snapshot: Arc::clone(&snapshot), size, look: self.state.look, camera };
        if self.drawn.as_ref().is_some_and(|drawn| drawn.is(&shown)) {
            return;
        }
        let aspect = size[0] as f32 / size[1] as f32;
        let before = self.picture.view().cloned();
        let drawn = self.picture.draw(size, &snapshot, &self.state.look, camera.camera(aspect));
        if let Err(error) = drawn {
            let now = ctx.input(|input| input.time);
            self.state.tell(error.to_string(), true, now);
            return;
        }
        self.drawn = Some(shown);
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

impl eframe::App for Viewer {
    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        if let Some(render_state) = frame.wgpu_render_state().cloned() {
            self.show(ui, &render_state);
        }
    }
}
