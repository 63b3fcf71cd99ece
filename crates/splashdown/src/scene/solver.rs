//! The solver of a scene: its method, its parameters, and their defaults.

use super::choice::choices;

choices! {
    /// The solver of the fluid's equations.
    Method {
        /// Forces of Mueller, Charypar and Gross 2003, the method of the thesis of Figueroa 2012: fast, and more
        /// compressible. For comparison with that thesis.
        Mueller2003 = "mueller2003",
        /// Weakly compressible SPH with Tait's equation of state: short explicit steps. With accuracy = "engineering" for
        /// pressures, forces and waves.
        Wcsph = "wcsph",
        /// Implicit pressure that keeps the density: few large steps, and the least time per simulated second. For pictures,
        /// films, viscous liquids and large scenes.
        Dfsph = "dfsph",
    }
    /// The smoothing kernel of `wcsph` and `dfsph` (`mueller2003` brings its own three).
    KernelKind {
        /// Wendland's C2 function, without pairing instability.
        WendlandC2 = "wendland_c2",
        /// A blend of Wendland's C2 functions for three dimensions and for one, which reduces the resistance of a lattice of
        /// particles to shear at a support ratio of 2.
        WendlandBlend = "wendland_blend",
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
        /// They are kept: needed to compare pressures with measurements. With summation, only for fluid that fills the domain.
        Keep = "keep",
    }
    /// The model of surface tension.
    SurfaceTension {
        /// None.
        None = "none",
        /// Cohesion and area forces of Akinci, Akinci and Teschner 2013; for `wcsph` and `dfsph`.
        Akinci2013 = "akinci2013",
        /// Continuum surface force in N/m, Brackbill, Kothe and Zemach 1992 and Morris 2000: for measurements, with
        /// accuracy = "engineering"; for `wcsph` and `dfsph`.
        Csf = "csf",
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
}

/// The solver and its parameters. [`Solver::default`] gives the defaults of the scene file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Solver {
    /// The method.
    pub method: Method,
    /// The kernel of `wcsph` and `dfsph`.
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
    /// Angle in degrees between the surface and closed sides, measured within the fluid; requires `csf`.
    pub contact_angle: f32,
    /// Friction at closed sides: 0 for free slip, 1 for no slip.
    pub wall_friction: f32,
    /// Time step divided by the time in which sound travels half the support radius; with `dfsph`, largest distance in
    /// spacings that a particle moves per step.
    pub cfl_factor: f32,
    /// Maximum time step in s.
    pub max_dt: f32,
    /// Minimum time step in s.
    pub min_dt: f32,
    /// The algorithm that sorts particles into cells.
    pub sort: Sort,
    /// Largest mean residual of the density that the implicit pressure of `dfsph` may have, as a part of the rest density.
    /// The mean over each group of 64 particles in the order of the cells may be five times as large.
    pub tolerance: f32,
    /// Largest number of iterations of the implicit pressure in a step. `None`: a quarter of the spacings along the longest
    /// side of the domain, at least 40 and at most 400.
    pub max_iterations: Option<u32>,
}

impl Solver {
    /// Support radius in m for this particle spacing (m).
    pub fn support_radius(&self, particle_spacing: f32) -> f32 {
        self.support_ratio * particle_spacing
    }

    /// The smallest default of `max_iterations`, and the default from which that of the implicit viscosity follows.
    pub(crate) const USUAL_ITERATIONS: u32 = 40;

    /// The default support ratio.
    pub const NARROW_SUPPORT: f32 = 2.0;

    /// The support ratio of `accuracy = "engineering"`, and the smallest for the continuum surface force.
    pub const WIDE_SUPPORT: f32 = 3.0;

    /// The contact angle in degrees of sides that neither attract nor repel the fluid, the default.
    pub const NEUTRAL_ANGLE: f32 = 90.0;

    /// The defaults of a method and a computation of the density.
    pub fn with(method: Method, density: DensityMode) -> Self {
        // The continuity form damps impacts by a limited dissipation. The explicit steps of `wcsph` are at most half of the
        // longest stable one, 1.72 (kernel/tests.rs).
        let (negative_pressure, artificial_viscosity, cfl_factor) = match (method, density) {
            (Method::Dfsph, _) => (NegativePressure::Clamp, 0.01, 0.7),
            (Method::Mueller2003, _) => (NegativePressure::Clamp, 0.05, 0.3),
            (Method::Wcsph, DensityMode::Summation) => (NegativePressure::Clamp, 0.05, 0.7),
            (Method::Wcsph, DensityMode::Continuity) => (NegativePressure::Keep, 0.0, 0.8),
        };
        Self {
            method,
            kernel: Self::usual_kernel(method, Self::NARROW_SUPPORT),
            support_ratio: Self::NARROW_SUPPORT,
            density,
            negative_pressure,
            sound_speed: None,
            stiffness: None,
            exponent: if method == Method::Mueller2003 { 1.0 } else { 7.0 },
            artificial_viscosity,
            density_diffusion: 0.1,
            surface_tension: SurfaceTension::None,
            contact_angle: Self::NEUTRAL_ANGLE,
            wall_friction: 0.0,
            cfl_factor,
            max_dt: if method == Method::Dfsph { 0.05 } else { 0.005 },
            min_dt: 1e-7,
            sort: Sort::Counting,
            tolerance: Self::usual_tolerance(method, SurfaceTension::None),
            max_iterations: None,
        }
    }

    /// Selects another method with its defaults. The support ratio, the friction at walls, `min_dt`, the sort and the use
    /// of surface tension are kept, the contact angle if the new method has one, and the speed of sound unless the method
    /// is `dfsph`.
    pub fn select_method(&mut self, method: Method) {
        if method == self.method {
            return;
        }
        let surface_tension = match (self.surface_tension, method) {
            (SurfaceTension::None, _) => SurfaceTension::None,
            (SurfaceTension::Csf, Method::Wcsph | Method::Dfsph) => SurfaceTension::Csf,
            (_, Method::Wcsph | Method::Dfsph) => SurfaceTension::Akinci2013,
            (_, Method::Mueller2003) => SurfaceTension::ColourField,
        };
        let sound_speed = self.sound_speed.filter(|_| method != Method::Dfsph);
        let Self { support_ratio, wall_friction, min_dt, sort, .. } = *self;
        let standard = Self::with(method, DensityMode::Summation);
        let contact_angle = match surface_tension {
            SurfaceTension::Csf => self.contact_angle,
            _ => Self::NEUTRAL_ANGLE,
        };
        *self = Self {
            kernel: Self::usual_kernel(method, support_ratio),
            support_ratio,
            sound_speed,
            surface_tension,
            contact_angle,
            tolerance: Self::usual_tolerance(method, surface_tension),
            wall_friction,
            min_dt,
            sort,
            ..standard
        };
    }

    /// The default kernel. The blend suits the density that `dfsph` sums within about two spacings. With a wider support
    /// the function for three dimensions resists shear as little, and corrected gradients do not need the blend.
    pub(crate) fn usual_kernel(method: Method, support_ratio: f32) -> KernelKind {
        const WIDEST_BLEND: f32 = 2.05;
        if method == Method::Dfsph && support_ratio <= WIDEST_BLEND {
            KernelKind::WendlandBlend
        } else {
            KernelKind::WendlandC2
        }
    }

    /// The default tolerance. With `csf` it is smaller for `dfsph`: the pressure of a drop is small compared with that of its
    /// impacts.
    pub(crate) fn usual_tolerance(method: Method, surface_tension: SurfaceTension) -> f32 {
        if (method, surface_tension) == (Method::Dfsph, SurfaceTension::Csf) { 1e-4 } else { 0.001 }
    }

    /// Whether negative pressures act on free surfaces, where a summed density is below that at rest because the sum lacks
    /// neighbours. The surface then implodes.
    pub(crate) fn pulls_surfaces_together(&self) -> bool {
        self.method != Method::Dfsph
            && self.density == DensityMode::Summation
            && self.negative_pressure == NegativePressure::Keep
    }

    /// The keys of the scene file that have no effect with `dfsph`.
    pub const NOT_IMPLICIT: [&str; 6] =
        ["density", "negative_pressure", "sound_speed", "stiffness", "exponent", "density_diffusion"];
}

impl Default for Solver {
    /// Those of `dfsph`.
    fn default() -> Self {
        Self::with(Method::Dfsph, DensityMode::Summation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Scene, SceneBuilder};

    type Change = fn(SceneBuilder) -> SceneBuilder;

    #[test]
    fn the_kernel_follows_from_the_method_and_the_support() {
        let built = |change: Change| {
            let pool = Scene::builder("pool", 1.0).domain([0.0; 3], [1.0; 3]).particle_spacing(0.05);
            change(pool.block([0.0; 3], [1.0, 0.5, 1.0])).build().unwrap().solver
        };
        let cases: [(Change, KernelKind); 7] = [
            (|scene| scene, KernelKind::WendlandBlend),
            (|scene| scene.set("solver.support_ratio", 2.05_f32), KernelKind::WendlandBlend),
            (|scene| scene.set("solver.support_ratio", 2.1_f32), KernelKind::WendlandC2),
            (|scene| scene.set("solver.surface_tension", "csf"), KernelKind::WendlandC2),
            (|scene| scene.set("solver.kernel", "wendland_c2"), KernelKind::WendlandC2),
            (|scene| scene.set("solver.method", "wcsph"), KernelKind::WendlandC2),
            (|scene| scene.set("solver.density", "continuity"), KernelKind::WendlandC2),
        ];
        for (number, (change, expected)) in cases.into_iter().enumerate() {
            assert_eq!(built(change).kernel, expected, "case {number}");
        }
        let mut solver = built(|scene| scene);
        solver.select_method(Method::Wcsph);
        assert_eq!(solver.kernel, KernelKind::WendlandC2);
        solver.select_method(Method::Dfsph);
        assert_eq!(solver.kernel, KernelKind::WendlandBlend);
    }
}
