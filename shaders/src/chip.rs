//! The chips for which the passes are compiled, and a model of their time.

use serde::{Deserialize, Serialize};
use splashdown_gpu::{PassDesc, Shape};

use crate::program::Program;

/// A chip that Mesa's AMD driver compiles for.
#[derive(Clone, Copy, Debug)]
pub struct Chip {
    /// The name in `RADV_FORCE_FAMILY`.
    pub family: &'static str,
    /// A product with this chip.
    pub product: &'static str,
    /// Instructions of one lane per second: 64 lanes per compute unit, one instruction per clock, from the data sheet.
    pub lanes: f64,
    /// Bytes per second of its memory, from the data sheet.
    pub bandwidth: f64,
}

/// The chips: generations RDNA 2, RDNA 3 and GCN 5.
pub const CHIPS: [Chip; 3] = [
    Chip { family: "navi21", product: "RX 6800 XT", lanes: 72.0 * 64.0 * 2.25e9, bandwidth: 512e9 },
    Chip { family: "gfx1100", product: "RX 7900 XTX", lanes: 96.0 * 64.0 * 2.5e9, bandwidth: 960e9 },
    Chip { family: "vega10", product: "RX Vega 64", lanes: 64.0 * 64.0 * 1.546e9, bandwidth: 484e9 },
];

/// A product that has been measured. Its own compiler counts no instructions, so those of a chip of [`CHIPS`] stand for them.
pub const MEASURED: Chip =
    Chip { family: "gfx1100", product: "NVIDIA H200", lanes: 132.0 * 128.0 * 1.98e9, bandwidth: 4.8e12 };
/// Its measured milliseconds of a step, from `docs/performance.md`, for the sizes of the page.
pub const MEASURED_STEP: [f64; 3] = [0.110, 0.707, 5.62];

/// Candidates that a warp tests for each particle, at a support radius of two spacings.
const CANDIDATES: f64 = 170.0;
/// Rows of cells.
const ROWS: f64 = 9.0;
/// Seconds between two dispatches that wait for one another.
const DISPATCH: f64 = 4e-6;

/// What the compiler made of a pass.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Compiled {
    /// The label of the pass.
    pub label: String,
    /// Vector registers.
    pub vgprs: u64,
    /// Scalar registers.
    pub sgprs: u64,
    /// Spilled registers, vector and scalar.
    pub spills: u64,
    /// Bytes of memory on the stack per invocation.
    pub scratch: u64,
    /// Waves per SIMD.
    pub waves: u64,
    /// Instructions.
    pub instructions: u64,
    /// Instructions by loop.
    pub program: Program,
}

impl Compiled {
    /// Instructions of one invocation, whose longest inner loop tests this many candidates per round.
    pub fn executed(&self, candidates_per_round: f64) -> f64 {
        let Program { straight, outer, inner } = self.program;
        let rounds = CANDIDATES / candidates_per_round;
        f64::from(straight) + ROWS * f64::from(outer) + rounds * f64::from(inner)
    }
}

/// Bytes per particle that a pass reads or writes if each element is transferred once.
pub fn bytes(pass: &PassDesc) -> f64 {
    let arrays = pass.bindings.iter().filter(|binding| matches!(binding.shape, Shape::Array));
    arrays.map(|binding| binding.size as f64).sum()
}

/// The candidates that a round of the loop over neighbours tests.
fn candidates_per_round(pass: &PassDesc) -> f64 {
    if pass.imports.iter().any(|module| module.name == "sph/candidates") {
        8.0
    } else if pass.wgsl.contains("j += 4u") {
        4.0
    } else {
        1.0
    }
}

impl Chip {
    /// The predicted seconds of a pass for this number of particles.
    pub fn seconds(&self, pass: &PassDesc, compiled: &Compiled, particles: f64) -> f64 {
        let issue = particles * compiled.executed(candidates_per_round(pass)) / self.lanes;
        let memory = particles * bytes(pass) / self.bandwidth;
        DISPATCH + issue.max(memory)
    }
}
