//! The tables of the report: `docs/validation/tables.toml` says which figures they show, the committed records give the
//! values. A table replaces the text between its anchors in `docs/validation.md`.

use std::collections::BTreeMap;

use anyhow::{Context, Result, bail};
use serde::Deserialize;

use super::page::distinct;
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
        let mut is_empty = vec![true; self.columns.len()];
        for row in &self.rows {
            let name = row.case.as_ref().unwrap_or(&self.case);
            let records = cases.get(name).with_context(|| format!("no case {name}"))?;
            let cells: Vec<Vec<Option<&Figure>>> =
                self.columns.iter().map(|column| column.find(row, records)).collect();
            if cells.iter().flatten().all(Option::is_none) {
                bail!("{name}: no column has the figure {}", row.figure);
            }
            let has_gate = cells.iter().flatten().flatten().any(|figure| figure.gate.is_some());
            let mut words = Vec::new();
            for (k, (column, found)) in self.columns.iter().zip(&cells).enumerate() {
                is_empty[k] &= !column.is_gate() && found.iter().all(Option::is_none);
                words.push(match column.is_gate() {
                    true => gates(&self.columns, &cells, row)?,
                    false => values(found, row.unit, has_gate)?,
                });
            }
            text += &format!("| {} | {} |\n", row.text, words.join(" | "));
        }
        if let Some(k) = is_empty.iter().position(|&empty| empty) {
            bail!("the column {} has no figure", self.columns[k].variant);
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

/// The values of a cell: bold where they miss their gate, in parentheses where only others of the row have one; "-" where
/// there are none.
fn values(found: &[Option<&Figure>], unit: Unit, has_gate: bool) -> Result<String> {
    if found.iter().all(Option::is_none) {
        return Ok("-".to_owned());
    }
    let is_missed = |figure: &Figure| figure.gate.is_some() && !figure.is_met;
    let all_missed = found.iter().all(|figure| figure.is_some_and(is_missed));
    let sign = if unit == Unit::Percent { " %" } else { "" };
    let word = |figure: &Option<&Figure>| -> Result<String> {
        let Some(figure) = figure else { return Ok("-".to_owned()) };
        let number = judged(figure, unit)?;
        Ok(match figure.gate {
            None if has_gate => format!("({number})"),
            Some(_) if is_missed(figure) && !all_missed => format!("**{number}**"),
            _ => number,
        })
    };
    let text = format!("{}{sign}", found.iter().map(word).collect::<Result<Vec<String>>>()?.join(", "));
    Ok(if all_missed { format!("**{text}**") } else { text })
}

/// The number of a figure with as many digits as tell on which side of its limit it is.
fn judged(figure: &Figure, unit: Unit) -> Result<String> {
    let Some(gate) = &figure.gate else { return Ok(number(figure.measured, unit, 0)) };
    let limit = Limit::parse(gate)?;
    let scale = if unit == Unit::Percent { 0.01 } else { 1.0 };
    let written = (0..4).map(|more| number(figure.measured, unit, more));
    let tells = |text: &String| {
        text.parse().is_ok_and(|value: f64| limit.holds(scale * value) == limit.holds(figure.measured))
    };
    Ok(written.clone().find(tells).unwrap_or_else(|| number(figure.measured, unit, 3)))
}

/// The resolution and the column of a figure.
type Place = (u64, String);

/// The gates of a row. Where they differ, the columns or resolutions that each applies to are named.
fn gates(columns: &[Column], cells: &[Vec<Option<&Figure>>], row: &Row) -> Result<String> {
    let mut found: Vec<(&str, Vec<Place>)> = Vec::new();
    for (column, figures) in columns.iter().zip(cells).filter(|(column, _)| !column.is_gate()) {
        for (&size, figure) in column.at.as_ref().unwrap_or(&row.at).iter().zip(figures) {
            let Some(gate) = figure.and_then(|figure| figure.gate.as_deref()) else { continue };
            let place = (size, column.heading());
            match found.iter_mut().find(|(text, _)| *text == gate) {
                Some((_, places)) => places.push(place),
                None => found.push((gate, vec![place])),
            }
        }
    }
    let columns = |places: &[Place]| distinct(places.iter().map(|(_, name)| name.clone()));
    let sizes = |places: &[Place]| distinct(places.iter().map(|(size, _)| size.to_string()));
    // Names tell the gates apart if none of them has two gates.
    let are_distinct = |names: Vec<String>| distinct(names.iter()).len() == names.len();
    let by_column = are_distinct(found.iter().flat_map(|(_, places)| columns(places)).collect());
    let by_size = are_distinct(found.iter().flat_map(|(_, places)| sizes(places)).collect());
    let word = |(gate, places): &(&str, Vec<Place>)| -> Result<String> {
        let limit = Limit::parse(gate)?.words(row.unit);
        let both = |(size, name): &Place| format!("{name} at {size}");
        let names = match (by_column, by_size) {
            (true, _) => columns(places),
            (_, true) => sizes(places),
            _ => places.iter().map(both).collect(),
        };
        Ok(if found.len() == 1 { limit } else { format!("{limit} ({})", names.join(", ")) })
    };
    let words = found.iter().map(word).collect::<Result<Vec<String>>>()?;
    Ok(if words.is_empty() { "-".to_owned() } else { words.join("; ") })
}

/// A limit as the records contain it.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Limit {
    AtMost(f64),
    Within(f64, f64),
    Above(f64),
}

impl Limit {
    fn parse(text: &str) -> Result<Self> {
        let value = |text: &str| text.parse::<f64>().ok();
        let parsed = if let Some(most) = text.strip_prefix("<= ") {
            value(most).map(Self::AtMost)
        } else if let Some(least) = text.strip_prefix("control > ") {
            value(least).map(Self::Above)
        } else {
            text.split_once(" to ").and_then(|(low, high)| Some(Self::Within(value(low)?, value(high)?)))
        };
        parsed.with_context(|| format!("not a limit: {text}"))
    }

    fn holds(self, value: f64) -> bool {
        match self {
            Self::AtMost(limit) => value <= limit,
            Self::Within(low, high) => (low..=high).contains(&value),
            Self::Above(limit) => value > limit,
        }
    }

    /// "<= 0.03" is "3 %", and a range around zero the size of its ends.
    fn words(self, unit: Unit) -> String {
        let sign = if unit == Unit::Percent { " %" } else { "" };
        // Rounding removes the error of the product.
        let scale = if unit == Unit::Percent { 100.0 } else { 1.0 };
        let scaled = |value: f64| (1e9 * scale * value).round() / 1e9;
        match self {
            Self::AtMost(limit) => format!("{}{sign}", scaled(limit)),
            Self::Above(limit) => format!("above {}{sign}", scaled(limit)),
            Self::Within(low, high) if low == -high => format!("{}{sign}", scaled(high)),
            Self::Within(low, high) => format!("{} to {}{sign}", scaled(low), scaled(high)),
        }
    }
}

/// Three significant digits, two of percentages, one decimal of degrees, and `more` digits.
fn number(value: f64, unit: Unit, more: usize) -> String {
    let (value, digits) = match unit {
        Unit::None => (value, 3 + more),
        Unit::Percent => (100.0 * value, 2 + more),
        Unit::Degrees => {
            let text = format!("{value:.*}", 1 + more);
            return if text.trim_start_matches('-').parse() == Ok(0.0) {
                text.trim_start_matches('-').to_owned()
            } else {
                text
            };
        }
    };
    let size = value.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    if size < 1e-3 {
        return if unit == Unit::Percent { "0.000".to_owned() } else { format!("{value:.more$e}") };
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
            "| loss | 0.58, **20** % | 3 % | (23), - % |",
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
        let both = "| 3 % (`continuity` at 20); 30 % (`continuity` at 28, other at 20) |";
        assert!(line(&cases).contains(both), "{}", line(&cases));
        let records = cases.get_mut("wave").unwrap();
        records[2].figures[0].gate = Some("<= 0.03".into());
        assert!(line(&cases).contains("| 3 % (20); 30 % (28) |"), "{}", line(&cases));
    }

    #[test]
    fn enough_digits_tell_the_side_of_a_limit() {
        for (measured, gate, unit, text) in [
            (0.1504, "<= 0.15", Unit::Percent, "15.04"),
            (0.1496, "<= 0.15", Unit::Percent, "15"),
            (1.1217, "0.88 to 1.12", Unit::None, "1.122"),
            (1.1217, "0.8 to 1.2", Unit::None, "1.12"),
            (-10.04, "-10 to 10", Unit::Degrees, "-10.04"),
        ] {
            let figure = figure("x", measured, gate, false);
            assert_eq!(judged(&figure, unit).unwrap(), text);
        }
    }

    #[test]
    fn unknown_names_are_errors() {
        let report = "<!-- ANCHOR: waves -->\n<!-- ANCHOR_END: waves -->\n";
        for (from, to, part) in [
            ("figure = \"loss\"", "figure = \"gain\"", "gain"),
            ("case = \"wave\"", "case = \"tide\"", "tide"),
            ("[waves]", "[tides]", "no anchor tides"),
            ("head", "heading", "specification"),
            ("variant = \"dfsph\"", "variant = \"dfhsp\"", "dfhsp"),
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
            (-0.04, Unit::Degrees, "0.0"),
        ] {
            assert_eq!(number(value, unit, 0), text);
        }
        for (gate, unit, text) in [
            ("<= 0.07", Unit::Percent, "7 %"),
            ("-0.1 to 0.1", Unit::Percent, "10 %"),
            ("0.95 to 1.05", Unit::None, "0.95 to 1.05"),
            ("-10 to 10", Unit::Degrees, "10"),
            ("control > 0.03", Unit::Percent, "above 3 %"),
        ] {
            assert_eq!(Limit::parse(gate).unwrap().words(unit), text);
        }
        assert!(Limit::parse("at most a few").is_err());
    }
}
