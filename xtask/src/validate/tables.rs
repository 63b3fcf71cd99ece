//! The tables of the report: `docs/validation/tables.toml` says which figures they show, the committed records give the
//! values. A table replaces the text between its anchors in `docs/validation.md`.

use std::collections::BTreeMap;

use anyhow::{Context, Result, bail};
use serde::Deserialize;

use super::record::{Figure, Record};

/// The records of all cases, by name.
type Cases = BTreeMap<String, Vec<Record>>;

/// One table of the report.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    /// The case of all rows that name no other.
    case: String,
    /// The heading of the first column.
    head: String,
    columns: Vec<Column>,
    rows: Vec<Row>,
}

/// A column of a variant, or with the name `gate` that of the gates.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Column {
    variant: String,
    /// The heading; the variant without it.
    label: Option<String>,
    /// Resolutions of this column instead of those of the rows.
    at: Option<Vec<u64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    text: String,
    figure: String,
    case: Option<String>,
    #[serde(default)]
    at: Vec<u64>,
    #[serde(default)]
    unit: Unit,
}

#[derive(Debug, Default, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Unit {
    #[default]
    None,
    Percent,
    Degrees,
}

/// The report with all tables of the specification written anew.
///
/// # Errors
/// If the specification is not valid, or names an anchor or figure that does not exist.
pub fn write(report: &str, specification: &str, cases: &Cases) -> Result<String> {
    let tables: BTreeMap<String, Table> =
        toml::from_str(specification).context("cannot read the specification of the tables")?;
    let mut report = report.to_owned();
    for (name, table) in &tables {
        let text = table.text(cases).with_context(|| format!("table {name}"))?;
        let (start, end) = (format!("<!-- ANCHOR: {name} -->\n"), format!("<!-- ANCHOR_END: {name} -->"));
        let Some((before, rest)) = report.split_once(&start) else {
            bail!("the report has no anchor {name}")
        };
        let Some((_, after)) = rest.split_once(&end) else { bail!("the anchor {name} has no end") };
        report = format!("{before}{start}{text}{end}{after}");
    }
    Ok(report)
}

impl Table {
    fn text(&self, cases: &Cases) -> Result<String> {
        let labels: Vec<String> = self.columns.iter().map(Column::heading).collect();
        let mut text = format!("| {} | {} |\n", self.head, labels.join(" | "));
        text += &format!("|---|{}\n", "---:|".repeat(labels.len()));
        for row in &self.rows {
            let name = row.case.as_ref().unwrap_or(&self.case);
            let records = cases.get(name).with_context(|| format!("no case {name}"))?;
            let cells: Vec<Vec<Option<&Figure>>> =
                self.columns.iter().map(|column| column.find(row, records)).collect();
            if cells.iter().flatten().all(Option::is_none) {
                bail!("{name}: no column has the figure {}", row.figure);
            }
            let words: Vec<String> = self
                .columns
                .iter()
                .zip(&cells)
                .map(|(column, found)| match column.is_gate() {
                    true => gates(&self.columns, &cells, row),
                    false => values(found, row.unit),
                })
                .collect();
            text += &format!("| {} | {} |\n", row.text, words.join(" | "));
        }
        Ok(text)
    }
}

impl Column {
    fn is_gate(&self) -> bool {
        self.variant == "gate"
    }

    fn heading(&self) -> String {
        match &self.label {
            Some(label) => label.clone(),
            None if self.is_gate() => "gate".to_owned(),
            None => format!("`{}`", self.variant),
        }
    }

    /// The figure of a row at each resolution.
    fn find<'a>(&self, row: &Row, records: &'a [Record]) -> Vec<Option<&'a Figure>> {
        let at = |&spacings: &u64| {
            let record =
                records.iter().find(|record| record.spacings == spacings && record.column == self.variant)?;
            record.figures.iter().find(|figure| figure.name == row.figure)
        };
        self.at.as_ref().unwrap_or(&row.at).iter().map(at).collect()
    }
}

/// The values of a cell, bold where they miss their gate; "-" where there are none.
fn values(found: &[Option<&Figure>], unit: Unit) -> String {
    if found.iter().all(Option::is_none) {
        return "-".to_owned();
    }
    let is_missed = |figure: &Figure| figure.gate.is_some() && !figure.is_met;
    let all_missed = found.iter().all(|figure| figure.is_some_and(is_missed));
    let sign = if unit == Unit::Percent { " %" } else { "" };
    let word = |figure: &Option<&Figure>| match figure {
        None => "-".to_owned(),
        Some(figure) if is_missed(figure) && !all_missed => format!("**{}**", number(figure.measured, unit)),
        Some(figure) => number(figure.measured, unit),
    };
    let text = format!("{}{sign}", found.iter().map(word).collect::<Vec<String>>().join(", "));
    if all_missed { format!("**{text}**") } else { text }
}

/// The gates of a row. Where they differ, the columns or else the resolutions that each applies to are named.
fn gates(columns: &[Column], cells: &[Vec<Option<&Figure>>], row: &Row) -> String {
    let mut found: Vec<(&str, Vec<u64>, Vec<String>)> = Vec::new();
    for (column, figures) in columns.iter().zip(cells).filter(|(column, _)| !column.is_gate()) {
        for (&size, figure) in column.at.as_ref().unwrap_or(&row.at).iter().zip(figures) {
            let Some(gate) = figure.and_then(|figure| figure.gate.as_deref()) else { continue };
            let known = found.iter().position(|(text, ..)| *text == gate).unwrap_or_else(|| {
                found.push((gate, Vec::new(), Vec::new()));
                found.len() - 1
            });
            let (_, sizes, names) = &mut found[known];
            if !sizes.contains(&size) {
                sizes.push(size);
            }
            if !names.contains(&column.heading()) {
                names.push(column.heading());
            }
        }
    }
    // The columns tell the gates apart if no column has two of them.
    let mut names: Vec<&String> = found.iter().flat_map(|(.., names)| names).collect();
    names.sort();
    let by_column = names.windows(2).all(|pair| pair[0] != pair[1]);
    let word = |(gate, sizes, names): &(&str, Vec<u64>, Vec<String>)| {
        let limit = limit(gate, row.unit);
        let sizes: Vec<String> = sizes.iter().map(u64::to_string).collect();
        match (found.len(), by_column) {
            (1, _) => limit,
            (_, true) => format!("{limit} ({})", names.join(", ")),
            (_, false) => format!("{limit} ({})", sizes.join(", ")),
        }
    };
    let words: Vec<String> = found.iter().map(word).collect();
    if words.is_empty() { "-".to_owned() } else { words.join("; ") }
}

/// A limit in the unit of its row: "<= 0.03" is "3 %", and a range around zero the size of its ends.
fn limit(gate: &str, unit: Unit) -> String {
    let sign = if unit == Unit::Percent { " %" } else { "" };
    let scaled = |text: &str| -> String {
        let value: f64 = text.parse().unwrap_or(f64::NAN);
        let value = if unit == Unit::Percent { 100.0 * value } else { value };
        // Removes the rounding of the product.
        format!("{}", (1e6 * value).round() / 1e6)
    };
    if let Some(most) = gate.strip_prefix("<= ") {
        return format!("{}{sign}", scaled(most));
    }
    if let Some(least) = gate.strip_prefix("control > ") {
        return format!("above {}{sign}", scaled(least));
    }
    match gate.split_once(" to ") {
        Some((low, high)) if low.strip_prefix('-') == Some(high) => format!("{}{sign}", scaled(high)),
        Some((low, high)) => format!("{} to {}{sign}", scaled(low), scaled(high)),
        None => gate.to_owned(),
    }
}

/// Three significant digits, two of percentages, one decimal of degrees.
fn number(value: f64, unit: Unit) -> String {
    let (value, digits) = match unit {
        Unit::None => (value, 3),
        Unit::Percent => (100.0 * value, 2),
        Unit::Degrees => return format!("{value:.1}"),
    };
    let size = value.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    if size < 1e-3 {
        return if unit == Unit::Percent { "0.000".to_owned() } else { format!("{value:.0e}") };
    }
    // Rounding can add a digit: 9.96 has two digits as 10.
    let rounded: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    let decimals = digits as i32 - 1 - rounded.abs().log10().floor() as i32;
    format!("{value:.*}", decimals.max(0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(name: &str, measured: f64, gate: &str, is_met: bool) -> Figure {
        Figure {
            name: name.into(),
            measured,
            is_error: true,
            gate: (!gate.is_empty()).then(|| gate.into()),
            is_met,
            reason: None,
            missed: None,
        }
    }

    fn record(spacings: u64, column: &str, figures: Vec<Figure>) -> Record {
        Record {
            across: "depth".into(),
            spacings,
            column: column.into(),
            seconds: 1.0,
            cores: 2,
            date: String::new(),
            figures,
            plots: Vec::new(),
        }
    }

    fn cases() -> Cases {
        let wave = vec![
            record(20, "continuity", vec![figure("loss", 0.0058, "<= 0.03", true)]),
            record(28, "continuity", vec![figure("loss", 0.2, "<= 0.03", false)]),
            record(20, "dfsph", vec![figure("loss", 0.2333, "", true)]),
        ];
        BTreeMap::from([("wave".to_owned(), wave)])
    }

    const TABLE: &str = r#"
        [waves]
        case = "wave"
        head = "figure at 20 and 28"
        columns = [{ variant = "continuity" }, { variant = "gate" }, { variant = "dfsph", label = "other" }]
        rows = [{ text = "loss", figure = "loss", at = [20, 28], unit = "percent" }]
    "#;

    #[test]
    fn a_table_shows_values_gates_and_misses() {
        let report = "Text\n<!-- ANCHOR: waves -->\nold\n<!-- ANCHOR_END: waves -->\nmore\n";
        let written = write(report, TABLE, &cases()).unwrap();
        let lines = [
            "| figure at 20 and 28 | `continuity` | gate | other |",
            "|---|---:|---:|---:|",
            "| loss | 0.58, **20** % | 3 % | 23, - % |",
        ];
        let expected =
            format!("Text\n<!-- ANCHOR: waves -->\n{}\n<!-- ANCHOR_END: waves -->\nmore\n", lines.join("\n"));
        assert_eq!(written, expected);
        assert_eq!(write(&written, TABLE, &cases()).unwrap(), written, "a second time");
    }

    #[test]
    fn gates_that_differ_name_their_columns_or_resolutions() {
        let mut cases = cases();
        let records = cases.get_mut("wave").unwrap();
        let line = |cases: &Cases| {
            let report = "<!-- ANCHOR: waves -->\n<!-- ANCHOR_END: waves -->\n";
            write(report, TABLE, cases).unwrap().lines().nth(3).unwrap().to_owned()
        };
        records[2].figures[0].gate = Some("<= 0.3".into());
        assert_eq!(line(&cases), "| loss | 0.58, **20** % | 3 % (`continuity`); 30 % (other) | 23, - % |");
        let records = cases.get_mut("wave").unwrap();
        records[1].figures[0].gate = Some("<= 0.3".into());
        assert!(line(&cases).contains("| 3 % (20); 30 % (28, 20) |"), "{}", line(&cases));
    }

    #[test]
    fn unknown_names_are_errors() {
        let report = "<!-- ANCHOR: waves -->\n<!-- ANCHOR_END: waves -->\n";
        for (from, to, part) in [
            ("figure = \"loss\"", "figure = \"gain\"", "gain"),
            ("case = \"wave\"", "case = \"tide\"", "tide"),
            ("[waves]", "[tides]", "no anchor tides"),
            ("head", "heading", "specification"),
        ] {
            let error = write(report, &TABLE.replacen(from, to, 1), &cases()).unwrap_err();
            assert!(format!("{error:#}").contains(part), "{error:#}");
        }
    }

    #[test]
    fn numbers_and_limits_have_the_unit_of_their_row() {
        for (value, unit, text) in [
            (0.00283, Unit::Percent, "0.28"),
            (0.0996, Unit::Percent, "10"),
            (-0.126, Unit::Percent, "-13"),
            (-8e-9, Unit::Percent, "0.000"),
            (0.0000123, Unit::Percent, "0.0012"),
            (1.0146, Unit::None, "1.01"),
            (0.9996, Unit::None, "1.00"),
            (7.4e-7, Unit::None, "7e-7"),
            (-4.21, Unit::Degrees, "-4.2"),
            (0.0, Unit::Percent, "0"),
        ] {
            assert_eq!(number(value, unit), text);
        }
        for (gate, unit, text) in [
            ("<= 0.07", Unit::Percent, "7 %"),
            ("-0.1 to 0.1", Unit::Percent, "10 %"),
            ("0.95 to 1.05", Unit::None, "0.95 to 1.05"),
            ("-10 to 10", Unit::Degrees, "10"),
            ("control > 0.03", Unit::Percent, "above 3 %"),
        ] {
            assert_eq!(limit(gate, unit), text);
        }
    }
}
