//! Numbers out of one line of JSON, and what becomes of several: the little that is needed here of either.

use anyhow::{Context, Result};

/// The first number that has this name.
///
/// # Errors
/// If there is none.
pub fn number(json: &str, name: &str) -> Result<f64> {
    let key = format!("\"{name}\":");
    let place = json.find(&key).with_context(|| format!("`{name}` is missing in {json}"))?;
    let rest = json[place + key.len()..].trim_start().trim_start_matches('[');
    let end = rest.find([',', '}', ']']).unwrap_or(rest.len());
    let text = rest[..end].trim();
    text.parse().with_context(|| format!("`{name}` is `{text}`, not a number"))
}

/// The median: of an even number of values, the mean of the two in the middle. NaN of none.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match (sorted.len(), sorted.len() / 2) {
        (0, _) => f64::NAN,
        (length, middle) if length % 2 == 1 => sorted[middle],
        (_, middle) => (sorted[middle - 1] + sorted[middle]) / 2.0,
    }
}

#[cfg(test)]
mod tests {
    use super::{median, number};

    #[test]
    fn numbers_are_found_by_their_whole_name() {
        let json = r#"{"particles":64000,"seconds": 1.5e-3, "surface_seconds":0.25,"neighbours": [28.5, 3],"name":"x","last":7}"#;
        for (name, value) in [
            ("particles", 64e3),
            ("seconds", 1.5e-3),
            ("surface_seconds", 0.25),
            ("neighbours", 28.5),
            ("last", 7.0),
        ] {
            assert_eq!(number(json, name).unwrap(), value, "{name}");
        }
        for wrong in ["name", "none", "second"] {
            assert!(number(json, wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn medians_stand_in_the_middle() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&[]).is_nan());
    }
}
