//! The checked values of a scene file, in SI units with y up.
//!
//! The values of a [`Scene`] from [`Scene::load`] or [`Scene::parse`] lie inside the ranges of the table of
//! keys (`keys/`). The fields are public, so code and tests can change them.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{Quat, Vec3};

use super::camera_path::CameraPath;
use super::choice::{Choice, choices};
use super::errors::SceneWarning;
use super::picture::PictureSettings;
use super::slot::BuiltSlot;
use super::solver::Solver;
use super::things::{Body, Emitter, MeshSource, Probe, Sink};

/// A scene: what is simulated, how it is computed, and what is written.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Scene {
    /// Short name; names the output folder. Letters, digits, `-` and `_`.
    pub name: String,
    /// Simulated time in s.
    pub duration: f32,
    /// Frames per simulated second, in 1/s.
    pub frame_rate: f32,
    /// Gravity in m/s^2; (0, -9.81, 0) by default.
    pub gravity: Vec3,
    /// The box that contains the fluid.
    pub domain: Domain,
    /// The fluid and its initial shape.
    pub fluid: Fluid,
    /// Solid bodies.
    pub bodies: Vec<Body>,
    /// Sources of fluid.
    pub emitters: Vec<Emitter>,
    /// Regions that remove fluid.
    pub sinks: Vec<Sink>,
    /// Measurements during the run.
    pub probes: Vec<Probe>,
    /// The solver and its parameters.
    pub solver: Solver,
    /// Parameters of surface reconstruction.
    pub surface: SurfaceSettings,
    /// Parameters of foam, spray and bubbles.
    pub foam: FoamSettings,
    /// The view of the pictures.
    pub camera: Camera,
    /// The motion of the camera during the run; see [`Scene::camera_at`].
    pub camera_path: CameraPath,
    /// The appearance of the pictures.
    pub picture: PictureSettings,
    /// The output files.
    pub output: Output,
    /// Values that were corrected or are probably unintended.
    pub warnings: Vec<SceneWarning>,
    /// The scene file, if any.
    pub source: Option<PathBuf>,
    /// The text that the scene was read from.
    pub text: Arc<str>,
    /// The data that other modules have built from the scene.
    pub(crate) built: BuiltSlot,
}

impl Scene {
    /// Number of frames: `duration * frame_rate`, rounded up, at least 1 (the state at t = 0 is not counted).
    pub fn frame_count(&self) -> u32 {
        // 0.1 s is rounded in f32, which gives 3.00000004 frames at 30/s. The factor prevents an extra frame.
        let frames = f64::from(self.duration) * f64::from(self.frame_rate) * (1.0 - 1e-6);
        (frames.ceil() as u32).max(1)
    }

    /// Simulated time between two frames, in s.
    pub fn frame_duration(&self) -> f32 {
        1.0 / self.frame_rate
    }
}

/// An axis-aligned box with closed or open sides.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Domain {
    /// Lower corner in m.
    pub min: Vec3,
    /// Upper corner in m.
    pub max: Vec3,
    /// `closed[axis][side]`: whether there is a wall. The axis is x, y, z; the side is 0 for min and 1 for
    /// max.
    pub closed: [[bool; 2]; 3],
    /// The motion of the domain, if it moves.
    pub oscillation: Option<Oscillation>,
}

impl Domain {
    /// Edge lengths in m.
    pub fn size(&self) -> Vec3 {
        self.max - self.min
    }

    /// The centre of the box in m.
    pub fn center(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }
}

/// A harmonic motion of the domain: its displacement is `amplitude * sin(2 pi t / period)`. The simulation
/// uses the domain's frame of reference, in which [`Oscillation::acceleration`] acts on the fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Oscillation {
    /// Amplitude in m, per axis.
    pub amplitude: Vec3,
    /// Period in s.
    pub period: f32,
}

impl Oscillation {
    /// Inertial acceleration in the domain's frame at time `t` (s), in m/s^2: the negative acceleration of
    /// the domain.
    pub fn acceleration(&self, t: f64) -> Vec3 {
        let omega = std::f64::consts::TAU / f64::from(self.period);
        self.amplitude * (omega * omega * (omega * t).sin()) as f32
    }

    /// The largest speed of the domain in m/s.
    pub fn max_speed(&self) -> f32 {
        self.amplitude.length() * std::f32::consts::TAU / self.period
    }

    /// The largest acceleration of the domain in m/s^2.
    pub fn max_acceleration(&self) -> f32 {
        self.max_speed() * std::f32::consts::TAU / self.period
    }
}

/// The fluid: resolution, material and initial shape.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Fluid {
    /// Distance between neighbouring particles on the initial lattice in m, which is the resolution.
    pub particle_spacing: f32,
    /// The properties of the liquid.
    pub material: Material,
    /// Blocks of fluid at the start; may be empty if meshes, files or emitters provide fluid.
    pub blocks: Vec<Block>,
    /// Closed meshes that are filled with fluid at the start.
    pub meshes: Vec<FluidMesh>,
    /// Particle files that provide fluid at the start.
    pub files: Vec<FluidFile>,
    /// The pressure of the blocks at the start.
    pub initial_pressure: InitialPressure,
}

impl Fluid {
    /// Half the spacing, in m.
    pub fn particle_radius(&self) -> f32 {
        self.particle_spacing * 0.5
    }

    /// The mass of a particle in kg: that of the fluid at rest in a cube with edges of one spacing.
    pub fn particle_mass(&self) -> f64 {
        f64::from(self.material.rest_density) * f64::from(self.particle_spacing).powi(3)
    }
}

/// Properties of a liquid; see [`crate::scene::MATERIALS`] for the known liquids and their sources.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// The name in the scene file, for example `water`.
    pub name: String,
    /// Density at rest in kg/m^3.
    pub rest_density: f32,
    /// Kinematic viscosity in m^2/s.
    pub viscosity: f32,
    /// Surface tension against air in N/m.
    pub surface_tension: f32,
}

/// A block of fluid at t = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Its shape.
    pub shape: Shape,
    /// Initial velocity of all its particles, in m/s.
    pub velocity: Vec3,
}

/// A closed mesh filled with fluid at t = 0.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FluidMesh {
    /// The mesh and its pose.
    pub mesh: MeshSource,
    /// Initial velocity in m/s.
    pub velocity: Vec3,
    /// `Some(false)`: the mesh is filled although it has large holes.
    pub shell: Option<bool>,
}

impl FluidMesh {
    /// Fluid at rest in a mesh.
    pub fn new(mesh: MeshSource) -> Self {
        Self { mesh, velocity: Vec3::ZERO, shell: None }
    }
}

/// A file of particles at t = 0.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FluidFile {
    /// Path of the file.
    pub path: PathBuf,
    /// Metres per unit of the file; positions and velocities are multiplied by it.
    pub scale: f32,
    /// Rotation of positions and velocities about the file's origin.
    pub rotation: Quat,
    /// Position of the file's origin in m.
    pub position: Vec3,
    /// Added to the velocities of the file, in m/s. A file without velocities has zero velocities.
    pub velocity: Vec3,
}

impl FluidFile {
    /// Transforms a point of the file to the scene, in m.
    pub fn place(&self, x: Vec3) -> Vec3 {
        self.position + self.rotation * (self.scale * x)
    }
}

/// The shape of a [`Block`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// An axis-aligned box.
    Box {
        /// Lower corner in m.
        min: Vec3,
        /// Edge lengths in m.
        size: Vec3,
    },
    /// A ball.
    Sphere {
        /// Its centre in m.
        center: Vec3,
        /// Its radius in m.
        radius: f32,
    },
}

impl Shape {
    /// Lower and upper corners of the bounding box, in m.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        match *self {
            Self::Box { min, size } => (min, min + size),
            Self::Sphere { center, radius } => (center - radius, center + radius),
        }
    }
}

choices! {
    /// The pressure at the start.
    InitialPressure {
        /// rho g depth.
        Hydrostatic = "hydrostatic",
        /// None: water in a tank at rest then oscillates for seconds.
        Zero = "zero",
    }
    /// A kind of output file.
    Format {
        /// Binary PLY: particles and the surface.
        Ply = "ply",
        /// VTK's XML format for ParaView, as a grid: particles.
        Vtu = "vtu",
        /// VTK's XML format for ParaView, as poly data: particles and the surface.
        Vtp = "vtp",
        /// Wavefront OBJ: the surface.
        Obj = "obj",
        /// Legacy VTK: particles and the surface.
        Vtk = "vtk",
        /// Houdini's geometry format up to version 11: particles.
        Bgeo = "bgeo",
        /// Archive of arrays for numpy: particles.
        Npz = "npz",
        /// Binary STL for 3-D printers: the surface.
        Stl = "stl",
        /// Binary glTF for the web and game engines: the surface, and the whole scene with all frames in one file.
        Glb = "glb",
        /// Binary USD: the surface and the rest of the scene with all frames in one file, and the particles in another.
        Usd = "usd",
    }
    /// What a run does when the fluid bursts: when the monitor finds values that are meaningless.
    OnBurst {
        /// The run stops with an error. Complete frames and a checkpoint of the last sound frame are kept.
        Stop = "stop",
        /// It warns and continues.
        Warn = "warn",
        /// It records the finding as a note and continues.
        Ignore = "ignore",
    }
    /// The subject of a picture.
    PictureKind {
        /// The particles as shaded spheres with a colour bar.
        Particles = "particles",
        /// The reconstructed surface as a liquid.
        Surface = "surface",
    }
    /// How carefully pictures of the surface are drawn.
    PictureQuality {
        /// Approximations as in the window: quickest.
        Interactive = "interactive",
        /// Traced rays, four samples per pixel.
        Standard = "standard",
        /// Traced rays, 64 samples per pixel, with depth of field and motion blur.
        Final = "final",
    }
    /// The kernels of the surface's field.
    SurfaceKernels {
        /// Balls: the same kernel at every particle.
        Isotropic = "isotropic",
        /// Ellipsoids that follow the arrangement of the neighbours, at smoothed positions.
        Anisotropic = "anisotropic",
    }
    /// The quantity that colours the particles.
    ColourBy {
        /// Speed in m/s.
        Speed = "speed",
        /// Density in kg/m^3.
        Density = "density",
        /// Pressure in Pa.
        Pressure = "pressure",
    }
}

impl Format {
    /// File name extension without the dot.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Usd => "usdc",
            other => other.name(),
        }
    }

    /// Whether files of this format can contain particles.
    pub fn has_particles(self) -> bool {
        self.has(splashdown_io::Format::writes_particles)
    }

    /// Whether files of this format can contain points: particles, or droplets and foam beside meshes.
    pub fn has_points(self) -> bool {
        self.has_particles() || self == Self::Glb
    }

    /// Whether files of this format can contain the surface.
    pub fn has_surface(self) -> bool {
        self.has(splashdown_io::Format::writes_meshes)
    }

    /// Whether a file of this format can contain the whole scene with all frames.
    pub fn has_scene(self) -> bool {
        matches!(self, Self::Usd | Self::Glb)
    }

    /// Whether ParaView's index of a series, with the times of the frames, can list files of this format.
    pub fn has_index(self) -> bool {
        self.has(splashdown_io::Format::has_index)
    }

    /// Whether there is one file per frame. Otherwise one file contains all frames.
    pub fn is_numbered(self) -> bool {
        !self.has(splashdown_io::Format::is_series)
    }

    /// Whether surfaces in this format can have velocities.
    pub fn has_vertex_velocities(self) -> bool {
        self.has(|format| format.writes_meshes() && format.has_velocities())
    }

    /// Whether the entry in the table of file formats meets a condition.
    fn has(self, condition: fn(&splashdown_io::Format) -> bool) -> bool {
        splashdown_io::Format::with_ending(self.ending()).is_some_and(condition)
    }
}

/// Parameters of surface reconstruction.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SurfaceSettings {
    /// Whether the surface is reconstructed.
    pub enabled: bool,
    /// The kernels of the field.
    pub kernels: SurfaceKernels,
    /// Edge of a marching-cubes cell in m.
    pub cell_size: f32,
    /// Value of the field at the surface; the field is about 1 inside the fluid.
    pub iso_level: f32,
    /// Iterations of weighted smoothing of the mesh.
    pub smoothing_iterations: u32,
    /// Particles in blobs of fewer than this many leave the surface and become droplets.
    pub min_blob: u32,
    /// Particles with fewer neighbours than this leave the surface and become droplets.
    pub min_neighbours: u32,
    /// Support radius of the field divided by the particle spacing.
    pub support_ratio: f32,
    /// Whether meshes that are written contain the triangles that lie in the walls.
    pub caps: bool,
}

impl SurfaceSettings {
    /// Whether the surface is reconstructed and isolated particles leave it.
    pub fn separates(&self) -> bool {
        self.enabled && (self.min_blob > 1 || self.min_neighbours > 0)
    }

    /// The scene file's defaults at this particle spacing (m).
    pub fn for_spacing(particle_spacing: f32) -> Self {
        Self {
            enabled: true,
            kernels: SurfaceKernels::Isotropic,
            cell_size: particle_spacing * 0.5,
            iso_level: 0.6,
            smoothing_iterations: 5,
            min_blob: 9,
            min_neighbours: 3,
            support_ratio: 2.0,
            caps: true,
        }
    }
}

/// Parameters of foam, spray and bubbles (Ihmsen et al. 2012).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FoamSettings {
    /// Whether diffuse particles are created.
    pub enabled: bool,
    /// Diffuse particles per second and fluid particle at full trapped-air potential, in 1/s.
    pub trapped_air: f32,
    /// Diffuse particles per second and fluid particle at full wave-crest potential, in 1/s.
    pub wave_crest: f32,
    /// Relative speed of colliding fluid, divided by the reference speed, at which the trapped-air potential
    /// is 0 and 1.
    pub trapped_air_limits: [f32; 2],
    /// Curvature at which the wave-crest potential is 0 and 1.
    pub wave_crest_limits: [f32; 2],
    /// Speed of the fluid, divided by the reference speed, below which no diffuse particles and above which
    /// all are created.
    pub speed_limits: [f32; 2],
    /// Minimum and maximum lifetime of foam in s.
    pub lifetime: [f32; 2],
    /// Buoyancy of bubbles as a multiple of gravity.
    pub buoyancy: f32,
    /// Rate at which bubbles adopt the fluid's velocity, in 1/s.
    pub drag: f32,
    /// Maximum number of diffuse particles; `None`: four per fluid particle, at most four million.
    pub max_particles: Option<u32>,
}

impl Default for FoamSettings {
    fn default() -> Self {
        Self {
            enabled: false,
            trapped_air: 200.0,
            wave_crest: 1000.0,
            trapped_air_limits: [0.07, 0.25],
            wave_crest_limits: [0.1, 0.5],
            speed_limits: [0.2, 0.7],
            lifetime: [2.0, 5.0],
            buoyancy: 2.0,
            drag: 80.0,
            max_particles: None,
        }
    }
}

/// A camera that looks at `target` and can orbit it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Camera {
    /// The point at the centre of the picture, in m.
    pub target: Vec3,
    /// Distance of the eye from the target, in m.
    pub distance: f32,
    /// Angle about the y axis in degrees: 0 looks from +z (x to the right), 90 from +x.
    pub azimuth: f32,
    /// Angle above the horizon in degrees.
    pub elevation: f32,
    /// Vertical angle of view in degrees.
    pub field_of_view: f32,
    /// Rate of change of the azimuth, in degrees per simulated second.
    pub orbit_speed: f32,
}

/// The output files.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Output {
    /// File formats of the frames.
    pub formats: Vec<Format>,
    /// Pictures drawn of each frame.
    pub pictures: Vec<PictureKind>,
    /// Width and height of a picture in pixels: at most [`MAX_SIDE`](Self::MAX_SIDE) each, and
    /// [`MAX_PIXELS`](Self::MAX_PIXELS) in all.
    pub picture_size: [u32; 2],
    /// How carefully pictures of the surface are drawn.
    pub quality: PictureQuality,
    /// The quantity that colours the particles.
    pub colour_by: ColourBy,
    /// Whether a film is made of the pictures.
    pub film: bool,
    /// Values at the ends of the colour bar; `None`: derived from the scene.
    pub colour_range: Option<[f32; 2]>,
}

impl Output {
    /// Largest side of a picture in pixels.
    pub const MAX_SIDE: u32 = 32_768;
    /// Largest number of pixels of a picture, which then takes 1 GiB of memory.
    pub const MAX_PIXELS: u64 = 1 << 28;
    /// Largest side of the pictures of a film in pixels.
    pub const MAX_FILM_SIDE: u32 = 8192;

    /// Whether a picture of this size, in pixels, can be drawn.
    pub fn can_have_size([width, height]: [u32; 2]) -> bool {
        [width, height].iter().all(|side| (16..=Self::MAX_SIDE).contains(side))
            && u64::from(width) * u64::from(height) <= Self::MAX_PIXELS
    }
}

impl Default for Output {
    fn default() -> Self {
        Self {
            formats: vec![Format::Ply],
            pictures: vec![PictureKind::Particles, PictureKind::Surface],
            picture_size: [1280, 720],
            quality: PictureQuality::Interactive,
            colour_by: ColourBy::Speed,
            film: true,
            colour_range: None,
        }
    }
}
