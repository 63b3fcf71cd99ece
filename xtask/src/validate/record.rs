//! The figures of runs, as the physics tests write them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde_json::Value;

use crate::report::date_of;

/// One figure and its gate.
#[derive(Debug, Clone)]
pub struct Figure {
    pub name: String,
    pub measured: f64,
    /// Zero in the exact solution.
    pub is_error: bool,
    /// The limit in words; none without a gate.
    pub gate: Option<String>,
    pub is_met: bool,
    /// Why the gate was changed, and why it is missed.
    pub reason: Option<String>,
    pub missed: Option<String>,
}

/// Points of one curve.
pub type Series = Vec<(f64, f64)>;

/// One variant of a case at one resolution.
#[derive(Debug, Clone)]
pub struct Record {
    /// The length whose spacings are counted, and their number.
    pub across: String,
    pub spacings: u64,
    /// The variant, and the device unless it is the CPU.
    pub column: String,
    pub seconds: f64,
    pub cores: u64,
    /// The day of the run, as 2026-11-28.
    pub date: String,
    pub figures: Vec<Figure>,
    /// Title, axes, measured and simulated points.
    pub plots: Vec<(String, [String; 2], Series, Series)>,
}

/// Whether a run with this variant has written figures.
///
/// # Errors
/// If a file cannot be read.
pub fn has_variant(folder: &Path, variant: &str) -> Result<bool> {
    Ok(folder.exists() && values(folder)?.iter().any(|value| text(value, "variant") == variant))
}

/// Replaces the records of `from` in the files of `to`, one per case, with the day on which each was written; other records remain.
///
/// # Errors
/// If a file cannot be read or written.
pub fn merge(from: &Path, to: &Path) -> Result<()> {
    let mut cases: BTreeMap<String, Vec<Value>> = BTreeMap::new();
    for path in files(from)? {
        let day = date_of(fs::metadata(&path)?.modified()?);
        for mut value in array(&path)? {
            value["date"] = day.as_str().into();
            cases.entry(text(&value, "case")).or_default().push(value);
        }
    }
    fs::create_dir_all(to)?;
    for (case, fresh) in cases {
        let path = to.join(format!("{}.json", slug(&case)));
        let mut all: BTreeMap<_, Value> = BTreeMap::new();
        let old = if path.exists() { array(&path)? } else { Vec::new() };
        for value in old.into_iter().chain(fresh) {
            all.insert(
                (value["spacings"].as_u64(), text(&value, "variant"), text(&value, "executor")),
                value,
            );
        }
        let all: Vec<Value> = all.into_values().collect();
        fs::write(&path, compact(&all)).with_context(|| format!("cannot write {}", path.display()))?;
    }
    Ok(())
}

/// JSON with one line per record, figure and plot, so that differences are readable.
fn compact(records: &[Value]) -> String {
    let lines = |value: &Value| -> String {
        let items: Vec<String> =
            value.as_array().into_iter().flatten().map(|item| format!("\n      {item}")).collect();
        if items.is_empty() { "[]".to_owned() } else { format!("[{}\n    ]", items.join(",")) }
    };
    let record = |value: &Value| {
        let keys: Vec<String> = value
            .as_object()
            .into_iter()
            .flatten()
            .map(|(key, value)| match key.as_str() {
                "figures" | "plots" => format!("    \"{key}\": {}", lines(value)),
                _ => format!("    \"{key}\": {value}"),
            })
            .collect();
        format!("  {{\n{}\n  }}", keys.join(",\n"))
    };
    let all: Vec<String> = records.iter().map(record).collect();
    format!("[\n{}\n]\n", all.join(",\n"))
}

/// All records of a folder by the name of their case.
///
/// # Errors
/// If a file cannot be read.
pub fn read(folder: &Path) -> Result<BTreeMap<String, Vec<Record>>> {
    let mut cases: BTreeMap<String, Vec<Record>> = BTreeMap::new();
    for value in values(folder)? {
        cases.entry(text(&value, "case")).or_default().push(record(&value));
    }
    for records in cases.values_mut() {
        records.sort_by(|a, b| (a.spacings, &a.column).cmp(&(b.spacings, &b.column)));
    }
    Ok(cases)
}

/// The name of a case in names of files.
pub fn slug(case: &str) -> String {
    let words = case.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<&str>>().join("-").to_lowercase()
}

fn values(folder: &Path) -> Result<Vec<Value>> {
    let mut all = Vec::new();
    for path in files(folder)? {
        all.extend(array(&path)?);
    }
    Ok(all)
}

/// The JSON files of a folder; none if it does not exist.
fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|end| end == "json") {
            found.push(path);
        }
    }
    Ok(found)
}

/// A file contains one record or an array of them.
fn array(path: &Path) -> Result<Vec<Value>> {
    let text = fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let value = serde_json::from_str(&text).with_context(|| format!("cannot read {}", path.display()))?;
    Ok(match value {
        Value::Array(all) => all,
        one => vec![one],
    })
}

fn text(value: &Value, key: &str) -> String {
    value[key].as_str().unwrap_or_default().to_owned()
}

fn record(value: &Value) -> Record {
    let executor = text(value, "executor");
    let variant = text(value, "variant");
    let items = |key: &str| value[key].as_array().cloned().unwrap_or_default();
    Record {
        across: text(value, "across"),
        spacings: value["spacings"].as_u64().unwrap_or_default(),
        column: if executor == "CPU" { variant } else { format!("{variant}, {executor}") },
        seconds: value["seconds"].as_f64().unwrap_or_default(),
        cores: value["cores"].as_u64().unwrap_or_default(),
        date: text(value, "date"),
        figures: items("figures").iter().map(figure).collect(),
        plots: items("plots").iter().map(plot).collect(),
    }
}

fn figure(value: &Value) -> Figure {
    let optional = |key: &str| value[key].as_str().filter(|text| !text.is_empty()).map(str::to_owned);
    Figure {
        name: text(value, "figure"),
        measured: value["measured"].as_f64().unwrap_or(f64::NAN),
        is_error: value["is_error"].as_bool().unwrap_or_default(),
        gate: optional("gate"),
        is_met: value["is_met"].as_bool().unwrap_or_default(),
        reason: optional("reason"),
        missed: optional("missed"),
    }
}

fn plot(value: &Value) -> (String, [String; 2], Series, Series) {
    let series = |key: &str| -> Series {
        let points = value[key].as_array().into_iter().flatten();
        points.filter_map(|point| Some((point[0].as_f64()?, point[1].as_f64()?))).collect()
    };
    let axis = |k: usize| value["axes"][k].as_str().unwrap_or_default().to_owned();
    (text(value, "title"), [axis(0), axis(1)], series("measured"), series("simulated"))
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, SystemTime};

    use super::*;

    #[test]
    fn a_repeated_run_replaces_only_its_own_record() {
        let folder = std::env::temp_dir().join(format!("splashdown-records-{}", std::process::id()));
        let (from, to) = (folder.join("from"), folder.join("to"));
        let write = |variant: &str, measured: f64| {
            fs::create_dir_all(&from).unwrap();
            let text = format!(
                r#"{{"case": "a case", "variant": "{variant}", "executor": "CPU", "spacings": 20, "across": "depth",
                "seconds": 1.5, "cores": 2, "plots": [], "figures": [{{"figure": "x", "measured": {measured}}}]}}"#
            );
            let path = from.join(format!("{variant}.json"));
            fs::write(&path, text).unwrap();
            // The figures of an earlier day keep their date.
            let day = SystemTime::UNIX_EPOCH + Duration::from_secs(20_454 * 86_400);
            fs::File::options().write(true).open(&path).unwrap().set_modified(day).unwrap();
            merge(&from, &to).unwrap();
            fs::remove_dir_all(&from).unwrap();
        };
        write("one", 1.0);
        write("two", 2.0);
        write("one", 3.0);
        let cases = read(&to).unwrap();
        let found: Vec<(&str, f64)> =
            cases["a case"].iter().map(|r| (r.column.as_str(), r.figures[0].measured)).collect();
        assert_eq!(found, [("one", 3.0), ("two", 2.0)]);
        assert!(cases["a case"].iter().all(|record| record.date == "2026-01-01"));
        fs::remove_dir_all(&folder).unwrap();
    }
}
