//! Bodies, emitters, sinks and probes of a scene: checked values in SI units, with y up.

use std::path::PathBuf;

use glam::{Quat, Vec3};

use super::choice::choices;
use super::script::Script;

/// A solid body in the fluid.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Its name in messages, probes and files; unique in a scene.
    pub name: String,
    /// Its shape and initial pose.
    pub mesh: MeshSource,
    /// Its motion.
    pub motion: Motion,
    /// Friction between fluid and body: 0 for free slip, 1 for no slip.
    pub friction: f32,
    /// Akinci's adhesion coefficient in units like m/s^2; 0 for no adhesion.
    pub adhesion: f32,
    /// Contact with other bodies and with the sides of the domain.
    pub contact: SolidContact,
    /// The boundary method.
    pub boundary: BoundaryKind,
    /// Half the thickness of a shell in m; `None`: half a particle spacing.
    pub half_thickness: Option<f32>,
    /// Whether the mesh is a shell (a surface with a thickness) or a solid; `None` decides by the size of its
    /// holes.
    pub shell: Option<bool>,
    /// Linear RGB in [0, 1] in pictures; `None`: grey.
    pub colour: Option<[f32; 3]>,
}

/// A triangle mesh and its initial pose.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSource {
    /// The source of the triangles.
    pub shape: MeshShape,
    /// Metres per unit of the file, along each axis of the file.
    pub scale: Vec3,
    /// The axis of the file that points up.
    pub up: UpAxis,
    /// Position of the mesh's origin at t = 0, in m.
    pub position: Vec3,
    /// The mesh's rotation about its origin at t = 0.
    pub rotation: Quat,
}

/// The source of triangles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum MeshShape {
    /// A built-in model (`splashdown::models`).
    Model(String),
    /// A file. [`Scene::load`](crate::Scene::load) resolves its path relative to the scene file's folder.
    File(PathBuf),
}

/// The motion of a body.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// The body does not move.
    Static,
    /// A script moves the body.
    Scripted(Script),
    /// The fluid, gravity and contacts move the body.
    Dynamic {
        /// Density in kg/m^3.
        density: f32,
        /// Velocity of the centre of mass at t = 0 in m/s.
        velocity: Vec3,
        /// Angular velocity at t = 0 in rad/s.
        angular_velocity: Vec3,
        /// The axis of a body that can only rotate.
        hinge: Option<Hinge>,
    },
}

/// An axis, fixed in space, about which a body rotates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hinge {
    /// A point on the axis in m.
    pub point: Vec3,
    /// Unit vector along it.
    pub axis: Vec3,
    /// The motor that turns the body.
    pub motor: Option<Motor>,
}

/// A motor on a hinge. It keeps a body at a speed as long as its torque suffices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// Angular velocity about the axis of the hinge in rad/s.
    pub speed: f32,
    /// Maximum torque in N m; `None`: no limit.
    pub torque: Option<f32>,
}

/// What decides how a body slides on other solids and bounces off them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolidContact {
    /// Coefficient of friction (Coulomb).
    pub friction: f32,
    /// Coefficient of restitution: the ratio of the speeds after and before a collision.
    pub restitution: f32,
}

impl Default for SolidContact {
    /// Roughly wood on wood.
    fn default() -> Self {
        Self { friction: 0.4, restitution: 0.2 }
    }
}

choices! {
    /// The axis of a mesh file that points up.
    UpAxis {
        /// y, as in this program, OBJ and glTF.
        Y = "y",
        /// z, as in most STL files and CAD.
        Z = "z",
        /// x.
        X = "x",
    }
    /// The boundary method of a body.
    BoundaryKind {
        /// Integral of the kernel over the solid, interpolated from a grid.
        Map = "map",
        /// Boundary particles on the surface of the body (Akinci et al. 2012).
        Particles = "particles",
    }
}

/// A source of fluid.
#[derive(Debug, Clone, PartialEq)]
pub struct Emitter {
    /// Its name in messages.
    pub name: String,
    /// The shape of the outlet.
    pub outlet: Outlet,
    /// The centre of the outlet in m.
    pub position: Vec3,
    /// Unit vector in the direction of the outflow.
    pub direction: Vec3,
    /// Speed of the outflow in m/s.
    pub speed: f32,
    /// Start time in s.
    pub start: f32,
    /// End time in s; `None`: the end of the scene.
    pub end: Option<f32>,
    /// Maximum number of particles created; `None`: no limit other than memory.
    pub max_particles: Option<u32>,
}

/// The shape of an emitter's outlet.
#[derive(Debug, Clone, PartialEq)]
pub enum Outlet {
    /// A disc.
    Disc {
        /// Radius in m.
        radius: f32,
    },
    /// A rectangle.
    Rectangle {
        /// Edge lengths in m: horizontal, and perpendicular to it.
        size: [f32; 2],
    },
    /// The cross-section of a closed mesh in the plane through its origin, perpendicular to the direction.
    Mesh(MeshSource),
}

/// A region that removes fluid.
#[derive(Debug, Clone, PartialEq)]
pub struct Sink {
    /// Its name in messages.
    pub name: String,
    /// Its shape.
    pub region: SinkRegion,
}

/// The shape of a sink.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum SinkRegion {
    /// Inside this box.
    Box {
        /// Lower corner in m.
        min: Vec3,
        /// Upper corner in m.
        max: Vec3,
    },
    /// The half-space (x - point) . normal < 0.
    Below {
        /// A point on the plane in m.
        point: Vec3,
        /// Unit vector away from the sink.
        normal: Vec3,
    },
    /// Inside a closed mesh.
    Mesh(MeshSource),
}

/// A measurement during the run.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Probe {
    /// Its name, also that of its file and column.
    pub name: String,
    /// The measured quantity.
    pub quantity: Quantity,
    /// Time between two rows of the file in s; `None`: a tenth of a frame.
    pub interval: Option<f32>,
}

/// The quantity that a probe measures.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Quantity {
    /// Pressure in Pa at a point (m).
    Pressure(Vec3),
    /// Height of the fluid in m above a point, in the column over it.
    Height(Vec3),
    /// Force in N and torque in N m (about the centre of mass) of the fluid on the body of this name.
    Force(String),
    /// Pose and velocity of the body of this name at the time of a row, and force and torque as
    /// [`Force`](Self::Force).
    Body(String),
    /// Volume flow in m^3/s through a rectangle, positive along its normal.
    Flow {
        /// Its centre in m.
        center: Vec3,
        /// Unit normal.
        normal: Vec3,
        /// Unit vector along its first edge.
        along: Vec3,
        /// Edge lengths in m along `along` and along `normal` x `along`.
        size: [f32; 2],
    },
    /// Volume in m^3, kinetic and potential energy in J (the latter relative to the origin) and momentum in N
    /// s of the fluid in a box, at the end of every frame.
    Fluid {
        /// Lower corner in m; infinite for all fluid.
        min: Vec3,
        /// Upper corner in m.
        max: Vec3,
    },
    /// The energy balance of all fluid in J, at the end of every frame.
    Energy,
}
