//! Tables of numbers in the format of the probes: a line of column names with units, then rows.

use std::path::Path;

use crate::exit::{Exit, Failure};

/// A column against the first one.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Its name in the legend.
    pub name: String,
    /// The quantity with its unit: `height (m)`.
    pub quantity: String,
    /// The first column's quantity with its unit: `time (s)`.
    pub against: String,
    /// Points; a missing number is NaN.
    pub points: Vec<(f64, f64)>,
}

/// Reads the curves of a file. A curve has the name of the file, and also that of its column if there are several.
///
/// # Errors
/// If the file cannot be read, or is not a line of names followed by rows of numbers; the message contains the line.
pub fn read(path: &Path) -> Result<Vec<Curve>, Failure> {
    let wrong = |reason: String| Failure::new(Exit::Scene, format!("`{}`: {reason}", path.display()));
    if path.is_dir() {
        let files = path.join("*.csv");
        return Err(wrong(format!("it is a folder; name the tables in it, as in {}", files.display())));
    }
    if path.metadata().is_ok_and(|data| !data.is_file()) {
        return Err(wrong("it is a pipe or a device; save the table to a file first".to_owned()));
    }
    let bytes = std::fs::read(path).map_err(|error| wrong(error.to_string()))?;
    let text = String::from_utf8_lossy(&bytes);
    let stem = path.file_stem().map(|stem| printable(&stem.to_string_lossy())).unwrap_or_default();
    parse(&text, &stem).map_err(wrong)
}

fn parse(text: &str, stem: &str) -> Result<Vec<Curve>, String> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(text.as_bytes());
    let mut records = reader.records();
    let names = records.next().ok_or("it is empty")?.map_err(|error| error.to_string())?;
    let names: Vec<String> = names.iter().map(printable).collect();
    if names.len() < 2 || names.iter().all(|name| name.parse::<f64>().is_ok()) {
        return Err(
            "its first line does not name two columns or more, such as `time (s),height (m)`".to_owned()
        );
    }
    let mut rows = Vec::new();
    for record in records {
        let record = record.map_err(|error| error.to_string())?;
        let line = record.position().map_or(0, |position| line_at(text, position.byte()));
        if record.len() == 1 && record[0].trim().is_empty() {
            continue;
        }
        if record.len() != names.len() {
            let (given, wanted) = (record.len(), names.len());
            return Err(format!("line {line} has {given} fields, but its first line names {wanted} columns"));
        }
        let number = |field: &str| match field.trim() {
            "" => Ok(f64::NAN),
            word => word.parse().map_err(|_| format!("line {line}: `{word:.24}` is not a number")),
        };
        rows.push(record.iter().map(number).collect::<Result<Vec<f64>, String>>()?);
    }
    if rows.is_empty() {
        return Err("it has no rows yet".to_owned());
    }
    let columns = names.len() - 1;
    let curve = |(column, quantity): (usize, &String)| Curve {
        name: if columns == 1 { stem.to_owned() } else { format!("{stem}: {}", without_unit(quantity)) },
        quantity: quantity.clone(),
        against: names[0].clone(),
        points: rows.iter().map(|row| (row[0], row[column])).collect(),
    };
    Ok(names.iter().enumerate().skip(1).map(curve).collect())
}

/// A name without characters that cannot be drawn and that XML does not allow.
pub fn printable(name: &str) -> String {
    let is_drawn = |c: &char| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    name.chars().map(|c| if is_drawn(&c) { c } else { '\u{fffd}' }).collect()
}

/// The line, from 1, of the record at this byte. The reader reports the position before the blank lines that it skips.
fn line_at(text: &str, byte: u64) -> usize {
    let (before, rest) = text.split_at_checked(byte as usize).unwrap_or((text, ""));
    let skipped = rest.len() - rest.trim_start_matches(['\r', '\n']).len();
    1 + before.matches('\n').count() + rest[..skipped].matches('\n').count()
}

/// The unit of a quantity with its brackets. Curves with the same unit share a panel.
pub fn unit(quantity: &str) -> &str {
    quantity.rfind('(').filter(|_| quantity.ends_with(')')).map_or(quantity, |at| &quantity[at..])
}

/// A quantity without its unit.
pub fn without_unit(quantity: &str) -> &str {
    quantity
        .strip_suffix(unit(quantity))
        .map(str::trim_end)
        .filter(|name| !name.is_empty())
        .unwrap_or(quantity)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_become_curves() {
        let text = "time (s),\"force, x (N)\",\"torque \"\"z\"\" (N m)\"\n0,1,2\r\n0.5,,-2e3\n\n";
        let curves = parse(text, "gate").unwrap();
        assert_eq!(curves[0].name, "gate: force, x");
        assert_eq!((curves[0].quantity.as_str(), curves[0].against.as_str()), ("force, x (N)", "time (s)"));
        assert!(curves[0].points[1].1.is_nan());
        assert_eq!(curves[1].name, "gate: torque \"z\"");
        assert_eq!(curves[1].points, [(0.0, 2.0), (0.5, -2000.0)]);
        assert_eq!(parse("t,h\n1,2\n", "a").unwrap()[0].name, "a");
        assert_eq!([unit("height (m)"), unit("height"), unit("(m)")], ["(m)", "height", "(m)"]);
        assert_eq!([without_unit("height (m)"), without_unit("height")], ["height", "height"]);
    }

    #[test]
    fn malformed_tables_are_refused() {
        for (text, reason) in [
            ("", "empty"),
            ("1,2\n3,4\n", "first line"),
            ("words\n", "first line"),
            ("t,h\n", "no rows"),
            ("t,h\n1,2\n1,2,3\n", "line 3 has 3 fields"),
            ("t,h\n1,two\n", "line 2: `two`"),
            ("t,h\n\n \n1,2\n\n3,two\n", "line 6: `two`"),
            ("t,h\r\n\r\n1,2\r\n\r\n3,two", "line 5: `two`"),
        ] {
            let message = parse(text, "a").unwrap_err();
            assert!(message.contains(reason), "{message}");
        }
    }
}
