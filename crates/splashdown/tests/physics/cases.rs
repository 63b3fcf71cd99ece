//! Cases as data: each has a name, the variants that are compared side by side, and up to three resolutions.

use std::env;
use std::sync::OnceLock;

use splashdown::Device;
use splashdown_gpu::Executor;

use super::figures::Figures;

/// A comparison with a theory, a measurement or a conservation law.
pub struct Case {
    pub name: &'static str,
    /// The length whose number of spacings is the resolution.
    pub across: &'static str,
    /// The resolutions: small, middle and full.
    pub sizes: &'static [u32],
    pub variants: &'static [Variant],
}

/// A solver, or another property of a run, of which the page shows one column.
pub struct Variant {
    pub name: &'static str,
    /// Its keys of the section `[solver]`, if the case needs no others.
    pub keys: &'static str,
    /// False if only `cargo xtask validate` runs it, because it takes long or has no gate.
    pub in_tests: bool,
}

impl Variant {
    pub const fn new(name: &'static str, keys: &'static str) -> Self {
        Self { name, keys, in_tests: true }
    }

    /// A variant that the tests leave out.
    pub const fn extra(name: &'static str, keys: &'static str) -> Self {
        Self { name, keys, in_tests: false }
    }
}

/// The column of runs with a deliberate error.
pub const CONTROL: Variant = Variant::new("control", "");

/// How many resolutions run: one in the tests, two with `SPLASHDOWN_FULL=quick`, otherwise all.
fn levels() -> usize {
    match env::var("SPLASHDOWN_FULL") {
        Err(_) => 1,
        Ok(word) if word == "quick" => 2,
        Ok(_) => 3,
    }
}

/// True if `cargo xtask validate` runs the case.
pub fn is_validation() -> bool {
    levels() > 1
}

/// An executor on the device `SPLASHDOWN_DEVICE`, such as `gpu` or a part of an adapter's name, or on the CPU.
pub fn executor() -> Executor {
    let device: Device = env::var("SPLASHDOWN_DEVICE").map_or(Device::Cpu, |name| name.parse().unwrap());
    device.executor().unwrap_or_else(|error| panic!("SPLASHDOWN_DEVICE={device}: {error}"))
}

/// The name of that device.
pub fn executor_name() -> &'static str {
    static NAME: OnceLock<String> = OnceLock::new();
    NAME.get_or_init(|| executor().gpu().map_or_else(|| "CPU".to_owned(), |gpu| gpu.name()))
}

impl Case {
    /// The resolutions of this run, from coarse to fine: those of `SPLASHDOWN_ACROSS`, such as `60,92`, if it is set.
    fn sizes(&self) -> Vec<u32> {
        match env::var("SPLASHDOWN_ACROSS") {
            Ok(list) => list
                .split(',')
                .map(|number| number.parse().unwrap_or_else(|_| panic!("SPLASHDOWN_ACROSS: {number}")))
                .collect(),
            Err(_) => self.sizes[..levels().min(self.sizes.len())].to_vec(),
        }
    }

    /// Runs every variant except the controls at every resolution, and fails after the last of them if a gate is missed.
    /// `SPLASHDOWN_VARIANT` selects one variant.
    pub fn run(&'static self, mut body: impl FnMut(&'static Variant, u32, &mut Figures)) {
        let mut problems = Vec::new();
        for across in self.sizes() {
            for variant in self.variants.iter().filter(|variant| variant.name != CONTROL.name) {
                let is_selected = env::var("SPLASHDOWN_VARIANT").map_or(true, |name| name == variant.name);
                if is_selected && (variant.in_tests || is_validation()) {
                    let mut figures = Figures::new(self, variant.name, across);
                    body(variant, across, &mut figures);
                    problems.extend(figures.finish().err());
                }
            }
        }
        assert!(problems.is_empty(), "{}", problems.join("\n"));
    }
}
