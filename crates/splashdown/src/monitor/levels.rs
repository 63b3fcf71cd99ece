//! What the monitor watches, and the levels of each quantity.

use serde::{Deserialize, Serialize};

/// How implausible a value is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// As expected.
    #[default]
    Sound,
    /// Unusual; the results may be inaccurate.
    Note,
    /// Implausible in places.
    Warning,
    /// The fluid has burst; further results are meaningless.
    Stop,
}

/// A quantity that the monitor watches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Watched {
    /// The largest speed over the speed that energy allows.
    Speed,
    /// The speed that one particle in a hundred exceeds, over the speed that energy allows.
    FastPart,
    /// Energy created without a source, over the energy available.
    EnergyGain,
    /// The largest relative excess of the solver's density in a step.
    Compression,
    /// The relative excess of density that one particle in a hundred has, by positions.
    DensePart,
    /// The relative deficit of density that one particle in a hundred of the inner ones has, by positions.
    ThinPart,
    /// Particles moved back from behind walls or out of bodies since the last frame.
    WallCorrections,
    /// Particles inside bodies.
    InsideBodies,
    /// Particles that became NaN or infinite.
    NonFinite,
    /// Velocities limited to the largest motion per step since the last frame.
    SpeedLimits,
}

impl Watched {
    /// All of them.
    pub(super) const ALL: [Self; 10] = [
        Self::Speed,
        Self::FastPart,
        Self::EnergyGain,
        Self::Compression,
        Self::DensePart,
        Self::ThinPart,
        Self::WallCorrections,
        Self::InsideBodies,
        Self::NonFinite,
        Self::SpeedLimits,
    ];

    /// The values from which on it is a note, a warning, and a reason to stop, for this number of particles.
    pub(super) fn limits(self, particles: usize) -> [f64; 3] {
        const NEVER: f64 = f64::INFINITY;
        let n = particles as f64;
        match self {
            Self::Speed => [2.0, 2.7, 20.0],
            Self::FastPart => [1.4, 1.65, 5.0],
            Self::EnergyGain => [0.03, 0.08, 1.0],
            Self::Compression => [0.2, 0.3, 3.0],
            Self::DensePart => [0.1, 0.25, 1.5],
            Self::ThinPart => [0.25, NEVER, NEVER],
            Self::WallCorrections => [1.0, 1.0, NEVER],
            Self::InsideBodies => [1.0, 1.0, (0.05 * n).max(20.0)],
            Self::NonFinite => [1.0, 1.0, (0.001 * n).max(10.0)],
            Self::SpeedLimits => [1.0, 1.0, NEVER],
        }
    }

    /// The level of a value.
    pub(super) fn level(self, value: f64, particles: usize) -> Level {
        let [note, warning, stop] = self.limits(particles);
        if value.is_nan() || value >= stop {
            Level::Stop
        } else if value >= warning {
            Level::Warning
        } else if value >= note {
            Level::Note
        } else {
            Level::Sound
        }
    }
}
