//! The page: per case a table with the variants side by side, the observed orders of convergence, and the plots.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use anyhow::Result;

use super::chart;
use super::record::{Figure, Record, slug};

const HEAD: &str = "# Validation, all figures

This page contains the figures of all physics cases, with their gates. The command `cargo xtask
validate [TEST]... [--quick]` measures them and writes the page; the [report](validation.md)
describes the cases. Columns with the name of a GPU were measured on it (`--device=gpu`). The columns are solvers or other variants of a case; a row is one figure at one
resolution, the number of particle spacings along the length given. Gates are in
`crates/splashdown/tests/physics/gates.toml` and are set before the first run. A figure without a
gate is reported only. *control* is a run with a deliberate error, which must exceed its gate.

The order is log(e1 / e2) / log(n2 / n1) of the errors e of successive resolutions n.
";

/// The cases of the page, by name.
type Cases = BTreeMap<String, Vec<Record>>;

/// The page, and the names and texts of its plots, which lie in the folder `plots`.
pub fn write(cases: &Cases, plots: &str) -> Result<(String, Vec<(String, String)>)> {
    let mut page = format!("{HEAD}\n| case | gates met | gates missed | wall time |\n|---|---:|---:|---:|\n");
    for (case, records) in sorted(cases) {
        let gated = || records.iter().flat_map(|r| &r.figures).filter(|figure| figure.gate.is_some());
        let met = gated().filter(|figure| figure.is_met).count();
        let missed = match gated().count() - met {
            0 => "0".to_owned(),
            count => format!("**{count}**"),
        };
        let seconds: f64 = records.iter().map(|record| record.seconds).sum();
        let _ =
            writeln!(page, "| [{}](#{}) | {met} | {missed} | {seconds:.0} s |", heading(case), anchor(case));
    }
    let mut charts = Vec::new();
    for (case, records) in sorted(cases) {
        let _ = write!(page, "\n## {}\n\n", heading(case));
        section(&mut page, records);
        for (k, (title, svg)) in drawings(records)?.into_iter().enumerate() {
            let name = format!("{}-{}.svg", slug(case), k + 1);
            let _ = write!(page, "\n![{title}]({plots}/{name})\n");
            charts.push((name, svg));
        }
    }
    Ok((page, charts))
}

/// By name, without regard to capital letters.
fn sorted(cases: &Cases) -> Vec<(&String, &Vec<Record>)> {
    let mut sorted: Vec<_> = cases.iter().collect();
    sorted.sort_by_key(|(case, _)| case.to_lowercase());
    sorted
}

fn heading(case: &str) -> String {
    let mut letters = case.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

/// The anchor of a heading, as mdBook and GitHub make it.
fn anchor(case: &str) -> String {
    let kept = case.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.collect::<String>().to_lowercase().replace(' ', "-")
}

fn section(page: &mut String, records: &[Record]) {
    let columns = distinct(records.iter().map(|record| record.column.clone()));
    let sizes = distinct(records.iter().map(|record| record.spacings));
    let names = distinct(records.iter().flat_map(|r| r.figures.iter().map(|figure| figure.name.clone())));
    let across = records.first().map(|record| record.across.as_str()).unwrap_or_default();
    let _ = writeln!(page, "| figure | spacings per {across} | gate | {} |", columns.join(" | "));
    let _ = writeln!(page, "|---|---:|---|{}", "---:|".repeat(columns.len()));
    let at = |size: u64, column: &str| {
        records.iter().find(|record| record.spacings == size && record.column == column)
    };
    for name in &names {
        let find = |size: u64, column: &str| {
            at(size, column).and_then(|record| record.figures.iter().find(|figure| figure.name == *name))
        };
        for &size in &sizes {
            if columns.iter().all(|column| find(size, column).is_none()) {
                continue;
            }
            let found: Vec<(&String, Option<&Figure>)> =
                columns.iter().map(|column| (column, find(size, column))).collect();
            let cells: Vec<String> =
                found.iter().map(|(_, figure)| figure.map(cell).unwrap_or_default()).collect();
            let _ = writeln!(page, "| {name} | {size} | {} | {} |", gates(&found), cells.join(" | "));
        }
        let errors = |column: &str| -> Vec<(u64, f64)> {
            let figures = sizes.iter().filter_map(|&size| Some((size, find(size, column)?)));
            figures
                .filter(|(_, figure)| figure.is_error)
                .map(|(size, figure)| (size, figure.measured))
                .collect()
        };
        let orders: Vec<String> = columns.iter().map(|column| orders(&errors(column))).collect();
        if orders.iter().any(|text| !text.is_empty()) {
            let _ = writeln!(page, "| *order* | | | {} |", orders.join(" | "));
        }
    }
    for &size in &sizes {
        let times: Vec<String> = columns
            .iter()
            .map(|column| at(size, column).map(|record| format!("{} s", record.seconds)).unwrap_or_default())
            .collect();
        let _ = writeln!(page, "| *wall time* | {size} | | {} |", times.join(" | "));
    }
    for &size in &sizes {
        let days: Vec<String> = columns
            .iter()
            .map(|column| at(size, column).map(|r| r.date.clone()).unwrap_or_default())
            .collect();
        let _ = writeln!(page, "| *measured* | {size} | | {} |", days.join(" | "));
    }
    let cores = distinct(records.iter().map(|record| record.cores.to_string()));
    let _ = writeln!(page, "\nMeasured on {} cores.", cores.join(" and "));
    notes(page, records);
}

/// The reasons of changed gates, and of recorded misses.
fn notes(page: &mut String, records: &[Record]) {
    let mut lines: Vec<String> = Vec::new();
    for record in records {
        for figure in &record.figures {
            let place = format!("{}, {}, {} spacings", figure.name, record.column, record.spacings);
            if let Some(text) = &figure.missed {
                lines.push(format!("* Missed: {place}: {text}."));
            }
            if let Some(text) = &figure.reason {
                lines.push(format!("* Gate changed: {place}: {text}."));
            }
        }
    }
    if !lines.is_empty() {
        let _ = writeln!(page, "\n{}", lines.join("\n"));
    }
}

fn cell(figure: &Figure) -> String {
    let value = number(figure.measured);
    match (&figure.gate, figure.is_met) {
        (None, _) => value,
        (Some(_), true) => format!("{value} met"),
        (Some(_), false) => format!("**{value} missed**"),
    }
}

/// Three significant digits.
fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if (0.01..10_000.0).contains(&size) {
        let digits = (2 - size.log10().floor() as i32).max(0) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.2e}")
    }
}

/// The gates of a row; with the columns that each applies to, if they differ.
fn gates(found: &[(&String, Option<&Figure>)]) -> String {
    let mut gates: Vec<(&str, Vec<&str>)> = Vec::new();
    for (column, figure) in found {
        if let Some(gate) = figure.and_then(|figure| figure.gate.as_deref()) {
            match gates.iter_mut().find(|(known, _)| *known == gate) {
                Some((_, columns)) => columns.push(column),
                None => gates.push((gate, vec![column])),
            }
        }
    }
    let text = |(gate, columns): &(&str, Vec<&str>)| {
        let gate = gate.replace("<=", "at most").replace('>', "above");
        if gates.len() == 1 { gate } else { format!("{gate} ({})", columns.join(", ")) }
    };
    gates.iter().map(text).collect::<Vec<String>>().join("; ")
}

/// The observed orders between successive resolutions.
fn orders(errors: &[(u64, f64)]) -> String {
    let order = |pair: &[(u64, f64)]| {
        let [(coarse, first), (fine, second)] = [pair[0], pair[1]];
        let order = (first / second).abs().ln() / (fine as f64 / coarse as f64).ln();
        if order.is_finite() { format!("{order:.1}") } else { "-".to_owned() }
    };
    errors.windows(2).map(order).collect::<Vec<String>>().join(", ")
}

/// The plots of the finest resolution, with the curves of all variants in each.
fn drawings(records: &[Record]) -> Result<Vec<(String, String)>> {
    let with_plots = || records.iter().filter(|record| !record.plots.is_empty());
    let Some(finest) = with_plots().map(|record| record.spacings).max() else { return Ok(Vec::new()) };
    let across = records.first().map(|record| record.across.as_str()).unwrap_or_default();
    let shown: Vec<&Record> = with_plots().filter(|record| record.spacings == finest).collect();
    let titles = distinct(shown.iter().flat_map(|r| r.plots.iter().map(|(title, ..)| title.clone())));
    let draw = |title: &String| {
        let find = |record: &&Record| record.plots.iter().find(|(own, ..)| own == title).cloned();
        let plots: Vec<(String, _)> =
            shown.iter().filter_map(|record| Some((record.column.clone(), find(record)?))).collect();
        let (_, (_, axes, measured, _)) = &plots[0];
        let curves: Vec<(&str, &[(f64, f64)])> =
            plots.iter().map(|(column, (.., simulated))| (column.as_str(), simulated.as_slice())).collect();
        let title = format!("{title}, {finest} spacings per {across}");
        let drawing = chart::draw(&title, axes, measured, &curves)?;
        Ok((title, drawing))
    };
    titles.iter().map(draw).collect()
}

/// The items without repetitions, in their order.
pub fn distinct<T: PartialEq>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut found = Vec::new();
    for item in items {
        if !found.contains(&item) {
            found.push(item);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(spacings: u64, measured: f64) -> Record {
        let figure = Figure {
            name: "error".into(),
            measured,
            is_error: true,
            gate: Some("<= 0.02".into()),
            is_met: measured <= 0.02,
            reason: None,
            missed: None,
        };
        Record {
            across: "depth".into(),
            spacings,
            column: "continuity".into(),
            seconds: 2.0,
            cores: 2,
            date: "2026-11-28".into(),
            figures: vec![figure],
            plots: Vec::new(),
        }
    }

    #[test]
    fn a_section_shows_gates_orders_and_times() {
        let cases = BTreeMap::from([("a wave".to_owned(), vec![record(10, 0.04), record(20, 0.01)])]);
        let (page, charts) = write(&cases, "plots").unwrap();
        assert!(charts.is_empty());
        for line in [
            "| [A wave](#a-wave) | 1 | **1** | 4 s |",
            "| error | 10 | at most 0.02 | **0.0400 missed** |",
            "| error | 20 | at most 0.02 | 0.0100 met |",
            "| *order* | | | 2.0 |",
            "| *wall time* | 20 | | 2 s |",
            "| *measured* | 20 | | 2026-11-28 |",
        ] {
            assert!(page.contains(line), "{line}\n{page}");
        }
    }
}
