//! Minimal JSON reading and statistics: a number from a line of JSON, and the median.

use anyhow::{Context, Result};

/// The first number with this name.
///
/// # Errors
/// If the name is missing or its value is not a number.
pub fn number(json: &str, name: &str) -> Result<f64> {
    let key = format!("\"{name}\":");
    let place = json.find(&key).with_context(|| format!("`{name}` is missing in {json}"))?;
    let rest = json[place + key.len()..].trim_start().trim_start_matches('[');
    let end = rest.find([',', '}', ']']).unwrap_or(rest.len());
    let text = rest[..end].trim();
    text.parse().with_context(|| format!("`{name}` is `{text}`, not a number"))
}

/// The median; for an even number of values, the mean of the middle two. NaN without values.
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
    fn medians_of_odd_and_even_counts() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&[]).is_nan());
    }
}
