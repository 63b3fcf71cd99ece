//! The constants of a simulation.

use glam::{Vec2, Vec3};
use splashdown_gpu::{WgslModule, gpu_struct};

use super::StepState;

/// The WGSL side of [`Params`]; imports [`STATE`](super::STATE).
pub const WGSL: WgslModule = WgslModule { name: "sph/params", source: include_str!("params.wgsl") };

gpu_struct! {
    /// The constants of a simulation, in SI units.
    pub struct Params {
        /// Gravity in m/s^2.
        gravity: Vec3,
        /// The distance at which the kernel becomes zero, in metres.
        support_radius: f32,
        /// Lower corner of the domain in metres.
        domain_min: Vec3,
        /// Distance of particles on the initial lattice in metres.
        particle_spacing: f32,
        /// Upper corner of the domain in metres.
        domain_max: Vec3,
        /// Mass of a particle in kg: rest_density * particle_spacing^3.
        particle_mass: f32,
        /// Amplitude of the inertial acceleration in an oscillating domain, in m/s^2.
        oscillation: Vec3,
        /// Angular frequency of the oscillation in rad/s.
        oscillation_rate: f32,
        /// Density at rest in kg/m^3.
        rest_density: f32,
        /// Numerical speed of sound in m/s.
        sound_speed: f32,
        /// Offset of the distance to a body for the density, in metres: see
        /// [`SolidDistance`](crate::boundary::SolidDistance).
        solid_offset: f32,
        /// Exponent of the equation of state.
        exponent: f32,
        /// Kinematic viscosity in m^2/s that is integrated explicitly.
        viscosity: f32,
        /// Coefficient alpha of the artificial viscosity.
        artificial_viscosity: f32,
        /// Coefficient delta of the density diffusion.
        density_diffusion: f32,
        /// Akinci's gamma in m^4/(kg s^2), or Mueller's sigma in N/m; 0 for none.
        surface_tension: f32,
        /// Friction of closed sides: 0 for free slip, 1 for no slip.
        wall_friction: f32,
        /// Factor of the time step's limits by sound and speed.
        cfl_factor: f32,
        /// Largest time step in seconds.
        max_dt: f32,
        /// Smallest time step in seconds.
        min_dt: f32,
        /// Bit 2 * axis + side is set if that side of the domain is closed.
        closed: u32,
        /// 1 if negative pressures are set to zero. An implicit pressure is otherwise at least that of the
        /// [`tension_limit`](Self::tension_limit).
        clamp_pressure: u32,
        /// Number of particles, including removed ones and those not yet emitted.
        particle_count: u32,
        /// Damping of the velocity towards bodies: 1 if the density is summed, 0 if it is integrated.
        approach_damping_factor: f32,
        /// The mass in kg with which a particle enters sums over neighbours. Where the density is summed, it is
        /// particle_mass divided by the kernel's sum over the lattice, which then has the rest density.
        summed_mass: f32,
        /// One over the kernel at a distance of one spacing, as W H^3.
        inverse_kernel_at_spacing: f32,
        /// Numerical viscosity in m^2/s in the friction of bodies, in addition to that of the material.
        boundary_viscosity: f32,
        /// 1 if the pressure is implicit: the time step then does not depend on sound and accelerations.
        is_implicit: u32,
        /// Largest mean residual of the density that the implicit pressure may have.
        tolerance: f32,
        /// Largest number of iterations of the implicit pressure.
        max_iterations: u32,
        /// The largest distance that a particle moves per step by its velocity, in spacings.
        longest_motion: f32,
        /// The pressure over rho0 times the solution of the implicit pressure: that of its forces on a lattice.
        pressure_factor: f32,
        /// Kinematic viscosity in m^2/s that is integrated implicitly. `viscosity` is zero then.
        implicit_viscosity: f32,
        /// Factor of the sums of the implicit viscosity in 1/s.
        viscous_factor: f32,
        /// The residual of the implicit viscosity at which its iterations stop, as a part of its reference.
        viscous_tolerance: f32,
        /// Largest number of iterations of the implicit viscosity.
        most_viscous_iterations: u32,
        /// Factor of the continuum surface force: surface tension times the volume of a particle over rho0 and H^5, in
        /// 1/s^2, 1.35 times as large with an implicit pressure; 0 without.
        tension_factor: f32,
        /// Largest absolute curvature of the surface in 1/m.
        largest_curvature: f32,
        /// Mean depth below the surface at which the curvature is computed, in metres.
        interface_depth: f32,
        /// Length of a normal without unit below which it has no direction.
        weakest_normal: f32,
        /// Cosine of the contact angle at closed sides over half of the support radius, in 1/m; not above zero.
        wetting: f32,
        /// Relaxation of the Jacobi map of the implicit pressure at the beginning of a step.
        relaxation: f32,
        /// Relative excess of density that remains per unit of the implicit k, in s^2/m^2, without that by motions.
        compressibility: f32,
        /// Factor of the density that the implicit pressure adds at the free surface; see
        /// [`residual`](crate::passes::implicit::residual).
        surface_completion: f32,
        /// Factor of the distance to a body beyond [`stretched_from`](Self::stretched_from).
        solid_stretch: f32,
        /// Offset of the distance to a body for the gradient of the density, in metres.
        slope_offset: f32,
        /// Pressure at the rest density in Pa; not zero in the initial packing only.
        background_pressure: f32,
        /// The trace of the sum M of `passes::correction` over three, on the initial lattice.
        lattice_moment: f32,
        /// The largest mean excess of density that the implicit pressure accepts; above zero only where fluid fills a closed
        /// domain.
        accepted_excess: f32,
        /// Square of the sound speed of the implicit pressure over that of the largest speed; above zero only where fluid
        /// fills a closed domain.
        motion_stiffness: f32,
        /// Padding.
        unused: Vec2,
    }
}

/// The height in spacings of the water whose weight the tension of the implicit pressure may carry.
const TENSION_HEIGHT: f32 = 2.0;

/// The least motion per step, in spacings, for which the fluid in a full domain is as stiff as for its speed.
const SLOWEST_MOTION: f32 = 0.01;

/// The least `cfl_factor` for the speed of sound in the densest fluid, about half of the longest stable step. With 1.0 a block
/// that was thrown into a corner gained energy.
const COMPRESSED_FACTOR: f32 = 0.9;

/// The largest integrated density at a body over the rest density. An impact on one wall at half the speed of sound stays below it
/// with the exponent 7.
const HIGHEST_DENSITY: f32 = 1.35;

impl Params {
    /// [`stretched_from`](Self::stretched_from) of explicit schemes, in spacings. Nearer particles are in inner edges and corners,
    /// where the effective distance is small; the offset alone is accurate there.
    pub const STRETCHED_FROM: f32 = 0.25;

    /// The distance from a body in m from which it is stretched; see [`SolidDistance`](crate::boundary::SolidDistance). The maps of
    /// an implicit scheme describe edges with the stretched kernel, so that it is zero there.
    pub fn stretched_from(&self) -> f32 {
        if self.is_implicit == 1 { 0.0 } else { Self::STRETCHED_FROM * self.particle_spacing }
    }

    /// The largest tension of the implicit pressure over the rest density, in m^2/s^2: the weight of water two spacings high.
    pub fn tension_limit(&self) -> f32 {
        if self.clamp_pressure == 1 {
            0.0
        } else {
            TENSION_HEIGHT * self.gravity.length() * self.particle_spacing
        }
    }

    /// Relative excess of density that remains per unit of the implicit k in a step, in s^2/m^2. Where the fluid fills a
    /// closed domain it depends on the largest speed; it is smaller than `compressibility`, or above zero if that is zero.
    pub fn compressibility_in(&self, state: &StepState) -> f32 {
        if self.motion_stiffness == 0.0 {
            return self.compressibility;
        }
        // Fluid that rests without gravity has a compressibility too.
        let slowest = SLOWEST_MOTION * self.particle_spacing / state.dt;
        let speed = state.max_speed.max(state.body_speed).max(slowest);
        let stiffness = self.motion_stiffness * speed * speed;
        if self.compressibility > 0.0 {
            self.compressibility / (1.0 + self.compressibility * stiffness)
        } else {
            1.0 / stiffness
        }
    }

    /// The rate in 1/s at which the implicit pressure closes deficits of density inside the fluid: the speed after a fall
    /// through one spacing, per spacing.
    pub fn closing_rate(&self) -> f32 {
        (2.0 * self.gravity.length() / self.particle_spacing).sqrt()
    }

    /// The length of the next step, for the largest stable step and the remaining time of the frame.
    ///
    /// With an implicit pressure the remaining time is divided evenly, because a step of another length than the last
    /// disturbs the pressure. Within a frame (`is_first` is false) a limit that falls by up to 5 % does not change the
    /// length. Explicit steps are as long as possible, and the last two are equal, so that none is tiny.
    pub fn step_length(&self, stable: f32, remaining: f32, is_first: bool) -> f32 {
        if self.is_implicit == 1 {
            // At the start of a frame the limit may be exceeded by rounding only.
            let allowed = if is_first { 1.0001 } else { 1.05 };
            let steps = (remaining / (allowed * stable)).ceil();
            if steps <= 1.0 { remaining } else { remaining / steps }
        } else if remaining >= 2.0 * stable {
            stable
        } else if remaining <= stable {
            remaining
        } else {
            0.5 * remaining
        }
    }

    /// The longest stable step in s for the largest speed in m/s, acceleration in m/s^2 and relative excess of density of the
    /// particles, without the limit by the implicit pressure (Monaghan 1992; viscosity: Morris et al. 1997).
    ///
    /// Sound in compressed fluid travels at c0 (rho / rho0)^((exponent - 1) / 2). With the default `cfl_factor` of the
    /// continuity form this limit is the shorter one from an excess of 4 %.
    pub fn longest_step(&self, speed: f32, acceleration: f32, excess: f32) -> f32 {
        let (h, c) = (0.5 * self.support_radius, self.cfl_factor);
        let by_motion = if self.is_implicit == 1 {
            c * self.particle_spacing / speed.max(1e-20)
        } else {
            let compressed = self.sound_speed * (1.0 + excess).powf(0.5 * (self.exponent - 1.0));
            (c * h / (self.sound_speed + speed))
                .min(c.max(COMPRESSED_FACTOR) * h / (compressed + speed))
                .min(c * (h / acceleration.max(1e-20)).sqrt())
                .min(c * 0.4 * self.particle_spacing / speed.max(1e-20))
                .min(0.17 * h / (self.density_diffusion * self.sound_speed).max(1e-20))
        };
        by_motion.min(self.max_dt).min(0.125 * h * h / self.viscosity.max(1e-20))
    }

    /// The largest speed of a body in m/s that limits the time step: the step stays well above `min_dt`, which ends a run.
    pub fn fastest_body(&self) -> f32 {
        0.1 * self.cfl_factor * self.particle_spacing / self.min_dt
    }

    /// The pressure in Pa at a density in kg/m^3: p = rho0 c0^2 / exponent ((rho/rho0)^exponent - 1) (Cole 1948).
    #[inline(always)]
    pub fn pressure_at(&self, density: f32) -> f32 {
        let x = density / self.rest_density;
        let stiffness = self.rest_density * self.sound_speed * self.sound_speed / self.exponent;
        let p = if self.exponent == 7.0 {
            let x2 = x * x;
            stiffness * (x2 * x2 * x2 * x - 1.0)
        } else if self.exponent == 1.0 {
            stiffness * (x - 1.0)
        } else {
            stiffness * (x.powf(self.exponent) - 1.0)
        };
        (if self.clamp_pressure == 1 { p.max(0.0) } else { p }) + self.background_pressure
    }

    /// The integrated density in kg/m^3 of a particle at a body, at most [`HIGHEST_DENSITY`] times that at rest. Between two
    /// surfaces that approach each other to less than a spacing, it grows without bound. NaN and infinity are kept, so that
    /// the integration finds and reports them.
    #[inline(always)]
    pub fn bounded_density(&self, density: f32) -> f32 {
        let highest = HIGHEST_DENSITY * self.rest_density;
        if density > highest && density.is_finite() { highest } else { density }
    }

    /// True if a finite point lies outside the domain.
    #[inline]
    pub fn is_outside(&self, x: Vec3) -> bool {
        x.cmplt(self.domain_min).any() || x.cmpgt(self.domain_max).any()
    }

    /// Gravity and the inertial acceleration of the oscillating domain, in m/s^2, at a time in seconds.
    pub fn body_acceleration(&self, time: f32) -> Vec3 {
        self.gravity + self.oscillation * (self.oscillation_rate * time).sin()
    }
}
