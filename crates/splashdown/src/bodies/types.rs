//! What lies in the buffers of bodies.

use glam::{Mat3, Quat, Vec3, Vec4};
use splashdown_gpu::{WgslModule, gpu_struct};

/// The WGSL side of this file.
pub const WGSL: WgslModule = WgslModule { name: "sph/body", source: include_str!("body.wgsl") };

gpu_struct! {
    /// A body on the device. Its own frame is that of its mesh, moved so that `center` is the origin of rotation.
    pub struct Body {
        /// Where `center` is, in m.
        position: Vec3,
        /// How it moves: [`Body::STATIC`], [`Body::SCRIPTED`] or [`Body::DYNAMIC`].
        kind: u32,
        /// The mesh's rotation, a quaternion.
        orientation: Vec4,
        /// Velocity of `center` in m/s.
        velocity: Vec3,
        /// 0 for free slip, 1 for no slip.
        friction: f32,
        /// Angular velocity in rad/s.
        angular_velocity: Vec3,
        /// Acceleration in m/s^2 by which the fluid clings to it.
        adhesion: f32,
        /// The point of the mesh about which it turns, in m: the centre of mass of a dynamic body.
        center: Vec3,
        /// One over the mass in kg; 0 for what is moved by nothing, and on a hinge.
        inverse_mass: f32,
        /// Diagonal of the inertia about `center` in the mesh's frame, in kg m^2.
        inertia: Vec3,
        /// How the fluid feels it: [`Body::MAP`] or [`Body::PARTICLES`].
        way: u32,
        /// The inertia's xy, xz, yz.
        inertia_products: Vec3,
        /// Nothing farther from `position` than this, in m, feels it.
        radius: f32,
        /// Diagonal of the inverse of the inertia.
        inverse_inertia: Vec3,
        /// Where its distances begin in the maps.
        first_node: u32,
        /// The inverse's xy, xz, yz.
        inverse_inertia_products: Vec3,
        /// Nodes of its grid along x.
        nodes_x: u32,
        /// Lower corner of its grid in the mesh's frame, in m.
        field_min: Vec3,
        /// Distance of its grid's nodes in m.
        cell_size: f32,
        /// Force of the fluid on it in the last step, in N.
        force: Vec3,
        /// Nodes of its grid along y.
        nodes_y: u32,
        /// Torque of that about `center`, in N m.
        torque: Vec3,
        /// Nodes of its grid along z.
        nodes_z: u32,
        /// Where its cells of boundary particles begin in the maps: as many as there are cells of the size of
        /// the support radius over the grid, x fastest.
        first_sample_cell: u32,
        /// Cells of boundary particles along x.
        samples_x: u32,
        /// Cells of boundary particles along y.
        samples_y: u32,
        /// Cells of boundary particles along z.
        samples_z: u32,
        /// Distance of the farthest point of the mesh from `center`, in m.
        reach: f32,
        /// Its number among the scripted bodies.
        script: u32,
        /// Nothing; WGSL wants a multiple of sixteen bytes.
        unused: [f32; 2],
        /// Of a body on a hinge, where `center` is: its mass times the arm from there to the centre of mass, in
        /// the mesh's frame, in kg m.
        moment: Vec3,
        /// Nothing.
        unused_2: f32,
    }
}

gpu_struct! {
    /// What one body does to one particle; two of these per particle.
    pub struct Contact {
        /// The gradient of the body's share of the kernel, pointing away from it, in 1/m.
        slope: Vec3,
        /// Its share of the density, over the rest density.
        density: f32,
        /// Unit normal of the nearest surface, pointing into the fluid.
        normal: Vec3,
        /// Distance from the surface in m, negative inside.
        distance: f32,
        /// Its share of the kernel.
        kernel_fraction: f32,
        /// Distance of the plane wall that would have this share, in m.
        effective: f32,
        /// Which body; [`Contact::NONE`] if there is none.
        body: u32,
        /// Nothing.
        unused: u32,
    }
}

gpu_struct! {
    /// Where a scripted body is at one of [`SCRIPT_SAMPLES`] moments of a frame.
    pub struct ScriptSample {
        /// Position in m.
        position: Vec3,
        /// Nothing.
        unused: f32,
        /// Rotation, a quaternion.
        orientation: Vec4,
        /// Velocity in m/s.
        velocity: Vec3,
        /// Nothing.
        unused_2: f32,
        /// Angular velocity in rad/s.
        angular_velocity: Vec3,
        /// Nothing.
        unused_3: f32,
    }
}

/// Moments of a frame at which the host says where a scripted body is; between them motion is a cubic.
pub const SCRIPT_SAMPLES: usize = 65;

/// Words per body in the buffer of sums: force and torque, 64 bits each.
pub const SUM_WORDS: usize = 12;

impl Body {
    /// Stands still.
    pub const STATIC: u32 = 0;
    /// Moves as written.
    pub const SCRIPTED: u32 = 1;
    /// Moves as it is driven.
    pub const DYNAMIC: u32 = 2;
    /// Felt by its map.
    pub const MAP: u32 = 0;
    /// Felt by its boundary particles.
    pub const PARTICLES: u32 = 1;

    /// Its rotation.
    pub fn rotation(&self) -> Quat {
        Quat::from_vec4(self.orientation)
    }

    /// From the world into the mesh's frame.
    #[inline]
    pub fn local(&self, x: Vec3) -> Vec3 {
        self.rotation().conjugate() * (x - self.position) + self.center
    }

    /// Velocity of its material at a point of the world, in m/s.
    #[inline]
    pub fn velocity_at(&self, x: Vec3) -> Vec3 {
        self.velocity + self.angular_velocity.cross(x - self.position)
    }

    /// Takes the velocity that brings the point `anchor` of its own frame towards `target` (m) at `rate` times
    /// its distance per second, by an impulse at that point.
    pub fn pull(&mut self, anchor: Vec3, target: Vec3, rate: f32) {
        let q = self.rotation();
        let arm = q * (anchor - self.center);
        let missing = rate * (target - self.position - arm) - self.velocity_at(self.position + arm);
        let turn = |v: Vec3| q * (self.inverse_inertia_matrix() * (q.conjugate() * v));
        // Change of the point's velocity per impulse there.
        let column = |axis: Vec3| self.inverse_mass * axis + turn(arm.cross(axis)).cross(arm);
        let response = Mat3::from_cols(column(Vec3::X), column(Vec3::Y), column(Vec3::Z));
        // On a hinge the point goes only one way, and nothing has an inverse; a small part of its size mends that.
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
}

fn symmetric(d: Vec3, p: Vec3) -> Mat3 {
    Mat3::from_cols(Vec3::new(d.x, p.x, p.y), Vec3::new(p.x, d.y, p.z), Vec3::new(p.y, p.z, d.z))
}
