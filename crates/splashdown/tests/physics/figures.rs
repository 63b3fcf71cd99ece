//! Measured figures and their gates: printed, asserted, and written for the validation report.

use std::fmt::Write as _;
use std::path::PathBuf;

use super::plot;

/// True for the resolution of the published checks; otherwise the cases are smaller, with the same gates.
pub fn full() -> bool {
    std::env::var_os("SPLASHDOWN_FULL").is_some()
}

enum Gate {
    AtMost(f64),
    Within(f64, f64),
    /// The figure of a wrong input must exceed this value; otherwise the comparison detects nothing.
    Control(f64),
    Reported,
}

impl Gate {
    fn holds(&self, measured: f64) -> bool {
        match *self {
            Self::AtMost(limit) => measured <= limit,
            Self::Within(low, high) => (low..=high).contains(&measured),
            Self::Control(limit) => measured > limit,
            Self::Reported => true,
        }
    }

    fn words(&self) -> String {
        match self {
            Self::AtMost(limit) => format!("<= {limit:.3e}"),
            Self::Within(low, high) => format!("{low:.4} .. {high:.4}"),
            Self::Control(limit) => format!("control > {limit:.3e}"),
            Self::Reported => "reported".to_owned(),
        }
    }
}

/// Points of one curve.
pub type Series = Vec<(f64, f64)>;

/// The figures of one case.
pub struct Figures {
    case: String,
    rows: Vec<(String, f64, Gate)>,
    /// Drawings as SVG.
    plots: Vec<String>,
}

impl Figures {
    pub fn new(case: impl Into<String>) -> Self {
        Self { case: case.into(), rows: Vec::new(), plots: Vec::new() }
    }

    pub fn at_most(&mut self, name: impl Into<String>, measured: f64, limit: f64) {
        self.rows.push((name.into(), measured, Gate::AtMost(limit)));
    }

    pub fn within(&mut self, name: impl Into<String>, measured: f64, low: f64, high: f64) {
        self.rows.push((name.into(), measured, Gate::Within(low, high)));
    }

    /// The figure of a run with a deliberate error, which must miss the gate `limit` of the correct run.
    pub fn control(&mut self, name: impl Into<String>, measured: f64, limit: f64) {
        self.rows.push((name.into(), measured, Gate::Control(limit)));
    }

    pub fn report(&mut self, name: impl Into<String>, measured: f64) {
        self.rows.push((name.into(), measured, Gate::Reported));
    }

    /// Draws measurements as dots and simulations as lines, if figures are requested.
    pub fn plot(&mut self, title: &str, axes: [&str; 2], measured: &Series, simulated: &[(&str, &Series)]) {
        if std::env::var_os("SPLASHDOWN_FIGURES").is_some() {
            self.plots.push(plot::draw(title, axes, measured, simulated));
        }
    }

    /// Prints the figures, writes them to the folder `SPLASHDOWN_FIGURES`, and fails if one misses its gate.
    pub fn close(self) {
        let mut table = String::new();
        for (name, measured, gate) in &self.rows {
            let word = if gate.holds(*measured) { "ok" } else { "MISSED" };
            let _ =
                writeln!(table, "{:34} {name:44} {measured:>12.4e}  {:24} {word}", self.case, gate.words());
        }
        print(&table);
        if let Some(folder) = std::env::var_os("SPLASHDOWN_FIGURES").map(PathBuf::from) {
            let rows: Vec<serde_json::Value> = self.rows.iter().map(|row| self.json(row)).collect();
            std::fs::create_dir_all(&folder).unwrap();
            let file =
                |end: &str| folder.join(format!("{}.{end}", self.case.replace(", ", "-").replace(' ', "_")));
            std::fs::write(file("json"), serde_json::to_string_pretty(&rows).unwrap()).unwrap();
            std::fs::write(file("txt"), &table).unwrap();
            std::fs::write(file("html"), self.page()).unwrap();
        }
        let missed: Vec<&str> =
            self.rows.iter().filter(|(_, m, gate)| !gate.holds(*m)).map(|(name, ..)| name.as_str()).collect();
        assert!(missed.is_empty(), "{}: missed: {}\n{table}", self.case, missed.join(", "));
    }

    /// The section of the page: a table, then the plots.
    fn page(&self) -> String {
        let mut page = format!(
            "<h2>{}</h2>\n<table>\n<tr><th>figure<th>measured<th>gate<th></tr>\n",
            escaped(&self.case)
        );
        for (name, measured, gate) in &self.rows {
            let word = match gate {
                Gate::Reported => "",
                _ if gate.holds(*measured) => "ok",
                _ => "<strong>missed</strong>",
            };
            let (name, gate) = (escaped(name), escaped(&gate.words()));
            let _ = writeln!(page, "<tr><td>{name}<td>{measured:.4e}<td>{gate}<td>{word}</tr>");
        }
        page + "</table>\n" + &self.plots.concat()
    }

    fn json(&self, (name, measured, gate): &(String, f64, Gate)) -> serde_json::Value {
        serde_json::json!({
            "case": self.case,
            "figure": name,
            "measured": measured,
            "gate": gate.words(),
            "full_resolution": full(),
            "passed": gate.holds(*measured),
        })
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[expect(clippy::print_stdout, reason = "these tests print figures; the harness shows them on request")]
fn print(table: &str) {
    print!("{table}");
}
