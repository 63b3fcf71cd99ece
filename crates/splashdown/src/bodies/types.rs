//! The elements of the buffers of bodies.

use glam::{Mat3, Quat, Vec3, Vec4};
use splashdown_gpu::{WgslModule, gpu_struct};

/// The WGSL side of this file.
pub const WGSL: WgslModule = WgslModule { name: "sph/body", source: include_str!("body.wgsl") };

gpu_struct! {
    /// A body on the device. It rotates about the point `center` of its mesh.
    pub struct Body {
        /// Position of `center` in the world in m.
        position: Vec3,
        /// Kind of motion: [`Body::STATIC`], [`Body::SCRIPTED`] or [`Body::DYNAMIC`].
        kind: u32,
        /// The mesh's rotation, a quaternion.
        orientation: Vec4,
        /// Velocity of `center` in m/s.
        velocity: Vec3,
        /// 0 for free slip, 1 for no slip.
        friction: f32,
        /// Angular velocity in rad/s.
        angular_velocity: Vec3,
        /// Largest acceleration of the adhesion in m/s^2.
        adhesion: f32,
        /// The point of the mesh about which it rotates, in m: the centre of mass of a dynamic body.
        center: Vec3,
        /// One over the mass in kg; 0 for static, scripted and hinged bodies.
        inverse_mass: f32,
        /// Diagonal of the inertia about `center` in the mesh's frame, in kg m^2.
        inertia: Vec3,
        /// Representation of its boundary: [`Body::MAP`] or [`Body::PARTICLES`].
        way: u32,
        /// Elements xy, xz, yz of the inertia.
        inertia_products: Vec3,
        /// It has no effect on particles farther than this from `position`, in m.
        radius: f32,
        /// Diagonal of the inverse of the inertia.
        inverse_inertia: Vec3,
        /// Index of its first distance in the maps.
        first_node: u32,
        /// Elements xy, xz, yz of the inverse.
        inverse_inertia_products: Vec3,
        /// Nodes of its grid along x.
        nodes_x: u32,
        /// Lower corner of its grid in the mesh's frame, in m.
        field_min: Vec3,
        /// Distance between the nodes of its grid in m.
        cell_size: f32,
        /// Force of the fluid on it in the last step, in N.
        force: Vec3,
        /// Nodes of its grid along y.
        nodes_y: u32,
        /// Torque of this force about `center`, in N m.
        torque: Vec3,
        /// Nodes of its grid along z.
        nodes_z: u32,
        /// Index in the maps of its first cell of boundary particles. The cells have the size of the support radius
        /// and cover the grid, x fastest.
        first_sample_cell: u32,
        /// Cells of boundary particles along x.
        samples_x: u32,
        /// Cells of boundary particles along y.
        samples_y: u32,
        /// Cells of boundary particles along z.
        samples_z: u32,
        /// Largest distance of a point of the mesh from `center`, in m.
        reach: f32,
        /// Its index among the scripted bodies.
        script: u32,
        /// 1 if its map contains its images behind closed sides.
        is_complete: u32,
        /// Its work on the fluid since the start in J.
        work: f32,
        /// For a hinged body, whose hinge is at `center`: the mass times the arm from the hinge to the centre of
        /// mass, in the mesh's frame, in kg m.
        moment: Vec3,
        /// What it adds to the diagonal of the implicit pressure, in m^2/kg: half the area of its mesh times the larger of
        /// its inverse mass and a twelfth of that at its farthest point by rotation; 0 if forces do not move it.
        coupling: f32,
        /// The angular velocity in rad/s towards which a motor turns a hinged body.
        motor: Vec3,
        /// The largest torque of the motor in N m; 0 if there is none.
        motor_torque: f32,
    }
}

gpu_struct! {
    /// The contribution of a body at a particle; two per particle.
    pub struct Contact {
        /// Minus the gradient of the kernel fraction in 1/m: points away from the body.
        slope: Vec3,
        /// Contribution to the density, over the rest density.
        density: f32,
        /// Unit normal of the nearest surface, pointing into the fluid.
        normal: Vec3,
        /// Distance from the surface in m, negative inside.
        distance: f32,
        /// Kernel fraction: the part of the kernel's integral inside the body.
        kernel_fraction: f32,
        /// Effective distance in m: that of a plane wall with this kernel fraction.
        effective: f32,
        /// Index of the body; [`Contact::NONE`] if there is none.
        body: u32,
        /// Padding.
        unused: u32,
    }
}

gpu_struct! {
    /// A contact of a body with a solid that carries a load; several per body.
    pub struct Support {
        /// Unit normal of the contact, pointing towards the body; zero if there is none.
        normal: Vec3,
        /// The smallest speed of the body along the normal in m/s: that of the solid.
        min_speed: f32,
        /// The contact in m from `position` of the body.
        arm: Vec3,
        /// The impulse along the normal in N s by which the speed is kept.
        impulse: f32,
    }
}

gpu_struct! {
    /// The motion of a scripted body at one of [`SCRIPT_SAMPLES`] times of a frame.
    pub struct ScriptSample {
        /// Position in m.
        position: Vec3,
        /// Padding.
        unused: f32,
        /// Rotation, a quaternion.
        orientation: Vec4,
        /// Velocity in m/s.
        velocity: Vec3,
        /// Padding.
        unused_2: f32,
        /// Angular velocity in rad/s.
        angular_velocity: Vec3,
        /// Padding.
        unused_3: f32,
    }
}

/// Times of a frame at which the host samples the motion of a scripted body; the motion between them is a cubic.
pub const SCRIPT_SAMPLES: usize = 65;

/// The largest number of contacts that support a body. Three or four that are far apart hold it.
pub const SUPPORTS: usize = 8;

/// Words per body in the buffer of sums: force and torque, 64 bits each.
pub const SUM_WORDS: usize = 12;

impl Body {
    /// Does not move.
    pub const STATIC: u32 = 0;
    /// Moves by a script.
    pub const SCRIPTED: u32 = 1;
    /// Moves by forces.
    pub const DYNAMIC: u32 = 2;
    /// Boundary represented by a map of distances.
    pub const MAP: u32 = 0;
    /// Boundary represented by boundary particles.
    pub const PARTICLES: u32 = 1;

    /// [`coupling`](Self::coupling) for the surface area in m^2 of the mesh.
    pub fn coupling_of(&self, area: f32) -> f32 {
        if self.kind != Self::DYNAMIC {
            return 0.0;
        }
        let by_rotation = self.reach * self.reach * self.inverse_inertia.element_sum() / 12.0;
        0.5 * area * self.inverse_mass.max(by_rotation)
    }

    /// Its rotation.
    pub fn rotation(&self) -> Quat {
        Quat::from_vec4(self.orientation)
    }

    /// Transforms a point from the world into the mesh's frame.
    #[inline]
    pub fn local(&self, x: Vec3) -> Vec3 {
        self.rotation().conjugate() * (x - self.position) + self.center
    }

    /// Velocity of its material at a point of the world, in m/s.
    #[inline]
    pub fn velocity_at(&self, x: Vec3) -> Vec3 {
        self.velocity + self.angular_velocity.cross(x - self.position)
    }

    /// Applies an impulse at the point `anchor` (m, in its own frame), after which the point approaches `target` (m)
    /// at `rate` (1/s) times their distance.
    pub fn pull(&mut self, anchor: Vec3, target: Vec3, rate: f32) {
        let q = self.rotation();
        let arm = q * (anchor - self.center);
        let missing = rate * (target - self.position - arm) - self.velocity_at(self.position + arm);
        let turn = |v: Vec3| q * (self.inverse_inertia_matrix() * (q.conjugate() * v));
        // Change of the point's velocity per impulse there.
        let column = |axis: Vec3| self.inverse_mass * axis + turn(arm.cross(axis)).cross(arm);
        let response = Mat3::from_cols(column(Vec3::X), column(Vec3::Y), column(Vec3::Z));
        // On a hinge the point has one degree of freedom and the response is singular: a small multiple of its trace
        // on the diagonal makes it invertible.
        let size = response.x_axis.x + response.y_axis.y + response.z_axis.z;
        if size <= 0.0 {
            return;
        }
        let impulse = (response + Mat3::from_diagonal(Vec3::splat(1e-4 * size))).inverse() * missing;
        let spin = turn(arm.cross(impulse));
        self.velocity += self.inverse_mass * impulse;
        self.angular_velocity += spin;
    }

    /// The inertia about `center` in the mesh's frame.
    pub fn inertia_matrix(&self) -> Mat3 {
        symmetric(self.inertia, self.inertia_products)
    }

    /// Its inverse.
    pub fn inverse_inertia_matrix(&self) -> Mat3 {
        symmetric(self.inverse_inertia, self.inverse_inertia_products)
    }
}

impl Contact {
    /// No body.
    pub const NONE: u32 = u32::MAX;

    /// The gradient in 1/m of the contribution to the density with which the body acts on the implicit pressure. The body
    /// reflects the fluid, which doubles it.
    #[inline]
    pub fn solid_gradient(&self) -> Vec3 {
        -2.0 * self.slope
    }

    /// The acceleration by the part of the body that the support radius contains, for an acceleration `a` of the particle
    /// by its neighbours: along the surface, their force continues unchanged into the solid. The part is that of a lattice: the
    /// integral over the solid is a third more at a support of two spacings, and layers at rest would have a twentieth less
    /// than the hydrostatic gradient.
    #[inline]
    pub fn continued(&self, a: Vec3, scale: f32) -> Vec3 {
        let n = self.direction(scale);
        let fraction = self.density.clamp(0.0, 0.6);
        fraction / (1.0 - fraction) * (a - a.dot(n) * n)
    }

    /// The unit vector along which the body's pressure acts: that of the slope, or the normal where the slope vanishes.
    /// `scale` is one over the support radius.
    #[inline]
    pub fn direction(&self, scale: f32) -> Vec3 {
        let steep = self.slope.length();
        if steep > 1e-3 * scale { self.slope / steep.max(1e-20) } else { self.normal }
    }
}

fn symmetric(d: Vec3, p: Vec3) -> Mat3 {
    Mat3::from_cols(Vec3::new(d.x, p.x, p.y), Vec3::new(p.x, d.y, p.z), Vec3::new(p.y, p.z, d.z))
}
