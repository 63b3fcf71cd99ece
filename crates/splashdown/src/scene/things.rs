//! What stands, moves, pours, drains and measures in a scene: checked values in SI units, y up.

use std::path::PathBuf;

use glam::{Quat, Vec3};

use super::choice::choices;
use super::script::Script;

/// A solid that the fluid meets.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Its name in messages, probes and files; unique in a scene.
    pub name: String,
    /// Its shape and where that starts.
    pub mesh: MeshSource,
    /// How it moves.
    pub motion: Motion,
    /// 0: the fluid slips along it; 1: it sticks.
    pub friction: f32,
    /// How strongly the fluid clings to it: Akinci's adhesion coefficient in m/s^2-like units; 0 for none.
    pub adhesion: f32,
    /// How the fluid feels it.
    pub boundary: BoundaryKind,
    /// Half the thickness in m that an open mesh gets; `None`: half a particle spacing.
    pub half_thickness: Option<f32>,
    /// Whether the mesh is a shell (a surface with a thickness) or a solid; `None`: decided by the mesh.
    pub shell: Option<bool>,
    /// Linear RGB in [0, 1] in pictures; `None`: a quiet grey.
    pub colour: Option<[f32; 3]>,
}

/// A triangle mesh and its place.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSource {
    /// Where the triangles come from.
    pub shape: MeshShape,
    /// Metres per unit of the file, times any wish to stretch it.
    pub scale: f32,
    /// Which axis of the file points up.
    pub up: UpAxis,
    /// Where the mesh's origin lies at t = 0, in m.
    pub position: Vec3,
    /// The mesh's rotation about its origin at t = 0.
    pub rotation: Quat,
}

/// Where triangles come from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum MeshShape {
    /// One of the models that come with the program (`splashdown::models`).
    Model(String),
    /// A file; its path is relative to the scene file's folder until loading, absolute or as given after.
    File(PathBuf),
}

/// How a body moves.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// Not at all.
    Static,
    /// As written.
    Scripted(Script),
    /// As the fluid, gravity and contacts drive it.
    Dynamic {
        /// Density in kg/m^3.
        density: f32,
        /// Velocity of the centre of mass at t = 0 in m/s.
        velocity: Vec3,
        /// Angular velocity at t = 0 in rad/s.
        angular_velocity: Vec3,
        /// The axis that holds it, if it may only turn.
        hinge: Option<Hinge>,
    },
}

/// An axis, fixed in the world, about which a body turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hinge {
    /// A point of the axis in m.
    pub point: Vec3,
    /// Unit vector along it.
    pub axis: Vec3,
}

choices! {
    /// Which axis of a mesh file points up.
    UpAxis {
        /// y, as in this program, OBJ and glTF.
        Y = "y",
        /// z, as in most STL files and CAD.
        Z = "z",
        /// x.
        X = "x",
    }
    /// How the fluid feels a body.
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
    /// The outlet's shape.
    pub outlet: Outlet,
    /// The middle of the outlet in m.
    pub position: Vec3,
    /// Unit vector along which the fluid leaves.
    pub direction: Vec3,
    /// Speed of the fluid in m/s.
    pub speed: f32,
    /// When it begins, in s.
    pub start: f32,
    /// When it ends, in s; `None`: with the scene.
    pub end: Option<f32>,
    /// Most particles it makes; `None`: as many as fit.
    pub max_particles: Option<u32>,
}

/// The shape of an emitter's outlet.
#[derive(Debug, Clone, PartialEq)]
pub enum Outlet {
    /// A disc of this radius in m.
    Disc {
        /// Radius in m.
        radius: f32,
    },
    /// A rectangle of these edge lengths in m: across, and up.
    Rectangle {
        /// Edge lengths in m.
        size: [f32; 2],
    },
    /// The outline of a closed mesh, cut by the plane through its origin across the direction.
    Mesh(MeshSource),
}

/// Where fluid leaves for good.
#[derive(Debug, Clone, PartialEq)]
pub struct Sink {
    /// Its name in messages.
    pub name: String,
    /// Its shape.
    pub region: SinkRegion,
}

/// The shape of a sink.
#[derive(Debug, Clone, PartialEq)]
pub enum SinkRegion {
    /// Inside this box.
    Box {
        /// Lower corner in m.
        min: Vec3,
        /// Upper corner in m.
        max: Vec3,
    },
    /// Where (x - point) . normal < 0.
    Below {
        /// A point of the plane in m.
        point: Vec3,
        /// Unit vector away from the sink.
        normal: Vec3,
    },
    /// Inside a closed mesh.
    Mesh(MeshSource),
}

/// Something measured while running.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Probe {
    /// Its name: the file's and the column's.
    pub name: String,
    /// What it measures.
    pub quantity: Quantity,
    /// Time between two lines of the file in s; `None`: a tenth of a frame.
    pub interval: Option<f32>,
}

/// What a probe measures.
#[derive(Debug, Clone, PartialEq)]
pub enum Quantity {
    /// Pressure in Pa at a point (m).
    Pressure(Vec3),
    /// Height of the water in m above the point, in the column over it.
    Height(Vec3),
    /// Force in N and torque in N m (about the centre of mass) of the fluid on the body of this name.
    Force(String),
    /// Volume in m^3/s through a rectangle, positive along its normal.
    Flow {
        /// Its middle in m.
        center: Vec3,
        /// Unit normal.
        normal: Vec3,
        /// Unit vector along its first edge.
        along: Vec3,
        /// Edge lengths in m: along `along`, and along `normal` x `along`.
        size: [f32; 2],
    },
    /// Volume in m^3, kinetic and potential energy in J (which is 0 at the origin) and momentum in N s of the
    /// fluid in a box, at the end of every frame.
    Fluid {
        /// Lower corner in m; infinite for all the fluid.
        min: Vec3,
        /// Upper corner in m.
        max: Vec3,
    },
}
