//! Keys of `[solver]`, `[surface]` and `[foam]`: how things are computed.

use crate::scene::spec::{Kind, Table, a_number, key, range, words};
use crate::scene::types::{DensityMode, KernelKind, Method, NegativePressure, Sort, SurfaceTension};

pub(super) static SOLVER: Table = Table {
    about: "How the fluid is computed.",
    keys: &[
        key("method", Kind::Word(words::<Method>), "The method.")
            .default("\"wcsph\"")
            .also(&["type", "name"]),
        key("kernel", Kind::Word(words::<KernelKind>), "The kernel of wcsph.").default("\"wendland_c2\""),
        key(
            "support_ratio",
            a_number(1.5, 4.0, ""),
            "Support radius of the kernel over the particle spacing.",
        )
        .default("2.0")
        .also(&["support_radius", "smoothing_length", "h"]),
        key(
            "density",
            Kind::Word(words::<DensityMode>),
            "How the density is found; continuity is for wcsph.",
        )
        .default("\"summation\""),
        key(
            "negative_pressure",
            Kind::Word(words::<NegativePressure>),
            "What happens to pressures below zero. Default: clamp with summation, keep with continuity.",
        ),
        key(
            "sound_speed",
            a_number(1e-3, 10_000.0, "m/s"),
            "Speed of sound. Default: ten times the largest speed to expect.",
        )
        .also(&["c0", "c", "speed_of_sound"]),
        key(
            "stiffness",
            a_number(1e-6, 1e12, ""),
            "Instead of sound_speed: Tait's constant in Pa (wcsph) or k in m^2/s^2 (mueller2003).",
        )
        .also(&["k"]),
        key(
            "exponent",
            a_number(1.0, 10.0, ""),
            "Exponent of the equation of state. Default: 7 for wcsph, 1 for mueller2003.",
        )
        .also(&["gamma"]),
        key("artificial_viscosity", a_number(0.0, 2.0, ""), "Monaghan's factor alpha; wcsph.")
            .default("0.05")
            .also(&["alpha"]),
        key("density_diffusion", a_number(0.0, 1.0, ""), "The factor delta of delta-SPH; with continuity.")
            .default("0.1")
            .also(&["delta"]),
        key(
            "surface_tension",
            Kind::Word(words::<SurfaceTension>),
            "The model of surface tension: akinci2013 for wcsph, mueller2003 for mueller2003.",
        )
        .default("\"none\""),
        key("wall_friction", a_number(0.0, 1.0, ""), "0: the fluid slips along walls; 1: it sticks.")
            .default("0.0"),
        key(
            "cfl_factor",
            a_number(0.01, 1.0, ""),
            "Time step as a part of half the support radius over the speed of sound.",
        )
        .default("0.3")
        .also(&["cfl", "courant"]),
        key("max_dt", a_number(1e-9, 1.0, "s"), "Longest time step.").default("0.005").also(&[
            "dt",
            "time_step",
            "timestep",
        ]),
        key("min_dt", a_number(1e-12, 1.0, "s"), "Shortest time step.").default("1e-7"),
        key("sort", Kind::Word(words::<Sort>), "How particles are sorted into cells.")
            .default("\"counting\""),
    ],
};

pub(super) static SURFACE: Table = Table {
    about: "How the fluid's surface is extracted.",
    keys: &[
        key("enabled", Kind::Boolean, "Whether it is extracted.").default("true"),
        key(
            "cell_size",
            a_number(1e-6, 10.0, "m"),
            "Edge of a marching-cubes cell. Default: half the particle spacing.",
        )
        .also(&["resolution", "cube_size"]),
        key("iso_level", a_number(0.05, 0.95, ""), "Where the surface lies, as a part of the inner density.")
            .default("0.6")
            .also(&["threshold", "iso", "isovalue"]),
        key("smoothing_iterations", Kind::Integer(range(0.0, 100.0, "")), "Rounds of smoothing.")
            .default("5")
            .also(&["smoothing"]),
        key(
            "support_ratio",
            a_number(1.0, 6.0, ""),
            "Support radius of the field over the particle spacing.",
        )
        .default("2.0"),
    ],
};

pub(super) static FOAM: Table = Table {
    about: "Whether a splash makes foam, spray and bubbles, and how much (Ihmsen et al. 2012). For looks; the water does not feel them.",
    keys: &[
        key("enabled", Kind::Boolean, "Whether it does.").default("false"),
        key(
            "trapped_air",
            a_number(0.0, 1e5, "1/s"),
            "Particles of foam per second from each particle of water that traps as much air as it can: where water meets water.",
        )
        .default("200.0")
        .also(&["k_ta", "air"]),
        key(
            "wave_crest",
            a_number(0.0, 1e5, "1/s"),
            "Particles of foam per second from each particle of a breaking wave's crest.",
        )
        .default("1000.0")
        .also(&["k_wc", "crest"]),
        key(
            "trapped_air_limits",
            Kind::Numbers(2, range(0.0, 10.0, "")),
            "Speed at which water meets water, over the scene's reference speed: none below the first, all above the second.",
        )
        .default("[0.07, 0.25]"),
        key(
            "wave_crest_limits",
            Kind::Numbers(2, range(0.0, 10.0, "")),
            "Curvature of crests: none below the first, all above the second.",
        )
        .default("[0.1, 0.5]"),
        key(
            "speed_limits",
            Kind::Numbers(2, range(0.0, 10.0, "")),
            "Speed of the water over the scene's reference speed: no foam below the first, all above the second.",
        )
        .default("[0.2, 0.7]")
        .also(&["energy_limits"]),
        key(
            "lifetime",
            Kind::Numbers(2, range(0.0, 3600.0, "s")),
            "Shortest and longest time until foam on the surface has dissolved.",
        )
        .default("[2.0, 5.0]"),
        key("buoyancy", a_number(0.0, 100.0, ""), "Lift of bubbles in multiples of gravity.").default("2.0"),
        key(
            "drag",
            a_number(1.0, 1e5, "1/s"),
            "How quickly bubbles take the water's velocity; they rise at buoyancy times gravity over it.",
        )
        .default("80.0"),
        key(
            "max_particles",
            Kind::Integer(range(1.0, 1e9, "")),
            "Most particles of foam, spray and bubbles. Default: four per particle of water, four million at most.",
        )
        .also(&["limit", "max", "count"]),
    ],
};
