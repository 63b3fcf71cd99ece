//! Tables of numbers as probes write them: a line of names with units, then rows.

use std::path::Path;

use crate::exit::{Exit, Failure};

/// A column against the first one.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What it is called in the legend.
    pub name: String,
    /// What is measured, with its unit: `height (m)`.
    pub quantity: String,
    /// What the first column is, with its unit: `time (s)`.
    pub against: String,
    /// Points; a number that is missing is NaN.
    pub points: Vec<(f64, f64)>,
}

/// The curves of a file. Their names are the file's, with the column's where there are several.
///
/// # Errors
/// If the file cannot be read, or is no table of numbers below names; the line is told.
pub fn read(path: &Path) -> Result<Vec<Curve>, Failure> {
    let wrong = |reason: String| Failure::new(Exit::Scene, format!("`{}`: {reason}", path.display()));
    if path.is_dir() {
        let files = path.join("*.csv");
        return Err(wrong(format!("it is a folder; name the tables in it, as in {}", files.display())));
    }
    let bytes = std::fs::read(path).map_err(|error| wrong(error.to_string()))?;
    let text = String::from_utf8_lossy(&bytes);
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    parse(&text, &stem).map_err(wrong)
}

fn parse(text: &str, stem: &str) -> Result<Vec<Curve>, String> {
    let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let names = fields(lines.next().ok_or("it is empty")?.1);
    if names.len() < 2 || names.iter().all(|name| name.parse::<f64>().is_ok()) {
        return Err(
            "its first line does not name two columns or more, such as `time (s),height (m)`".to_owned()
        );
    }
    let mut rows = Vec::new();
    for (number, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let fields = fields(line);
        if fields.len() != names.len() {
            let (given, wanted) = (fields.len(), names.len());
            return Err(format!("line {} has {given} fields, its first line names {wanted}", number + 1));
        }
        let numbers: Result<Vec<f64>, String> = fields
            .iter()
            .map(|field| match field.trim() {
                "" => Ok(f64::NAN),
                word => {
                    word.parse().map_err(|_| format!("line {}: `{word:.24}` is not a number", number + 1))
                }
            })
            .collect();
        rows.push(numbers?);
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

/// The unit of a quantity with its brackets: what curves of one panel have in common.
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

/// The fields of a line, quoted ones without their quotes.
fn fields(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    let (mut quoted, mut chars) = (false, line.trim_end_matches('\r').chars().peekable());
    while let Some(c) = chars.next() {
        match c {
            // Two in a row are one of the text.
            '"' if quoted && chars.peek() == Some(&'"') => {
                chars.next();
                push(&mut fields, '"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            _ => push(&mut fields, c),
        }
    }
    fields
}

fn push(fields: &mut [String], c: char) {
    if let Some(field) = fields.last_mut() {
        field.push(c);
    }
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
    fn what_is_no_table_is_told() {
        for (text, reason) in [
            ("", "empty"),
            ("1,2\n3,4\n", "first line"),
            ("words\n", "first line"),
            ("t,h\n", "no rows"),
            ("t,h\n1,2\n1,2,3\n", "line 3 has 3 fields"),
            ("t,h\n1,two\n", "line 2: `two`"),
        ] {
            let message = parse(text, "a").unwrap_err();
            assert!(message.contains(reason), "{message}");
        }
    }
}
