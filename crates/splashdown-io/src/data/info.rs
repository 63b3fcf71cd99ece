//! What a particle file says about all of its particles.

use std::ops::RangeInclusive;

/// Spacings that are credible, in m. Others are not written, and ignored when they are read.
const SPACINGS: RangeInclusive<f64> = 1e-12..=1e12;

/// Name of the time in PLY, BGEO and NPZ files.
pub(crate) const TIME: &str = "time";

/// Name of the time in VTK, VTU and VTP files, from which VTK takes the time of a file.
const TIME_VALUE: &str = "TimeValue";

/// Name of the particle spacing.
pub(crate) const PARTICLE_SPACING: &str = "particle_spacing";

/// Time and resolution of a set of particles, where they are known. All particle files that are written contain them.
///
/// A time that is not finite, and a spacing outside 1e-12 to 1e12 m, are not written and are ignored when they are read.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct ParticleInfo {
    /// Simulated time in s.
    pub time: Option<f64>,
    /// Initial distance of neighbouring particles in m.
    pub particle_spacing: Option<f32>,
}

impl ParticleInfo {
    /// The time in s and the particle spacing in m.
    #[must_use]
    pub fn new(time: f64, particle_spacing: f32) -> Self {
        Self { time: Some(time), particle_spacing: Some(particle_spacing) }
    }

    /// Without values that are not credible.
    pub(crate) fn credible(self) -> Self {
        Self {
            time: self.time.filter(|time| time.is_finite()),
            particle_spacing: self.particle_spacing.filter(|&spacing| SPACINGS.contains(&spacing.into())),
        }
    }

    /// Names and values for the field data of VTK's formats; the spacing has the same decimals in double precision.
    pub(crate) fn fields(self) -> Vec<(&'static str, f64)> {
        let Self { time, particle_spacing } = self.credible();
        let spacing = particle_spacing.and_then(|spacing| spacing.to_string().parse().ok());
        let fields = [(TIME_VALUE, time), (PARTICLE_SPACING, spacing)];
        fields.into_iter().filter_map(|(name, value)| Some((name, value?))).collect()
    }

    /// Whether a file's value of this name has a field.
    pub(crate) fn has(name: &str) -> bool {
        matches!(name, TIME | TIME_VALUE | PARTICLE_SPACING)
    }

    /// Takes a value of a file, if its name has a field and it is credible.
    pub(crate) fn set(&mut self, name: &str, value: f64) {
        let mut given = *self;
        match name {
            TIME | TIME_VALUE => given.time = Some(value),
            PARTICLE_SPACING => given.particle_spacing = Some(value as f32),
            _ => {}
        }
        let given = given.credible();
        self.time = given.time.or(self.time);
        self.particle_spacing = given.particle_spacing.or(self.particle_spacing);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_are_not_credible_are_ignored() {
        let good = ParticleInfo::new(0.5, 0.02);
        assert_eq!(good.credible(), good);
        for bad in [f32::NAN, f32::INFINITY, -0.02, 0.0, 1e-13, 1e13] {
            let wrong = ParticleInfo::new(f64::NAN, bad);
            assert_eq!(wrong.credible(), ParticleInfo::default(), "{bad}");
            let mut read = good;
            read.set(PARTICLE_SPACING, bad.into());
            read.set(TIME, f64::INFINITY);
            assert_eq!(read, good, "{bad}");
        }
        let mut read = ParticleInfo::default();
        read.set("particle_spacing", 1e300);
        read.set("spacing", 0.1);
        assert_eq!(read, ParticleInfo::default(), "the spacing overflows, and the other name is not known");
        read.set("TimeValue", 0.5);
        read.set("particle_spacing", 0.02_f32.into());
        assert_eq!(read, good);
    }
}
