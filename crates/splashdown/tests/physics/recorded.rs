//! The records of earlier runs in `docs/validation`. A gate that is missed sets no limit, so the record does: its figure may not
//! become worse unseen. A run that is worse fails once and replaces the record, so that the difference is seen in the commit.
//! Runs on a device without records are not compared.

use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use serde::Deserialize;

use super::gates::Limit;

/// How much farther from the limit than the record a figure may be, as a share of that distance and of the record: other
/// machines round differently, and runs with splashes amplify that.
const SCATTER: f64 = 0.25;
/// The same as a share of the limit, or of half the width of a range, for figures that are close to it.
const SHARE: f64 = 0.1;

#[derive(Deserialize)]
struct Record {
    case: String,
    variant: String,
    spacings: u32,
    executor: String,
    figures: Vec<Figure>,
}

#[derive(Deserialize)]
struct Figure {
    figure: String,
    /// `null` for a figure that is not finite.
    measured: Option<f64>,
}

/// Case, variant, resolution and device of a run.
type Run = (String, String, u32, String);

static RECORDS: LazyLock<HashMap<Run, Vec<Figure>>> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/validation");
    let files = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    let mut records = HashMap::new();
    for path in files.filter(|path| path.extension().is_some_and(|end| end == "json")) {
        let text = fs::read_to_string(&path).unwrap();
        let file: Vec<Record> =
            serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        for record in file {
            let run = (record.case, record.variant, record.spacings, record.executor);
            records.insert(run, record.figures);
        }
    }
    records
});

/// The figure of an earlier run, if there is one.
pub fn figure(case: &str, variant: &str, across: u32, executor: &str, name: &str) -> Option<f64> {
    let run = (case.to_owned(), variant.to_owned(), across, executor.to_owned());
    RECORDS.get(&run)?.iter().find(|figure| figure.figure == name)?.measured
}

/// Whether a figure that misses its limit is farther from it than the record allows.
pub fn is_worse(limit: &Limit, measured: f64, recorded: f64) -> bool {
    let excess = limit.excess(recorded).max(0.0);
    let scatter = SCATTER * excess.min(recorded.abs()) + SHARE * limit.scale();
    limit.excess(measured) > excess + scatter
}

#[test]
fn a_figure_worse_than_the_record_is_detected() {
    let at_most = Limit::AtMost(0.03);
    assert!(!is_worse(&at_most, 0.073, 0.073));
    assert!(!is_worse(&at_most, 0.08, 0.073));
    assert!(is_worse(&at_most, 0.19, 0.073));
    // 0.043 above the limit; a quarter of it and a tenth of the limit are allowed.
    assert!(!is_worse(&at_most, 0.0867, 0.073) && is_worse(&at_most, 0.0868, 0.073));
    let within = Limit::Within(0.9, 1.1);
    assert!(!is_worse(&within, 0.891, 1.05) && !is_worse(&within, 1.109, 1.05));
    assert!(is_worse(&within, 0.7, 0.85) && is_worse(&within, 1.3, 1.15));
    assert!(!is_worse(&within, 0.828, 0.85) && is_worse(&within, 0.827, 0.85));
    // Far below a range a quarter of the record counts, not of the distance.
    assert!(
        !is_worse(&Limit::Within(0.8, 1.2), 0.13, 0.15) && is_worse(&Limit::Within(0.8, 1.2), 0.09, 0.15)
    );
    // A figure on the other side of the range is measured by its distance from the range.
    assert!(!is_worse(&within, 1.15, 0.85));
}

#[test]
fn committed_figures_are_found() {
    let name = "pressure, L2 relative";
    assert!(figure("tilted tank", "domain", 12, "CPU", name).is_some_and(|figure| figure > 0.0));
    assert_eq!(figure("tilted tank", "domain", 13, "CPU", name), None);
}
