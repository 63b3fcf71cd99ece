//! The passes of a step, one folder each: equation and declaration (`mod.rs`), WGSL, and the CPU's way (`cpu.rs`).
//!
//! Particles rest in arrays "A" (`positions`, `velocities`, `ids`). A step sorts them by cell into arrays "B"
//! (`sorted_*`), computes from B, and integrates back into A, so that a step needs no swap of buffers and one
//! that has nothing to do leaves A untouched. The pass that moves particles counts them for the next step's
//! sort, and that sort settles the step before it.

pub mod acceleration;
pub mod begin;
pub mod continuity;
pub mod density;
pub mod end_step;
pub mod force_integrate;
pub mod integrate;
pub mod mueller;
pub mod normals;
pub mod state_equation;

pub(crate) mod advance;
pub(crate) mod pairs;

pub use advance::WGSL as ADVANCE;

use crate::boundary::{KernelPair, Walls};
use glam::Vec3;
use splashdown_gpu::{PassDesc, WgslModule, gpu_struct};

/// The WGSL side of [`StepState`].
pub const STATE: WgslModule = WgslModule { name: "sph/state", source: include_str!("state.wgsl") };
/// The WGSL side of [`Params`]; imports [`STATE`].
pub const PARAMS: WgslModule = WgslModule { name: "sph/params", source: include_str!("params.wgsl") };
/// `row_range`: how the GPU visits neighbours.
pub const ROWS: WgslModule = WgslModule { name: "sph/rows", source: include_str!("rows.wgsl") };
/// `acceleration_of`: all forces in one visit of the neighbours.
pub const FORCES: WgslModule = WgslModule { name: "sph/forces", source: include_str!("forces.wgsl") };
/// The WGSL side of [`StepCounters`].
pub const STEP_COUNTERS: WgslModule =
    WgslModule { name: "sph/step_counters", source: include_str!("step_counters.wgsl") };
/// `finish_step`: the end of a step; imports [`STEP_COUNTERS`].
pub const STEPS: WgslModule = WgslModule { name: "sph/steps", source: include_str!("steps.wgsl") };

gpu_struct! {
    /// What does not change while a simulation runs. SI units.
    pub struct Params {
        /// Gravity in m/s^2.
        gravity: Vec3,
        /// Where the kernel becomes zero, in metres.
        support_radius: f32,
        /// Lower corner of the domain in metres.
        domain_min: Vec3,
        /// Distance of particles on the initial lattice in metres.
        particle_spacing: f32,
        /// Upper corner of the domain in metres.
        domain_max: Vec3,
        /// Mass of a particle in kg.
        particle_mass: f32,
        /// Amplitude of the tank's acceleration, as felt in the tank, in m/s^2.
        shake: Vec3,
        /// Its angular frequency in rad/s.
        shake_rate: f32,
        /// Density at rest in kg/m^3.
        rest_density: f32,
        /// Numerical speed of sound in m/s.
        sound_speed: f32,
        /// How far behind a closed side its solid begins, in metres: see [`wall_offset`](crate::boundary::wall_offset).
        wall_offset: f32,
        /// Exponent of the equation of state.
        exponent: f32,
        /// Kinematic viscosity in m^2/s.
        viscosity: f32,
        /// Coefficient alpha of the artificial viscosity.
        artificial_viscosity: f32,
        /// Coefficient delta of the density diffusion.
        density_diffusion: f32,
        /// Akinci's gamma in m^4/(kg s^2), or Mueller's sigma in N/m; 0 for none.
        surface_tension: f32,
        /// 0 for free slip at closed sides, 1 for no slip.
        wall_friction: f32,
        /// Factor of the time step's limits by sound and speed.
        cfl_factor: f32,
        /// Largest time step in seconds.
        max_dt: f32,
        /// Smallest time step in seconds.
        min_dt: f32,
        /// Bit 2 * axis + side is set if that side of the domain is closed.
        closed: u32,
        /// 1 if negative pressures count as zero.
        clamp_pressure: u32,
        /// Number of particles, dead ones included.
        particle_count: u32,
        /// Damping of the speed towards closed sides: 1 where the density is summed, 0 where it is integrated.
        wall_damping: f32,
    }
}

gpu_struct! {
    /// What changes from step to step; decided on the device.
    pub struct StepState {
        /// The current time step in seconds.
        dt: f32,
        /// The time step that stability asks for; `dt` may be shorter to meet the end of a frame.
        stable_dt: f32,
        /// Simulated time in seconds.
        time: f32,
        /// What is left of the frame in seconds.
        remaining: f32,
        /// 1 once the frame is complete: the passes do nothing then.
        done: u32,
        /// Particles to process: all, or none once the frame is complete.
        run_count: u32,
        /// Steps of this frame.
        steps: u32,
        /// 1 if stability asked for less than `min_dt` in this frame; `min_dt` was taken then.
        too_small: u32,
        /// Largest speed of the last step in m/s.
        max_speed: f32,
        /// Largest acceleration of the last step in m/s^2.
        max_acceleration: f32,
        /// Largest relative excess of density in this frame.
        density_error: f32,
        /// Length of the frame in seconds.
        frame_duration: f32,
    }
}

/// Counters and maxima that passes raise atomically: the places of the words.
///
/// Maxima are of non-negative floats by their bits, whose order is that of the numbers, so the result does not depend
/// on the order of the invocations.
pub struct StepCounters;

impl StepCounters {
    /// Particles that left through an open side.
    pub const ESCAPED: usize = 0;
    /// Particles that became NaN or infinite.
    pub const NON_FINITE: usize = 1;
    /// Particles put back through a closed wall.
    pub const CORRECTIONS: usize = 2;
    /// Velocities limited to half a spacing per step.
    pub const LIMITED: usize = 3;
    /// Largest speed.
    pub const MAX_SPEED: usize = 4;
    /// Largest acceleration.
    pub const MAX_ACCELERATION: usize = 5;
    /// Largest relative excess of density.
    pub const MAX_EXCESS: usize = 6;
    /// Particles that went into sinks.
    pub const DRAINED: usize = 7;
    /// 1 if particles have moved since the last step was [settled](end_step).
    pub const MOVED: usize = 8;
    /// Number of words.
    pub const WORDS: usize = 9;
}

/// Mark of a particle that left, in the fourth component of its position.
pub const DEAD_ESCAPED: f32 = 1.0;
/// Mark of a particle that became NaN or infinite.
pub const DEAD_NON_FINITE: f32 = 2.0;
/// Mark of a place that waits for a particle to be born.
pub const DEAD_UNBORN: f32 = 3.0;
/// Mark of a particle that went into a sink.
pub const DEAD_DRAINED: f32 = 4.0;

impl StepState {
    /// The length of a step: what is left of the frame is split evenly, so that no tiny step is left over.
    pub fn step_length(stable: f32, remaining: f32) -> f32 {
        if remaining >= 2.0 * stable {
            stable
        } else if remaining <= stable {
            remaining
        } else {
            0.5 * remaining
        }
    }

    /// True of the step that completes its frame. Both numbers are stored, so all passes decide alike.
    pub fn is_last_step(&self) -> bool {
        self.dt >= self.remaining
    }
}

impl Params {
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
        if self.clamp_pressure == 1 { p.max(0.0) } else { p }
    }

    /// True of a finite point outside the domain.
    #[inline]
    pub fn is_outside(&self, x: Vec3) -> bool {
        x.cmplt(self.domain_min).any() || x.cmpgt(self.domain_max).any()
    }

    /// The closed sides of the domain for these kernels.
    pub fn walls(&self, kernels: KernelPair) -> Walls {
        Walls {
            min: self.domain_min,
            max: self.domain_max,
            closed: self.closed,
            offset: self.wall_offset,
            support_radius: self.support_radius,
            kernels,
        }
    }

    /// Gravity and the tank's own motion, in m/s^2, at a time in seconds.
    pub fn body_acceleration(&self, time: f32) -> Vec3 {
        self.gravity + self.shake * (self.shake_rate * time).sin()
    }
}

/// Every pass of this module and of [`cells`](crate::cells).
pub fn passes() -> Vec<&'static PassDesc> {
    let mut all = crate::cells::passes();
    all.extend([
        &begin::BEGIN,
        &continuity::WENDLAND_C2,
        &continuity::CUBIC_SPLINE,
        &density::WENDLAND_C2,
        &density::CUBIC_SPLINE,
        &density::POLY6,
        &integrate::INTEGRATE,
        &integrate::UNCOUNTED,
        &acceleration::WENDLAND_C2,
        &acceleration::CUBIC_SPLINE,
        &acceleration::WENDLAND_C2_PRESSURE,
        &acceleration::WENDLAND_C2_OTHER,
        &force_integrate::WENDLAND_C2,
        &force_integrate::CUBIC_SPLINE,
        &mueller::MUELLER,
        &normals::WENDLAND_C2,
        &normals::CUBIC_SPLINE,
        &end_step::END_STEP,
        &state_equation::STATE_EQUATION,
    ]);
    all
}
