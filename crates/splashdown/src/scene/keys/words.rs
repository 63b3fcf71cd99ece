//! Values of keys that only the reader uses: shapes, quantities, sides.

use crate::scene::choice::{Choice, choices};

choices! {
    /// A side of the domain.
    Side {
        /// The side at min x.
        XMin = "x_min",
        /// The side at max x.
        XMax = "x_max",
        /// The floor.
        YMin = "y_min",
        /// The lid.
        YMax = "y_max",
        /// The side at min z.
        ZMin = "z_min",
        /// The side at max z.
        ZMax = "z_max",
    }
    /// The word for an emitter's outlet.
    OutletWord {
        /// Needs `radius`.
        Disc = "disc",
        /// Needs `size`.
        Rectangle = "rectangle",
        /// Cross-section of a closed mesh through its origin, perpendicular to the direction: needs `mesh`.
        Mesh = "mesh",
    }
    /// The word for a sink's shape.
    SinkWord {
        /// Inside a box: needs `min` and `max`.
        Box = "box",
        /// On one side of a plane: needs `point` and `normal`.
        Below = "below",
        /// Inside a closed mesh: needs `mesh`.
        Mesh = "mesh",
    }
    /// The word for what a probe measures.
    QuantityWord {
        /// Pressure in Pa at a point: needs `position`.
        Pressure = "pressure",
        /// Height of the fluid in m above a point, in the column over it: needs `position`.
        Height = "height",
        /// Force in N and torque in N m of the fluid on a body: needs `body`.
        Force = "force",
        /// Pose and velocity of a body at the end of each row's time step, and the mean force in N and torque in N m of the
        /// fluid on it: needs `body`.
        Body = "body",
        /// Volume flow in m^3/s through a rectangle: needs `position`, `normal` and `size`.
        Flow = "flow",
        /// Volume in m^3, kinetic and potential energy in J and momentum in N s of all fluid, or of the fluid
        /// between `min` and `max`, at the end of every frame.
        Fluid = "fluid",
        /// The energy balance of all fluid in J at the end of every frame: kinetic, potential and elastic energy, the work of
        /// bodies and shaking, emitted and removed energy, and what has been dissipated.
        Energy = "energy",
    }
    /// The word for a body's motion.
    MotionWord {
        /// The body does not move.
        Static = "static",
        /// Keyframes or formulas move the body.
        Scripted = "scripted",
        /// The fluid, gravity and contacts move the body.
        Dynamic = "dynamic",
    }
    /// The word for a block's shape.
    ShapeWord {
        /// An axis-aligned box: needs `position` and `size`.
        Box = "box",
        /// A ball: needs `center` and `radius`.
        Sphere = "sphere",
    }
}

impl Side {
    /// The indices of the side in [`crate::scene::Domain::closed`]: axis and side.
    pub fn place(self) -> (usize, usize) {
        let index = Self::ALL.iter().position(|(side, ..)| *side == self).unwrap_or(0);
        (index / 2, index % 2)
    }
}
