//! Keys of `[solver]`, `[surface]` and `[foam]`.

use crate::scene::solver::{
    Accuracy, DensityMode, KernelKind, Method, NegativePressure, Sort, SurfaceTension,
};
use crate::scene::spec::{Kind, Table, a_number, key, range, words};
use crate::scene::types::SurfaceKernels;

pub(super) static SOLVER: Table = Table {
    about: "Solver and its parameters.",
    keys: &[
        key(
            "method",
            Kind::Word(words::<Method>),
            "SPH method. Default: dfsph; wcsph if a key of this section has no effect with dfsph, such as density, or with accuracy = \"engineering\".",
        )
        .also(&["type", "name", "scheme", "solver"]),
        key("accuracy", Kind::Word(words::<Accuracy>), "Purpose; determines defaults of other keys of this section.")
            .default("\"standard\""),
        key("kernel", Kind::Word(words::<KernelKind>), "Kernel of wcsph and dfsph. Default: wendland_c2; wendland_blend with dfsph and a support_ratio of up to 2.05."),
        key(
            "support_ratio",
            a_number(1.5, 4.0, ""),
            "Support radius of the kernel divided by the particle spacing. Default: 2; 3 with accuracy = \"engineering\" or surface_tension = \"csf\".",
        )
        .also(&["support_radius", "smoothing_length", "h"]),
        key(
            "density",
            Kind::Word(words::<DensityMode>),
            "Computation of the density; continuity requires wcsph. Default: summation; continuity with accuracy = \"engineering\".",
        ),
        key(
            "negative_pressure",
            Kind::Word(words::<NegativePressure>),
            "Treatment of negative pressures. Default: clamp with summation, keep with continuity.",
        ),
        key(
            "sound_speed",
            a_number(1e-3, 10_000.0, "m/s"),
            "Speed of sound. Default: ten times the largest expected speed.",
        )
        .also(&["c0", "c", "speed_of_sound"]),
        key(
            "stiffness",
            a_number(1e-6, 1e12, ""),
            "Alternative to sound_speed: Tait's constant in Pa (wcsph) or k in m^2/s^2 (mueller2003).",
        )
        .also(&["k"]),
        key(
            "exponent",
            a_number(1.0, 10.0, ""),
            "Exponent of the equation of state. Default: 7 for wcsph, 1 for mueller2003.",
        )
        .also(&["gamma"]),
        key(
            "artificial_viscosity",
            a_number(0.0, 2.0, ""),
            "Factor alpha of Monaghan's artificial viscosity; wcsph and dfsph. Default: 0.05 with summation, 0 with continuity, which damps impacts by other means; 0.01 with dfsph.",
        )
        .also(&["alpha"]),
        key("density_diffusion", a_number(0.0, 1.0, ""), "Factor delta of delta-SPH; requires continuity.")
            .default("0.1")
            .also(&["delta"]),
        key("surface_tension", Kind::Word(words::<SurfaceTension>), "Model of surface tension.")
            .default("\"none\""),
        key(
            "contact_angle",
            a_number(90.0, 179.0, "degrees"),
            "Angle between the surface and the closed sides of the domain, measured within the fluid: above 90 the sides repel the fluid. Requires surface_tension = \"csf\".",
        )
        .default("90.0")
        .also(&["wetting_angle", "wetting"]),
        key("wall_friction", a_number(0.0, 1.0, ""), "0: the fluid slips along walls; 1: it sticks.")
            .default("0.0"),
        key(
            "cfl_factor",
            a_number(0.01, 1.0, ""),
            "Time step divided by the time in which sound travels half the support radius; with dfsph, the largest distance in spacings that a particle moves per step. Default: 0.7; 0.8 with continuity, 0.3 with mueller2003.",
        )
        .also(&["cfl", "courant"]),
        key("max_dt", a_number(1e-9, 1.0, "s"), "Maximum time step. Default: 0.005 s; 0.05 s with dfsph.").also(&[
            "dt",
            "time_step",
            "timestep",
        ]),
        key("min_dt", a_number(1e-12, 1.0, "s"), "Minimum time step.").default("1e-7"),
        key(
            "tolerance",
            a_number(1e-5, 0.01, ""),
            "Mean residual of the density, as a part of the rest density, at which the pressure iterations of dfsph stop; the mean over 64 neighbouring particles may be five times as large. The iterations of an implicit viscosity stop at a residual of ten times this part of the change of the velocity by all other forces. Default: 0.001; 0.0001 with surface_tension = \"csf\".",
        )
        .also(&["max_error", "maxError"]),
        key(
            "max_iterations",
            Kind::Integer(range(2.0, 1000.0, "")),
            "Largest number of pressure iterations per step; dfsph. Default: a quarter of the spacings along the longest side of the domain, at least 40 and at most 400. An implicit viscosity takes at most five times as many, 200 by default.",
        )
        .also(&["maxIterations", "iterations"]),
        key("sort", Kind::Word(words::<Sort>), "Algorithm that sorts particles into cells.")
            .default("\"counting\""),
    ],
};

pub(super) static SURFACE: Table = Table {
    about: "Surface reconstruction.",
    keys: &[
        key("enabled", Kind::Boolean, "Whether the surface is reconstructed.").default("true"),
        key(
            "kernels",
            Kind::Word(words::<SurfaceKernels>),
            "Shape of the particles' kernels: balls, or ellipsoids that follow the arrangement of the neighbours.",
        )
        .default("\"isotropic\"")
        .also(&["kernel"]),
        key(
            "cell_size",
            a_number(1e-6, 10.0, "m"),
            "Edge of a marching-cubes cell. Default: half the particle spacing.",
        )
        .also(&["resolution", "cube_size"]),
        key(
            "iso_level",
            a_number(0.05, 0.95, ""),
            "Value of the field at the surface; the field is about 1 inside the fluid.",
        )
        .default("0.6")
        .also(&["threshold", "iso", "isovalue"]),
        key("smoothing_iterations", Kind::Integer(range(0.0, 100.0, "")), "Iterations of smoothing.")
            .default("5")
            .also(&["smoothing"]),
        key(
            "min_blob",
            Kind::Integer(range(0.0, 32.0, "")),
            "Particles in blobs of fewer than this many leave the surface and become droplets; 0: none.",
        )
        .default("9")
        .also(&["min_component", "min_component_size"]),
        key(
            "min_neighbours",
            Kind::Integer(range(0.0, 32.0, "")),
            "Particles with fewer others within 0.9 support radii of the field leave the surface and become droplets; 0: none.",
        )
        .default("3")
        .also(&["min_neighbors"]),
        key(
            "support_ratio",
            a_number(1.0, 6.0, ""),
            "Support radius of the field divided by the particle spacing.",
        )
        .default("2.0"),
        key(
            "caps",
            Kind::Boolean,
            "Whether the meshes that are written contain the surfaces of the liquid at the walls; false for pictures with another model of the tank.",
        )
        .default("true"),
    ],
};

pub(super) static FOAM: Table = Table {
    about: "Foam, spray and bubbles (Ihmsen et al. 2012). They follow the fluid and do not act on it.",
    keys: &[
        key("enabled", Kind::Boolean, "Whether diffuse particles are created.").default("false"),
        key(
            "trapped_air",
            a_number(0.0, 1e5, "1/s"),
            "Diffuse particles per second and fluid particle at full trapped-air potential (colliding fluid).",
        )
        .default("200.0")
        .also(&["k_ta", "air"]),
        key(
            "wave_crest",
            a_number(0.0, 1e5, "1/s"),
            "Diffuse particles per second and fluid particle at full wave-crest potential (breaking waves).",
        )
        .default("1000.0")
        .also(&["k_wc", "crest"]),
        key(
            "trapped_air_limits",
            Kind::Numbers(2, range(0.0, 10.0, "")),
            "Relative speed of colliding fluid, divided by the reference speed, at which the trapped-air potential is 0 and 1.",
        )
        .default("[0.07, 0.25]"),
        key(
            "wave_crest_limits",
            Kind::Numbers(2, range(0.0, 10.0, "")),
            "Curvature at which the wave-crest potential is 0 and 1.",
        )
        .default("[0.1, 0.5]"),
        key(
            "speed_limits",
            Kind::Numbers(2, range(0.0, 10.0, "")),
            "Speed of the fluid, divided by the reference speed, below which no diffuse particles and above which all are created.",
        )
        .default("[0.2, 0.7]")
        .also(&["energy_limits"]),
        key(
            "lifetime",
            Kind::Numbers(2, range(0.0, 3600.0, "s")),
            "Minimum and maximum lifetime of foam at the surface.",
        )
        .default("[2.0, 5.0]"),
        key("buoyancy", a_number(0.0, 100.0, ""), "Buoyancy of bubbles as a multiple of gravity.").default("2.0"),
        key(
            "drag",
            a_number(1.0, 1e5, "1/s"),
            "Rate at which bubbles adopt the fluid's velocity; they rise at buoyancy * gravity / drag.",
        )
        .default("80.0"),
        key(
            "max_particles",
            Kind::Integer(range(1.0, 1e9, "")),
            "Maximum number of diffuse particles. Default: four per fluid particle, at most four million.",
        )
        .also(&["limit", "max", "count"]),
    ],
};
