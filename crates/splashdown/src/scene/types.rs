//! The checked values of a scene file, in SI units with y up.
//!
//! The values of a [`Scene`] from [`Scene::load`] or [`Scene::parse`] lie inside the ranges of the table of
//! keys (`keys/`). The fields are public, so code and tests can change them.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{Quat, Vec3};

use super::choice::{Choice, choices};
use super::errors::SceneWarning;
use super::slot::BuiltSlot;
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
    /// The solver of the fluid's equations.
    Method {
        /// Forces of Mueller, Charypar and Gross 2003, the method of the thesis of Figueroa 2012: fast, and more
        /// compressible.
        Mueller2003 = "mueller2003",
        /// Weakly compressible SPH with Tait's equation of state.
        Wcsph = "wcsph",
    }
    /// The smoothing kernel of `wcsph` (`mueller2003` brings its own three).
    KernelKind {
        /// Wendland's C2 function, without pairing instability.
        WendlandC2 = "wendland_c2",
        /// The cubic spline of Monaghan and Lattanzio.
        CubicSpline = "cubic_spline",
    }
    /// The purpose that determines the defaults of the other keys of the solver.
    Accuracy {
        /// Fast: fronts, water heights and draughts are right, pressures are noisy.
        Standard = "standard",
        /// For pressures, forces and waves: density = "continuity" and support_ratio = 3.
        Engineering = "engineering",
    }
    /// The computation of the density.
    DensityMode {
        /// Sum over the neighbours in every step: robust.
        Summation = "summation",
        /// Continuity equation with diffusion (delta-SPH), corrected gradients and particle shifting: smooth pressure, and
        /// waves of the right period and height.
        Continuity = "continuity",
    }
    /// The treatment of negative pressures.
    NegativePressure {
        /// They are set to zero: no clumping at the surface.
        Clamp = "clamp",
        /// They are kept: needed to compare pressures with measurements.
        Keep = "keep",
    }
    /// The pressure at the start.
    InitialPressure {
        /// rho g depth.
        Hydrostatic = "hydrostatic",
        /// None: water in a tank at rest then oscillates for seconds.
        Zero = "zero",
    }
    /// The model of surface tension.
    SurfaceTension {
        /// None.
        None = "none",
        /// Cohesion and area forces of Akinci, Akinci and Teschner 2013; for `wcsph`.
        Akinci2013 = "akinci2013",
        /// Curvature of the colour field, Mueller et al. 2003; for `mueller2003`.
        ColourField = "mueller2003",
    }
    /// The algorithm that sorts particles into cells.
    Sort {
        /// Counting sort: a histogram, a scan, a scatter.
        Counting = "counting",
        /// Bitonic sort, the method of the thesis; a baseline for comparison.
        Bitonic = "bitonic",
    }
    /// A kind of output file.
    Format {
        /// Binary PLY: particles and the surface.
        Ply = "ply",
        /// VTK's XML format for ParaView: particles.
        Vtu = "vtu",
        /// Wavefront OBJ: the surface.
        Obj = "obj",
        /// Legacy VTK: particles and the surface.
        Vtk = "vtk",
        /// Houdini's geometry format: particles.
        Bgeo = "bgeo",
        /// Archive of arrays for numpy: particles.
        Npz = "npz",
        /// Binary STL for 3-D printers: the surface.
        Stl = "stl",
        /// Binary glTF for the web and game engines: the surface.
        Glb = "glb",
        /// Animated USD, one file for all frames: particles and the surface.
        Usd = "usd",
    }
    /// The subject of a picture.
    PictureKind {
        /// The particles as shaded spheres with a colour bar.
        Particles = "particles",
        /// The reconstructed surface as a liquid.
        Surface = "surface",
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
            Self::Usd => "usda",
            other => other.name(),
        }
    }

    /// Whether files of this format can contain particles.
    pub fn has_particles(self) -> bool {
        self.has(splashdown_io::Format::writes_particles)
    }

    /// Whether files of this format can contain the surface.
    pub fn has_surface(self) -> bool {
        self.has(splashdown_io::Format::writes_meshes)
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

/// The solver and its parameters. [`Solver::default`] gives the defaults of the scene file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Solver {
    /// The method.
    pub method: Method,
    /// The kernel of `wcsph`.
    pub kernel: KernelKind,
    /// Support radius divided by the particle spacing.
    pub support_ratio: f32,
    /// The computation of the density.
    pub density: DensityMode,
    /// The treatment of negative pressures.
    pub negative_pressure: NegativePressure,
    /// Speed of sound in m/s; `None`: ten times the reference speed (see [`crate::scene::Derived::sound_speed`]).
    pub sound_speed: Option<f32>,
    /// Stiffness of the equation of state; `None`: computed from the speed of sound. It is the Tait constant
    /// B = c^2 rho0 / exponent in Pa for `wcsph`, and k = c^2 in m^2/s^2 for `mueller2003`, where p = k (rho
    /// - rho0).
    pub stiffness: Option<f32>,
    /// Exponent of the equation of state.
    pub exponent: f32,
    /// Factor alpha of Monaghan's artificial viscosity.
    pub artificial_viscosity: f32,
    /// Factor delta of the density diffusion; requires `continuity`.
    pub density_diffusion: f32,
    /// The model of surface tension.
    pub surface_tension: SurfaceTension,
    /// Friction at closed sides: 0 for free slip, 1 for no slip.
    pub wall_friction: f32,
    /// Time step divided by the time in which sound travels half the support radius.
    pub cfl_factor: f32,
    /// Maximum time step in s.
    pub max_dt: f32,
    /// Minimum time step in s.
    pub min_dt: f32,
    /// The algorithm that sorts particles into cells.
    pub sort: Sort,
}

impl Solver {
    /// Support radius in m for this particle spacing (m).
    pub fn support_radius(&self, particle_spacing: f32) -> f32 {
        self.support_ratio * particle_spacing
    }
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            method: Method::Wcsph,
            kernel: KernelKind::WendlandC2,
            support_ratio: 2.0,
            density: DensityMode::Summation,
            negative_pressure: NegativePressure::Clamp,
            sound_speed: None,
            stiffness: None,
            exponent: 7.0,
            artificial_viscosity: 0.05,
            density_diffusion: 0.1,
            surface_tension: SurfaceTension::None,
            wall_friction: 0.0,
            cfl_factor: 0.3,
            max_dt: 0.005,
            min_dt: 1e-7,
            sort: Sort::Counting,
        }
    }
}

/// Parameters of surface reconstruction.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SurfaceSettings {
    /// Whether the surface is reconstructed.
    pub enabled: bool,
    /// Edge of a marching-cubes cell in m.
    pub cell_size: f32,
    /// Value of the field at the surface; the field is about 1 inside the fluid.
    pub iso_level: f32,
    /// Iterations of weighted smoothing of the mesh.
    pub smoothing_iterations: u32,
    /// Support radius of the field divided by the particle spacing.
    pub support_ratio: f32,
}

impl SurfaceSettings {
    /// The scene file's defaults at this particle spacing (m).
    pub fn for_spacing(particle_spacing: f32) -> Self {
        Self {
            enabled: true,
            cell_size: particle_spacing * 0.5,
            iso_level: 0.6,
            smoothing_iterations: 5,
            support_ratio: 2.0,
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
    /// Width and height of a picture in pixels.
    pub picture_size: [u32; 2],
    /// The quantity that colours the particles.
    pub colour_by: ColourBy,
    /// Whether a film is made of the pictures.
    pub film: bool,
    /// Values at the ends of the colour bar; `None`: derived from the scene.
    pub colour_range: Option<[f32; 2]>,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            formats: vec![Format::Ply],
            pictures: vec![PictureKind::Particles, PictureKind::Surface],
            picture_size: [1280, 720],
            colour_by: ColourBy::Speed,
            film: true,
            colour_range: None,
        }
    }
}
