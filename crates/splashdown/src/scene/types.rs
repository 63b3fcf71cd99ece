//! What a scene file says, once it is checked: plain values in SI units, y up.
//!
//! A [`Scene`] from [`Scene::load`] or [`Scene::parse`] holds only values inside the ranges of the table of keys
//! (`keys/`); the fields are public, so code and tests can also build one by hand.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{Quat, Vec3};

use super::choice::{Choice, choices};
use super::errors::SceneWarning;
use super::slot::BuiltSlot;
use super::things::{Body, Emitter, MeshSource, Probe, Sink};

/// A whole scene: what to simulate, how, and what to write.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Scene {
    /// Short name; names the output folder. Letters, digits, `-` and `_`.
    pub name: String,
    /// Simulated time in s.
    pub duration: f32,
    /// Frames per simulated second, in 1/s.
    pub frame_rate: f32,
    /// Gravity in m/s^2; (0, -9.81, 0) unless the file says otherwise.
    pub gravity: Vec3,
    /// The box that holds the fluid.
    pub domain: Domain,
    /// The fluid and where it starts.
    pub fluid: Fluid,
    /// Solids that it meets.
    pub bodies: Vec<Body>,
    /// Sources of more fluid.
    pub emitters: Vec<Emitter>,
    /// Where fluid leaves for good.
    pub sinks: Vec<Sink>,
    /// What is measured while running.
    pub probes: Vec<Probe>,
    /// How it is computed.
    pub solver: Solver,
    /// How its surface is extracted.
    pub surface: SurfaceSettings,
    /// Whether and how it foams.
    pub foam: FoamSettings,
    /// From where it is seen.
    pub camera: Camera,
    /// What is written.
    pub output: Output,
    /// What was repaired or looks unintended.
    pub warnings: Vec<SceneWarning>,
    /// The file it came from, if any.
    pub source: Option<PathBuf>,
    /// What it was read from.
    pub text: Arc<str>,
    /// What modules above have built from it.
    pub(crate) built: BuiltSlot,
}

impl Scene {
    /// Number of frames: `duration * frame_rate`, rounded up, at least 1 (the state at t = 0 is not counted).
    pub fn frame_count(&self) -> u32 {
        // 0.1 s at 30/s is 3.00000004 in f32: a part in a million does not make a frame.
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
pub struct Domain {
    /// Lower corner in m.
    pub min: Vec3,
    /// Upper corner in m.
    pub max: Vec3,
    /// `closed[axis][side]`, axis x, y, z, side 0 = min, 1 = max: whether a wall stands there.
    pub closed: [[bool; 2]; 3],
    /// How the whole tank moves, if it does.
    pub oscillation: Option<Oscillation>,
}

impl Domain {
    /// Edge lengths in m.
    pub fn size(&self) -> Vec3 {
        self.max - self.min
    }

    /// The middle of the box, in m.
    pub fn center(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }
}

/// A harmonic motion of the tank: its position is `amplitude * sin(2 pi t / period)`. The simulation runs in
/// the tank's frame, where the fluid feels [`Oscillation::acceleration`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillation {
    /// Amplitude in m, per axis.
    pub amplitude: Vec3,
    /// Period in s.
    pub period: f32,
}

impl Oscillation {
    /// Inertial acceleration of the fluid in the tank's frame at time `t` (s), in m/s^2: minus the tank's own
    /// acceleration.
    pub fn acceleration(&self, t: f64) -> Vec3 {
        let omega = std::f64::consts::TAU / f64::from(self.period);
        self.amplitude * (omega * omega * (omega * t).sin()) as f32
    }

    /// The tank's largest speed in m/s.
    pub fn max_speed(&self) -> f32 {
        self.amplitude.length() * std::f32::consts::TAU / self.period
    }
}

/// The fluid: resolution, material and starting shape.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Fluid {
    /// Distance of neighbouring particles on the starting lattice, in m: the one resolution number.
    pub particle_spacing: f32,
    /// What it is made of.
    pub material: Material,
    /// Where it starts; may be empty where meshes, files or emitters bring fluid.
    pub blocks: Vec<Block>,
    /// Closed meshes that are filled with fluid at the start.
    pub meshes: Vec<FluidMesh>,
    /// Files of particles that are there at the start.
    pub files: Vec<FluidFile>,
}

impl Fluid {
    /// Half the spacing, in m.
    pub fn particle_radius(&self) -> f32 {
        self.particle_spacing * 0.5
    }
}

/// Measured properties of a liquid; see [`crate::scene::MATERIALS`] for the known ones and their source.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// The word in the scene file, for example `water`.
    pub name: String,
    /// Density at rest in kg/m^3.
    pub rest_density: f32,
    /// Kinematic viscosity in m^2/s.
    pub viscosity: f32,
    /// Surface tension against air in N/m.
    pub surface_tension: f32,
}

/// One piece of fluid at t = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Its shape.
    pub shape: Shape,
    /// Starting velocity of all its particles, in m/s.
    pub velocity: Vec3,
}

/// A closed mesh filled with fluid at t = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct FluidMesh {
    /// The mesh and its place.
    pub mesh: MeshSource,
    /// Starting velocity in m/s.
    pub velocity: Vec3,
}

/// A file of particles at t = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct FluidFile {
    /// PLY, VTK, VTU, NPY or BGEO.
    pub path: PathBuf,
    /// Metres per unit of the file; positions and velocities are multiplied by it.
    pub scale: f32,
    /// Turns positions and velocities about the file's origin.
    pub rotation: Quat,
    /// Where the file's origin lies, in m.
    pub position: Vec3,
    /// Added to the file's velocities, which are zero where it has none, in m/s.
    pub velocity: Vec3,
}

impl FluidFile {
    /// A point of the file in the scene, in m.
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
    /// Lower and upper corner of the bounding box, in m.
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
    /// How the density is found.
    DensityMode {
        /// Sum over the neighbours in every step: robust.
        Summation = "summation",
        /// Continuity equation with diffusion (delta-SPH): smooth pressure.
        Continuity = "continuity",
    }
    /// What happens to pressures below zero.
    NegativePressure {
        /// They are set to zero: no clumping at the surface.
        Clamp = "clamp",
        /// They are kept: needed to compare pressures with measurements.
        Keep = "keep",
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
    /// How particles are sorted into cells.
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
    /// What a picture shows.
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
    /// Ending of the file names, without its dot.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Usd => "usda",
            other => other.name(),
        }
    }

    /// Whether files of this format hold particles.
    pub fn has_particles(self) -> bool {
        self.has(splashdown_io::Format::writes_particles)
    }

    /// Whether files of this format hold the surface.
    pub fn has_surface(self) -> bool {
        self.has(splashdown_io::Format::writes_meshes)
    }

    /// Whether each frame has a file of its own. Otherwise one file holds all frames.
    pub fn is_numbered(self) -> bool {
        !self.has(splashdown_io::Format::is_series)
    }

    /// Whether its surfaces can have velocities.
    pub fn has_vertex_velocities(self) -> bool {
        self.has(|format| format.writes_meshes() && format.has_velocities())
    }

    /// Whether its row in the table of file formats meets a condition.
    fn has(self, condition: fn(&splashdown_io::Format) -> bool) -> bool {
        splashdown_io::Format::with_ending(self.ending()).is_some_and(condition)
    }
}

/// How the fluid is computed. [`Solver::default`] holds the scene file's defaults.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Solver {
    /// The method.
    pub method: Method,
    /// The kernel of `wcsph`.
    pub kernel: KernelKind,
    /// Support radius over particle spacing.
    pub support_ratio: f32,
    /// How the density is found.
    pub density: DensityMode,
    /// What happens to pressures below zero.
    pub negative_pressure: NegativePressure,
    /// Speed of sound in m/s; `None`: ten times the reference speed (see [`crate::scene::Derived::sound_speed`]).
    pub sound_speed: Option<f32>,
    /// Stiffness of the equation of state; `None`: from the speed of sound. For `wcsph` the Tait constant
    /// B = c^2 rho0 / exponent in Pa, for `mueller2003` k = c^2 in m^2/s^2 (exponent 1: p = k (rho - rho0)).
    pub stiffness: Option<f32>,
    /// Exponent of the equation of state.
    pub exponent: f32,
    /// Factor alpha of Monaghan's artificial viscosity.
    pub artificial_viscosity: f32,
    /// Factor delta of the density diffusion, with `continuity`.
    pub density_diffusion: f32,
    /// The model of surface tension.
    pub surface_tension: SurfaceTension,
    /// 0 = free slip, 1 = no slip.
    pub wall_friction: f32,
    /// Time step as a part of half the support radius over the speed of sound.
    pub cfl_factor: f32,
    /// Longest time step in s.
    pub max_dt: f32,
    /// Shortest time step in s.
    pub min_dt: f32,
    /// How particles are sorted into cells.
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

/// How the surface is extracted.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SurfaceSettings {
    /// Whether it is extracted at all.
    pub enabled: bool,
    /// Edge of a marching-cubes cell in m.
    pub cell_size: f32,
    /// Where the surface lies, as a part of the density inside the fluid.
    pub iso_level: f32,
    /// Rounds of weighted smoothing of the mesh.
    pub smoothing_iterations: u32,
    /// Support radius of the density field over the particle spacing.
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

/// Whether and how a splash makes foam, spray and bubbles (Ihmsen et al. 2012).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FoamSettings {
    /// Whether it does at all.
    pub enabled: bool,
    /// Diffuse particles per second from a particle of the fluid that traps as much air as it can, in 1/s.
    pub trapped_air: f32,
    /// The same from a wave's crest, in 1/s.
    pub wave_crest: f32,
    /// From where to where trapped air counts, over the scene's reference speed.
    pub trapped_air_limits: [f32; 2],
    /// From where to where a crest's curvature counts.
    pub wave_crest_limits: [f32; 2],
    /// From where to where the fluid's speed counts, over the scene's reference speed.
    pub speed_limits: [f32; 2],
    /// Shortest and longest life of foam in s.
    pub lifetime: [f32; 2],
    /// Buoyancy of bubbles in multiples of gravity.
    pub buoyancy: f32,
    /// How quickly bubbles take the water's velocity, in 1/s.
    pub drag: f32,
    /// Most diffuse particles; `None`: four per particle of the fluid, four million at most.
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

/// An orbit camera: it looks at `target` from `distance` away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// The point in the middle of the picture, in m.
    pub target: Vec3,
    /// Distance of the eye from the target, in m.
    pub distance: f32,
    /// Angle around the y axis in degrees: 0 looks from +z (x to the right), 90 from +x.
    pub azimuth: f32,
    /// Angle above the horizon in degrees.
    pub elevation: f32,
    /// Vertical angle of view in degrees.
    pub field_of_view: f32,
    /// How fast the azimuth grows, in degrees per simulated second.
    pub orbit_speed: f32,
}

/// What is written.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Output {
    /// File formats of the frames.
    pub formats: Vec<Format>,
    /// Pictures of each frame.
    pub pictures: Vec<PictureKind>,
    /// Width and height of a picture in pixels.
    pub picture_size: [u32; 2],
    /// What colours the particles.
    pub colour_by: ColourBy,
    /// Whether the pictures become a film.
    pub film: bool,
    /// The quantity at both ends of the colour bar; `None`: chosen from the scene.
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
