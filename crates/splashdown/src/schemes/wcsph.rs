//! Weakly compressible SPH (Monaghan 1994; Becker & Teschner 2007; delta-SPH: Molteni & Colagrossi 2009).

use super::Step;
use crate::boundary::part::Part;
use crate::coupling::Stage;

/// gamma of Akinci's surface tension for one N/m, times rho0^2 H^2. By `tests/physics/drop.rs` the period
/// of a drop with a radius of five spacings corresponds to 1.8 times the surface tension of the material. Akinci's model is
/// made for pictures, not for measurement (Akinci, Akinci & Teschner 2013).
pub(super) const AKINCI_PER_SIGMA: f32 = 100.0;

/// One step: sort, density and pressure, forces, integration.
pub(super) fn wcsph(step: &mut Step<'_>) {
    step.sort();
    step.couple(Stage::BoundaryLookup);
    step.density_and_pressure();
    step.couple(Stage::BoundaryDensity);
    if step.is_fused() {
        return step.force_integrate();
    }
    step.surface_normals();
    step.acceleration(Part::All);
    step.tension_force();
    step.couple(Stage::BoundaryForces(Part::All));
    step.couple(Stage::BodyMotion);
    step.couple(Stage::ExternalForces);
    step.integrate();
    step.couple(Stage::Measurement);
    step.couple(Stage::Emission);
    step.count_emitted();
}
