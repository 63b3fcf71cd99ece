//! What the window knows and shows; no device, so that panels are tested without one.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{Vec2, Vec3};
use splashdown::scene::Scene;
use splashdown_gpu::Timings;

use crate::camera::Orbit;
use crate::engine::Grip;
use crate::look::Look;

/// What the mouse does to the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Turns the camera.
    #[default]
    Orbit,
    /// Drags water and bodies.
    Hand,
    /// Tilts the box.
    Tilt,
    /// Shakes the box.
    Shake,
}

impl Tool {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Orbit, Self::Hand, Self::Tilt, Self::Shake];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Orbit => "Look",
            Self::Hand => "Hand",
            Self::Tilt => "Tilt",
            Self::Shake => "Shake",
        }
    }

    /// What it does.
    pub fn hint(self) -> &'static str {
        match self {
            Self::Orbit => "Drag to look round; right button to slide, wheel or pinch to come nearer",
            Self::Hand => "Drag water and floating bodies (also with Shift held)",
            Self::Tilt => "Drag to tilt the box; double click sets it upright again",
            Self::Shake => "Drag to shake the box",
        }
    }
}

/// What a panel or the picture wants done.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Open a scene that comes with the program.
    OpenPreset(&'static str),
    /// Start `State::scene` anew.
    Restart,
    /// Go on under `State::scene`.
    Change,
    /// Run, or stand still.
    Play(bool),
    /// Simulate one frame of the scene.
    Step,
    /// Back to the scene's file.
    Reset,
    /// `State::time_scale` has changed.
    TimeScale,
    /// The hand is here; it moves with this velocity.
    Stir {
        /// The eye's ray through the mouse: a point in m and a unit vector.
        ray: (Vec3, Vec3),
        /// In m/s.
        velocity: Vec3,
    },
    /// The hand is gone, and holds nothing.
    LetGo,
    /// A body is held.
    Grip(Grip),
    /// Drop a ball into the middle of the box.
    DropBall,
    /// Turn a tap over the box on or off.
    Pour,
    /// Write the picture as it is.
    Screenshot,
    /// Write the scene as it is now.
    SaveScene,
    /// Write the surface as it is.
    SaveMesh,
    /// Keep the fluid as it is, to go on with it later.
    SaveCheckpoint,
    /// Open a file.
    OpenFile(PathBuf),
    /// Look for checkpoints: `State::files` shall hold them.
    ShowFiles,
    /// Make a link that holds the scene as it is now.
    Share,
    /// Begin to record frame by frame, or end it.
    Record,
    /// Dark instead of light, or the other way round.
    SwapTheme,
}

/// A box that follows the mouse by a spring, and returns when it is let go.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shaking {
    /// Where the mouse wants the box, in m from its place.
    pub wanted: Vec3,
    /// Where it is, in m from its place.
    pub offset: Vec3,
    /// Its velocity in m/s.
    pub velocity: Vec3,
    /// Gravity of the box at rest, in m/s^2.
    pub gravity: Vec3,
}

/// What is shown at a glance.
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
    /// Whether the simulation's clock runs, as it says itself.
    pub playing: bool,
    /// Particles.
    pub particles: u32,
    /// Mean height of the particles in m, now and then; NaN while unknown.
    pub mean_height: f32,
    /// Triangles of the surface, if there is one.
    pub triangles: Option<u32>,
    /// Largest relative excess of density.
    pub density_error: f32,
    /// Bytes in the simulation's buffers.
    pub memory: u64,
    /// What simulates.
    pub device: String,
    /// Time per pass.
    pub timings: Arc<Timings>,
    /// Steps that `timings` are of.
    pub timed_steps: u64,
    /// Whether the device is gone.
    pub lost: bool,
    /// Time per pass of drawing, in ms.
    pub drawing: Vec<(&'static str, f32)>,
}

impl Figures {
    /// The numbers that tests of the page look at.
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

/// Something the user is told for a while.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// What.
    pub text: String,
    /// Whether it is bad news.
    pub is_error: bool,
    /// When it goes, in s of the window's clock; bad news stays until it is clicked away.
    pub until: f64,
}

/// Which windows are open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shown {
    /// The scene gallery.
    pub gallery: bool,
    /// What keys and mouse do.
    pub help: bool,
    /// Time per pass.
    pub timings: bool,
    /// The side panel is hidden.
    pub bare: bool,
    /// The window is too narrow for the side panel.
    pub narrow: bool,
}

/// What the window knows and shows.
pub struct State {
    /// The scene as it is edited.
    pub scene: Scene,
    /// How it is shown.
    pub look: Look,
    /// From where.
    pub orbit: Orbit,
    /// What the mouse does.
    pub tool: Tool,
    /// Whether the clock runs.
    pub playing: bool,
    /// Simulated seconds per second.
    pub time_scale: f32,
    /// Open windows.
    pub shown: Shown,
    /// Notes.
    pub notes: Vec<Note>,
    /// At a glance.
    pub figures: Figures,
    /// What is being prepared, and how far, in [0, 1].
    pub preparing: Option<(String, f32)>,
    /// Gravity of the scene as it was opened, in m/s^2.
    pub upright: Vec3,
    /// The motion of the box while it is shaken.
    pub shaking: Option<Shaking>,
    /// The last place of the hand, in points, if it is in the water.
    pub hand: Option<Vec2>,
    /// A held body and the distance of its anchor from the eye, in m.
    pub grip: Option<(Grip, f32)>,
    /// Particles the scene had when it was opened, for the slider of their number.
    pub particles_wanted: f32,
    /// Pictures recorded, while that goes on.
    pub recorded: Option<u32>,
    /// Particles that the scene starts with, as it is now.
    pub counted: u64,
    /// Whether the tap is on.
    pub pouring: bool,
    /// Checkpoints that the gallery offers.
    pub files: Vec<PathBuf>,
}

impl State {
    /// A scene as it was just opened.
    pub fn new(scene: Scene) -> Self {
        let counted = splashdown::sample::count(&scene);
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
            hand: None,
            grip: None,
            particles_wanted: counted as f32,
            counted,
            recorded: None,
            pouring: false,
            files: Vec::new(),
            scene,
        }
    }

    /// Another scene in the same window: the look stays.
    pub fn open(&mut self, scene: Scene) {
        let old = std::mem::replace(self, Self::new(scene));
        (self.look.way, self.look.map) = (old.look.way, old.look.map);
        (self.tool, self.shown, self.notes) = (old.tool, old.shown, old.notes);
        self.time_scale = old.time_scale;
        self.figures = old.figures;
    }

    /// Tells something at this time of the window's clock.
    pub fn tell(&mut self, text: impl Into<String>, is_error: bool, now: f64) {
        let text = text.into();
        self.notes.retain(|note| note.text != text);
        self.notes.push(Note { text, is_error, until: if is_error { f64::INFINITY } else { now + 6.0 } });
        if self.notes.len() > 5 {
            self.notes.remove(0);
        }
    }
}
