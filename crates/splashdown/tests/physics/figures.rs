//! Measured figures and their gates: printed, asserted, and written for the validation page.

use std::path::PathBuf;
use std::time::Instant;

use serde_json::{Value, json};

use super::cases::{Case, executor_name, is_validation};
use super::gates::{self, Gate};
use super::recorded;

/// Points of one curve.
pub type Series = Vec<(f64, f64)>;

/// The largest number of points of a curve on the page.
const POINTS: usize = 120;

struct Row {
    name: String,
    measured: f64,
    /// The figure is zero in the exact solution, so that an order of convergence is defined.
    is_error: bool,
    gate: Option<&'static Gate>,
    /// The figure of an earlier run, if there is one.
    recorded: Option<f64>,
}

impl Row {
    /// Whether the limit is kept; true without a gate.
    fn holds(&self) -> bool {
        self.gate.is_none_or(|gate| gate.limit.holds(self.measured))
    }

    /// Whether a figure that misses its gate is worse than its record. A figure that is not a number always is.
    fn is_worse(&self) -> bool {
        if self.measured.is_nan() {
            return true;
        }
        let (Some(gate), Some(recorded)) = (self.gate, self.recorded) else { return false };
        recorded::is_worse(&gate.limit, self.measured, recorded)
    }

    /// The state of the gate; an error if it is missed, if it is recorded as missed and met, or if the figure is worse than
    /// recorded.
    fn verdict(&self) -> Result<&'static str, &'static str> {
        match (self.gate, self.holds()) {
            (None, _) => Ok("reported"),
            (Some(Gate { missed: None, .. }), true) => Ok("met"),
            (Some(Gate { missed: None, .. }), false) => Err("MISSED"),
            (Some(_), false) if self.is_worse() => Err("WORSE than its record in docs/validation"),
            (Some(_), false) => Ok("missed, as recorded"),
            (Some(_), true) => Err("MET, but recorded as missed: remove `missed` from gates.toml"),
        }
    }

    fn limit(&self) -> String {
        self.gate.map(|gate| gate.limit.words()).unwrap_or_default()
    }
}

/// The figures of one variant of a case at one resolution.
pub struct Figures {
    case: &'static Case,
    variant: String,
    across: u32,
    executor: String,
    start: Instant,
    rows: Vec<Row>,
    /// Gated figures that this run does not measure.
    omitted: Vec<String>,
    plots: Vec<Value>,
}

impl Figures {
    /// The figures of the device of all cases. Their wall time starts here.
    pub fn new(case: &'static Case, variant: &str, across: u32) -> Self {
        assert!(case.variants.iter().any(|known| known.name == variant), "{}: {variant}", case.name);
        Self {
            case,
            variant: variant.to_owned(),
            across,
            executor: executor_name().to_owned(),
            start: Instant::now(),
            rows: Vec::new(),
            omitted: Vec::new(),
            plots: Vec::new(),
        }
    }

    /// The figures of another device.
    pub fn on(mut self, executor: &str) -> Self {
        executor.clone_into(&mut self.executor);
        self
    }

    /// A figure that has a gate in `gates.toml`. At resolutions and in variants without one it is reported.
    pub fn measure(&mut self, name: impl Into<String>, measured: f64) {
        self.add(name.into(), measured, false);
    }

    /// As [`Self::measure`]; the exact solution has zero.
    pub fn error(&mut self, name: impl Into<String>, measured: f64) {
        self.add(name.into(), measured, true);
    }

    fn add(&mut self, name: String, measured: f64, is_error: bool) {
        let gates = gates::of(self.case.name, &name);
        let gates = gates.unwrap_or_else(|| panic!("gates.toml has no gate: {}: {name}", self.case.name));
        let gate = gates.iter().find(|gate| gate.applies(&self.variant, self.across));
        // The tests run shorter than the validation.
        let recorded = is_validation()
            .then(|| recorded::figure(self.case.name, &self.variant, self.across, &self.executor, &name))
            .flatten();
        self.rows.push(Row { name, measured, is_error, gate, recorded });
    }

    /// A gated figure that only `cargo xtask validate` measures.
    pub fn omit(&mut self, name: impl Into<String>) {
        self.omitted.push(name.into());
    }

    /// A figure without a gate.
    pub fn report(&mut self, name: impl Into<String>, measured: f64) {
        let name = name.into();
        assert!(gates::of(self.case.name, &name).is_none(), "{}: {name} has a gate", self.case.name);
        self.rows.push(Row { name, measured, is_error: false, gate: None, recorded: None });
    }

    /// A plot on the page: dots are measurements or theory, lines are simulations.
    pub fn plot(&mut self, title: &str, axes: [&str; 2], measured: &Series, simulated: &Series) {
        self.plots.push(json!({
            "title": title,
            "axes": axes,
            "measured": thinned(measured),
            "simulated": thinned(simulated),
        }));
    }

    /// Prints the figures and writes them to the folder `SPLASHDOWN_FIGURES`.
    ///
    /// # Errors
    /// If a figure misses its gate, a gate recorded as missed is met or its figure is worse than its record, or a gate of the
    /// file has no figure.
    pub fn finish(self) -> Result<(), String> {
        let seconds = self.start.elapsed().as_secs_f64();
        let title = format!("{}, {}, {}, {}", self.case.name, self.variant, self.across, self.executor);
        let mut problems = Vec::new();
        for row in &self.rows {
            let word = row.verdict().unwrap_or_else(|word| word);
            let line = format!("{:44} {:>12.4e}  {:20} {word}", row.name, row.measured, row.limit());
            print(&format!("{title:50} {line}"));
            if row.verdict().is_err() {
                problems.push(format!("{title}: {line}"));
            }
        }
        for figure in gates::required(self.case.name, &self.variant, self.across) {
            if self.rows.iter().map(|row| &row.name).chain(&self.omitted).all(|name| name != figure) {
                problems.push(format!("{title}: the gate of \"{figure}\" is not used"));
            }
        }
        if let Some(folder) = std::env::var_os("SPLASHDOWN_FIGURES").map(PathBuf::from) {
            std::fs::create_dir_all(&folder).unwrap();
            let name: String =
                title.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
            let text = serde_json::to_string_pretty(&self.json(seconds)).unwrap();
            std::fs::write(folder.join(format!("{name}.json")), text).unwrap();
        }
        if problems.is_empty() { Ok(()) } else { Err(problems.join("\n")) }
    }

    /// As [`Self::finish`].
    ///
    /// # Panics
    /// Where that function has an error.
    pub fn close(self) {
        self.finish().unwrap_or_else(|problems| panic!("{problems}"));
    }

    fn json(&self, seconds: f64) -> Value {
        let row = |row: &Row| {
            json!({
                "figure": row.name,
                "measured": rounded(row.measured),
                "is_error": row.is_error,
                "gate": row.limit(),
                "is_met": row.holds(),
                "reason": row.gate.and_then(|gate| gate.reason.as_deref()),
                "missed": row.gate.and_then(|gate| gate.missed.as_deref()),
            })
        };
        json!({
            "case": self.case.name,
            "across": self.case.across,
            "variant": self.variant,
            "spacings": self.across,
            "executor": self.executor,
            "seconds": (10.0 * seconds).round() / 10.0,
            "cores": std::thread::available_parallelism().map_or(0, usize::from),
            "figures": self.rows.iter().map(row).collect::<Vec<Value>>(),
            "plots": self.plots,
        })
    }
}

/// Four significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

fn thinned(series: &Series) -> Vec<[f64; 2]> {
    let step = series.len().div_ceil(POINTS).max(1);
    series.iter().step_by(step).map(|&(x, y)| [rounded(x), rounded(y)]).collect()
}

#[expect(clippy::print_stdout, reason = "these tests print figures; the harness shows them on request")]
fn print(line: &str) {
    println!("{line}");
}

#[test]
fn a_missed_gate_and_a_stale_record_of_one_are_errors() {
    let gate = |missed: Option<&str>| -> Row {
        let text =
            format!("at_most = 1.0\n{}", missed.map(|m| format!("missed = \"{m}\"")).unwrap_or_default());
        let gate = Box::leak(Box::new(toml::from_str::<Gate>(&text).unwrap()));
        Row { name: "x".into(), measured: 0.5, is_error: false, gate: Some(gate), recorded: None }
    };
    let (open, stale) = (gate(None), gate(Some("1.2, as an example")));
    assert_eq!(open.verdict(), Ok("met"));
    assert!(Row { measured: 1.5, ..open }.verdict().is_err());
    assert!(stale.verdict().is_err());
    let missed = |measured, recorded| Row { measured, recorded, ..gate(Some("1.2, as an example")) };
    assert_eq!(missed(1.5, None).verdict(), Ok("missed, as recorded"));
    assert_eq!(missed(1.25, Some(1.2)).verdict(), Ok("missed, as recorded"));
    assert!(missed(1.5, Some(1.2)).verdict().is_err());
    assert!(missed(f64::NAN, None).verdict().is_err());
}
