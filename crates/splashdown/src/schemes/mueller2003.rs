//! The scheme of Müller, Charypar & Gross 2003, which the thesis uses.

use super::Step;
use crate::boundary::part::Part;
use crate::coupling::Stage;

/// Viscosity that this scheme adds to the material's, over c0 H. Its density (poly6) and its pressure (spiky) do not
/// derive from one energy, so without friction it gains energy: water in a tank moves at 0.5 sqrt(g depth). The thesis
/// and its successors set a large viscosity by hand; this value reduces the motion in a tank to less than 1 % after two
/// seconds.
pub(super) const ADDED_VISCOSITY: f32 = 0.015;

/// One step: sort, density (poly6) and pressure, force densities (spiky and viscosity kernels), integration.
pub(super) fn mueller2003(step: &mut Step<'_>) {
    step.sort();
    step.couple(Stage::BoundaryLookup);
    step.density_and_pressure();
    step.couple(Stage::BoundaryDensity);
    step.acceleration(Part::All);
    step.couple(Stage::BoundaryForces(Part::All));
    step.couple(Stage::BodyMotion);
    step.couple(Stage::ExternalForces);
    step.integrate();
    step.couple(Stage::Measurement);
    step.couple(Stage::Emission);
    step.count_emitted();
}
