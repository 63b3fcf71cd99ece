//! The state of the window. It needs no device, so that panels can be tested without one.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{Quat, Vec2, Vec3};
use splashdown::scene::Scene;
use splashdown_gpu::Timings;

use crate::camera::Orbit;
use crate::engine::Grip;
use crate::items::{BodyBounds, Grab, History, Item};
use crate::look::Look;
use crate::timeline::Timeline;

/// The effect of dragging the mouse.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Orbits the camera.
    #[default]
    Orbit,
    /// Applies a force to the fluid or drags a body.
    Drag,
    /// Tilts the domain.
    Tilt,
    /// Shakes the domain.
    Shake,
    /// Selects, moves, rotates, resizes, adds and removes things of the scene at time 0.
    Edit,
}

impl Tool {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Orbit, Self::Drag, Self::Tilt, Self::Shake, Self::Edit];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Orbit => "Orbit",
            Self::Drag => "Drag",
            Self::Tilt => "Tilt",
            Self::Shake => "Shake",
            Self::Edit => "Edit",
        }
    }

    /// Its explanation.
    pub fn hint(self) -> &'static str {
        match self {
            Self::Orbit => "Drag to orbit the camera; right button to pan, wheel or pinch to zoom",
            Self::Drag => "Drag the fluid and dynamic bodies (also with Shift held)",
            Self::Tilt => "Drag to tilt the tank; double-click to set it upright",
            Self::Shake => "Drag to shake the tank",
            Self::Edit => {
                "Select, move, rotate, resize, add and remove blocks, bodies and emitters at time 0"
            }
        }
    }
}

/// What a file dialog asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// A scene or a checkpoint to open.
    Scene,
    /// The folder of a run to open.
    Run,
    /// The file into which the scene with its changes is written.
    SaveScene,
    /// A mesh that is added as a body.
    Body,
    /// A closed mesh that is filled with fluid at time 0.
    Fluid,
}

impl Ask {
    /// The title of the dialog.
    pub fn title(self) -> &'static str {
        match self {
            Self::Scene => "Open a scene",
            Self::Run => "Open the folder of a run",
            Self::SaveScene => "Save the scene as",
            Self::Body => "Add a mesh as a body",
            Self::Fluid => "Fill a closed mesh with fluid",
        }
    }
}

/// A scene or a run that was opened before.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecentFile {
    /// Its file or folder.
    pub path: PathBuf,
    /// The scene of a run that does not name it: a file or the name of a built-in scene.
    pub scene: Option<PathBuf>,
    /// Whether it still exists.
    pub exists: bool,
}

/// A request from a panel or the viewport.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Open a built-in scene.
    OpenPreset(&'static str),
    /// Start `State::scene` again at time 0.
    Restart,
    /// Continue with the changed `State::scene`.
    Change,
    /// Run or pause.
    Play(bool),
    /// Simulate one frame of the scene.
    Step,
    /// Start the scene again as its file defines it.
    DiscardChanges,
    /// `State::time_scale` has changed.
    TimeScale,
    /// Apply the mouse force.
    Drag {
        /// The ray from the eye through the mouse: a point in m and a unit vector.
        ray: (Vec3, Vec3),
        /// The velocity of the mouse in m/s.
        velocity: Vec3,
    },
    /// Remove the mouse force and release the held body.
    Release,
    /// Hold a body.
    Grip(Grip),
    /// Export the current picture.
    ExportPicture,
    /// Save the scene with its changes beside its file.
    SaveScene,
    /// Export the current surface.
    ExportSurface,
    /// Export a checkpoint.
    ExportCheckpoint,
    /// Open a file or the folder of a run.
    OpenFile {
        /// The file or the folder.
        path: PathBuf,
        /// The scene of a run that does not name it.
        scene: Option<PathBuf>,
    },
    /// Open a dialog of the desktop.
    Ask(Ask),
    /// List recent checkpoints in `State::files`, and recent scenes and runs in `State::recent`.
    ShowFiles,
    /// Clear the list of recent scenes and runs.
    ForgetRecent,
    /// Make a link that contains the scene with its changes.
    Share,
    /// Start or stop recording.
    Record,
    /// Switch between dark and light.
    SwapTheme,
    /// Continue the simulation of the run that is played from its newest checkpoint.
    Continue,
}

/// A tank that follows the mouse by a spring and returns when it is released.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shaking {
    /// Target displacement in m.
    pub target: Vec3,
    /// Displacement in m.
    pub offset: Vec3,
    /// Its velocity in m/s.
    pub velocity: Vec3,
    /// Gravity of the tank at rest, in m/s^2.
    pub gravity: Vec3,
}

/// A thing of the scene that is being changed by a handle.
#[derive(Clone, Debug)]
pub struct Moving {
    /// The thing.
    pub item: Item,
    /// The handle.
    pub grab: Grab,
    /// Its middle before, in m.
    pub middle: Vec3,
    /// Where the handle was grabbed: along its axis from the middle in m, or about it in radians.
    pub from: f32,
    /// The rotation since then.
    pub turned: Quat,
    /// The scene before.
    pub before: Scene,
}

/// A number of a thing that is being dragged or typed.
#[derive(Clone, Debug)]
pub struct Typing {
    /// The scene before.
    pub before: Scene,
    /// The point that rotations and scales leave in its place, in m.
    pub pivot: Vec3,
}

/// The numbers in the status line.
#[derive(Clone, Debug, Default)]
pub struct Figures {
    /// Pictures per second.
    pub frames_per_second: f32,
    /// Steps per second.
    pub steps_per_second: f64,
    /// Simulated seconds per second.
    pub speed: f64,
    /// Simulated time in s.
    pub time: f64,
    /// Time step in s.
    pub dt: f32,
    /// Whether the simulation runs.
    pub playing: bool,
    /// Particles.
    pub particles: u32,
    /// Mean height of the particles in m, updated twice per second; NaN while unknown.
    pub mean_height: f32,
    /// Triangles of the surface, if there is one.
    pub triangles: Option<u32>,
    /// The larger one of the relative excess and deficit of density.
    pub density_error: f32,
    /// Pressure iterations per step since the start; zero with an explicit pressure.
    pub iterations: f64,
    /// Mean relative excess of density, if the pressure is implicit.
    pub compression: f32,
    /// The largest mean residual of the density at which the iterations of a step stopped, if the pressure is implicit.
    pub residual: f32,
    /// Viscosity iterations per step since the start; zero with an explicit viscosity.
    pub viscous_iterations: f64,
    /// Bytes in the simulation's buffers.
    pub memory: u64,
    /// The simulating device.
    pub device: String,
    /// Time per pass.
    pub timings: Arc<Timings>,
    /// Number of steps in `timings`.
    pub timed_steps: u64,
    /// Whether the device was lost.
    pub lost: bool,
    /// Time per pass of drawing, in ms.
    pub drawing: Vec<(&'static str, f32)>,
}

impl Figures {
    /// The numbers that the tests of the web page read.
    pub fn to_json(&self) -> String {
        let mean_height =
            if self.mean_height.is_finite() { self.mean_height.to_string() } else { "null".into() };
        format!(
            "{{\"time\":{},\"playing\":{},\"particles\":{},\"mean_height\":{mean_height},\"triangles\":{},\"frames_per_second\":{},\
             \"steps_per_second\":{},\"lost\":{}}}",
            self.time,
            self.playing,
            self.particles,
            self.triangles.unwrap_or(0),
            self.frames_per_second,
            self.steps_per_second,
            self.lost
        )
    }
}

/// A notification.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// The text.
    pub text: String,
    /// Whether it reports an error.
    pub is_error: bool,
    /// When it disappears, in s of the window's clock; infinite for errors, which the user closes.
    pub until: f64,
}

/// Which windows are open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shown {
    /// The gallery of scenes.
    pub gallery: bool,
    /// The help on keys and mouse.
    pub help: bool,
    /// All numbers of the simulation.
    pub statistics: bool,
    /// The time per pass, as a part of the statistics.
    pub timings: bool,
    /// The settings.
    pub settings: bool,
}

/// The state of the window.
pub struct State {
    /// The scene with its changes.
    pub scene: Scene,
    /// How it is displayed.
    pub look: Look,
    /// The camera.
    pub orbit: Orbit,
    /// The mouse tool.
    pub tool: Tool,
    /// Whether the user has started the simulation and not paused it.
    pub playing: bool,
    /// Simulated seconds per second.
    pub time_scale: f32,
    /// Open windows.
    pub shown: Shown,
    /// Notifications.
    pub notes: Vec<Note>,
    /// The status line.
    pub figures: Figures,
    /// The body being prepared and the completed fraction, in [0, 1].
    pub preparing: Option<(String, f32)>,
    /// Gravity of the opened scene before changes, in m/s^2.
    pub upright: Vec3,
    /// The motion of the tank while it is shaken.
    pub shaking: Option<Shaking>,
    /// The last position of the mouse in points, while it drags.
    pub drag_point: Option<Vec2>,
    /// A held body and the distance of its anchor from the eye, in m.
    pub grip: Option<(Grip, f32)>,
    /// The value of the slider for the number of particles.
    pub particles_wanted: f32,
    /// Number of recorded pictures, while recording.
    pub recorded: Option<u32>,
    /// Initial number of particles of the scene with its changes.
    pub counted: u64,
    /// Checkpoints listed in the gallery.
    pub files: Vec<PathBuf>,
    /// Recent scenes and runs listed in the gallery, the newest first.
    pub recent: Vec<RecentFile>,
    /// The name of the file that is being read.
    pub reading: Option<String>,
    /// The position in the run that is played; `None` while a scene is simulated.
    pub timeline: Option<Timeline>,
    /// The selected thing of the scene.
    pub selected: Option<Item>,
    /// The thing that is being changed by a handle.
    pub moving: Option<Moving>,
    /// The number that is being dragged or typed.
    pub typing: Option<Typing>,
    /// Changes of things that can be undone.
    pub history: History,
    /// The bounding boxes of the bodies at time 0.
    pub body_bounds: BodyBounds,
}

impl State {
    /// The state of a scene that was just opened.
    pub fn new(scene: Scene) -> Self {
        let counted = splashdown::check::count(&scene);
        Self {
            look: Look { colour_by: scene.output.colour_by, ..Look::default() },
            orbit: Orbit::of_scene(&scene),
            tool: Tool::default(),
            playing: true,
            time_scale: 1.0,
            shown: Shown::default(),
            notes: Vec::new(),
            figures: Figures::default(),
            preparing: None,
            upright: scene.gravity,
            shaking: None,
            drag_point: None,
            grip: None,
            particles_wanted: counted as f32,
            counted,
            recorded: None,
            files: Vec::new(),
            recent: Vec::new(),
            reading: None,
            timeline: None,
            selected: None,
            moving: None,
            typing: None,
            history: History::default(),
            body_bounds: BodyBounds::new(),
            scene,
        }
    }

    /// Whether the scene is shown at time 0, where its things can be edited.
    pub fn is_at_start(&self) -> bool {
        !self.playing && self.figures.time == 0.0
    }

    /// Counts the initial particles of the scene after a change.
    pub fn count(&mut self) {
        self.counted = splashdown::check::count(&self.scene);
        self.particles_wanted = self.counted as f32;
    }

    /// Opens another scene and keeps the display settings.
    pub fn open(&mut self, scene: Scene) {
        let old = std::mem::replace(self, Self::new(scene));
        (self.look.mode, self.look.map) = (old.look.mode, old.look.map);
        // Editing belongs to time 0 of the scene that it began with.
        self.tool = if old.tool == Tool::Edit { Tool::Orbit } else { old.tool };
        (self.shown, self.notes) = (old.shown, old.notes);
        (self.files, self.recent) = (old.files, old.recent);
        self.time_scale = old.time_scale;
        self.figures = old.figures;
    }

    /// Shows a notification; `now` is the time of the window's clock in s.
    pub fn notify(&mut self, text: impl Into<String>, is_error: bool, now: f64) {
        let text = text.into();
        self.notes.retain(|note| note.text != text);
        self.notes.push(Note { text, is_error, until: if is_error { f64::INFINITY } else { now + 6.0 } });
        if self.notes.len() > 5 {
            self.notes.remove(0);
        }
    }
}
