//! The gates of all figures, from the file `gates.toml`, which is committed before a case runs for the first time.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

/// The limit of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Limit {
    AtMost(f64),
    Within(f64, f64),
    /// The figure of a wrong input must exceed this value; otherwise the comparison detects nothing.
    Above(f64),
}

impl Limit {
    pub fn holds(&self, measured: f64) -> bool {
        match *self {
            Self::AtMost(limit) => measured <= limit,
            Self::Within(low, high) => (low..=high).contains(&measured),
            Self::Above(limit) => measured > limit,
        }
    }

    /// How far a figure is beyond the limit; negative if the limit holds.
    pub fn excess(&self, measured: f64) -> f64 {
        match *self {
            Self::AtMost(limit) => measured - limit,
            Self::Within(low, high) => (low - measured).max(measured - high),
            Self::Above(limit) => limit - measured,
        }
    }

    /// The size of the limit, with which an excess is compared: half the width of a range.
    pub fn scale(&self) -> f64 {
        match *self {
            Self::AtMost(limit) | Self::Above(limit) => limit.abs(),
            Self::Within(low, high) => 0.5 * (high - low),
        }
    }

    pub fn words(&self) -> String {
        match self {
            Self::AtMost(limit) => format!("<= {limit}"),
            Self::Within(low, high) => format!("{low} to {high}"),
            Self::Above(limit) => format!("control > {limit}"),
        }
    }
}

/// A gate as the file contains it, with one of three limits.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    #[serde(default)]
    variants: Vec<String>,
    #[serde(default)]
    across: Vec<u32>,
    #[serde(default)]
    except: Vec<u32>,
    at_most: Option<f64>,
    within: Option<[f64; 2]>,
    above: Option<f64>,
    first: Option<Limit>,
    reason: Option<String>,
    missed: Option<String>,
}

impl TryFrom<Entry> for Gate {
    type Error = &'static str;

    fn try_from(entry: Entry) -> Result<Self, Self::Error> {
        let limit = match (entry.at_most, entry.within, entry.above) {
            (Some(limit), None, None) => Limit::AtMost(limit),
            (None, Some([low, high]), None) if low <= high => Limit::Within(low, high),
            (None, None, Some(limit)) => Limit::Above(limit),
            _ => return Err("a gate has one of `at_most`, `within = [low, high]` and `above`"),
        };
        let Entry { variants, across, except, first, reason, missed, .. } = entry;
        Ok(Self { variants, across, except, limit, first, reason, missed })
    }
}

#[derive(Debug, Deserialize)]
#[serde(try_from = "Entry")]
pub struct Gate {
    /// The variants and resolutions it applies to; all if there are none.
    variants: Vec<String>,
    across: Vec<u32>,
    /// Resolutions it does not apply to.
    except: Vec<u32>,
    pub limit: Limit,
    /// The limit before the first run, if it was changed since.
    first: Option<Limit>,
    /// Why the limit was changed.
    pub reason: Option<String>,
    /// The measured figure that misses the gate, and why. The test fails as soon as the gate is met.
    pub missed: Option<String>,
}

impl Gate {
    pub fn applies(&self, variant: &str, across: u32) -> bool {
        (self.variants.is_empty() || self.variants.iter().any(|name| name == variant))
            && (self.across.is_empty() || self.across.contains(&across))
            && !self.except.contains(&across)
    }
}

type Cases = BTreeMap<String, BTreeMap<String, Vec<Gate>>>;

static GATES: LazyLock<Cases> =
    LazyLock::new(|| toml::from_str(include_str!("gates.toml")).unwrap_or_else(|error| panic!("{error}")));

/// The gates of a figure at all resolutions; none if the file does not contain it.
pub fn of(case: &str, figure: &str) -> Option<&'static [Gate]> {
    Some(GATES.get(case)?.get(figure)?)
}

/// The figures of a case that have a gate in this variant and resolution.
pub fn required(case: &str, variant: &str, across: u32) -> Vec<&'static str> {
    let figures = GATES.get(case).into_iter().flatten();
    let applies = |gates: &[Gate]| gates.iter().any(|gate| gate.applies(variant, across));
    figures.filter(|(_, gates)| applies(gates)).map(|(figure, _)| figure.as_str()).collect()
}

#[test]
fn every_changed_gate_has_a_reason() {
    for (case, figures) in &*GATES {
        for (figure, gate) in figures.iter().flat_map(|(name, gates)| gates.iter().map(move |g| (name, g))) {
            let place = format!("{case}: {figure}: {gate:?}");
            assert_eq!(gate.first.is_some(), gate.reason.is_some(), "{place}");
            assert_ne!(gate.first, Some(gate.limit), "{place}");
            for text in [&gate.reason, &gate.missed].into_iter().flatten() {
                assert!(text.len() > 20, "too short for a reason: {place}");
            }
        }
    }
    // Control: the angular momentum of the continuity form has a changed gate.
    let gates = of("angular momentum", "change over its size in 1000 steps").unwrap();
    assert!(gates.iter().any(|gate| gate.first == Some(Limit::AtMost(1e-4))));
}

#[test]
fn every_gate_belongs_to_a_case() {
    for (case, figures) in &*GATES {
        let known = super::CASES.iter().copied().flatten().find(|known| known.name == case);
        let known = known.unwrap_or_else(|| panic!("gates.toml: no case {case:?}"));
        for gate in figures.values().flatten() {
            for variant in &gate.variants {
                assert!(known.variants.iter().any(|v| v.name == variant), "{case}: no variant {variant:?}");
            }
            for across in gate.across.iter().chain(&gate.except) {
                assert!(known.sizes.contains(across), "{case}: no resolution {across}");
            }
        }
    }
}

/// Gates of one figure that apply to the same run would hide each other.
#[test]
fn at_most_one_gate_applies_to_a_run() {
    for case in super::CASES.iter().copied().flatten() {
        for (figure, gates) in GATES.get(case.name).into_iter().flatten() {
            for (variant, &across) in
                case.variants.iter().flat_map(|v| case.sizes.iter().map(move |a| (v, a)))
            {
                let count = gates.iter().filter(|gate| gate.applies(variant.name, across)).count();
                assert!(count <= 1, "{}: {figure}: {} at {across}: {count} gates", case.name, variant.name);
            }
        }
    }
}
