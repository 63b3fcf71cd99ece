//! Formatting numbers for people.

/// An integer with groups of three digits: 65,536.
pub fn count(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A count with its noun: 1 frame, 2 frames, 65,536 particles.
pub fn counted(number: u64, noun: &str) -> String {
    format!("{} {noun}{}", count(number), if number == 1 { "" } else { "s" })
}

/// A volume: 2.00 m^3, 66.6 l, 0.960 mm^3.
pub fn volume(cubic_metres: f64) -> String {
    let (factor, unit) = match cubic_metres.abs() {
        x if x >= 0.9995 => (1.0, "m^3"),
        x if x >= 0.999_5e-3 || x == 0.0 => (1e3, "l"),
        x if x >= 0.999_5e-6 => (1e6, "ml"),
        _ => (1e9, "mm^3"),
    };
    format!("{} {unit}", three_digits(cubic_metres * factor))
}

/// Bytes in powers of 1000: 1.2 GB.
pub fn bytes(number: u64) -> String {
    if number < 1000 { format!("{number} B") } else { format!("{}B", scaled(number as f64)) }
}

/// Three digits and a prefix: 5.21 M, 640 k, 12.3.
pub fn scaled(number: f64) -> String {
    let steps = [(1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k")];
    for (unit, prefix) in steps {
        // 999.96 k is shown as 1.00 M, not as 1000 k.
        if number.abs() >= unit * 0.9995 {
            return format!("{} {prefix}", three_digits(number / unit));
        }
    }
    format!("{} ", three_digits(number))
}

/// About three significant digits without an exponent, for numbers that are not tiny.
pub fn three_digits(number: f64) -> String {
    // A number that rounds up to a power of ten gets as many decimals as that power.
    let decimals = match number.abs() {
        x if x >= 99.95 => 0,
        x if x >= 9.995 => 1,
        x if x >= 0.9995 => 2,
        x if x >= 0.09995 => 3,
        x if x >= 0.009_995 => 4,
        x if x >= 0.000_999_5 => 5,
        0.0 => 0,
        _ => return format!("{number:.2e}"),
    };
    format!("{number:.decimals$}")
}

/// Seconds as a duration: 0.42 s, 2 min 31 s, 3 h 5 min.
pub fn duration(seconds: f64) -> String {
    if !seconds.is_finite() || seconds < 0.0 {
        return "unknown".to_owned();
    }
    let whole = seconds.round() as u64;
    match whole {
        0..=9 => format!("{seconds:.2} s"),
        10..=59 => format!("{seconds:.1} s"),
        60..=3599 => format!("{} min {} s", whole / 60, whole % 60),
        3600..=172_799 => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
        _ => format!("{} days", count(whole / 86_400)),
    }
}

/// A count of particles: 65536, 64K (1024 each), 1M.
pub fn parse_count(text: &str) -> Result<u32, String> {
    let advice = "give an integer from 1 to 100,000,000; K and M multiply by 1024 and 1024 * 1024, as in 64K";
    let upper = text.trim().to_ascii_uppercase();
    let (digits, factor) = match upper.as_bytes().last() {
        Some(b'K') => (&upper[..upper.len() - 1], 1024),
        Some(b'M') => (&upper[..upper.len() - 1], 1024 * 1024),
        _ => (upper.as_str(), 1),
    };
    let number: u32 = digits.parse().map_err(|_| format!("`{text}` is not a count: {advice}"))?;
    match number.checked_mul(factor) {
        Some(count @ 1..=100_000_000) => Ok(count),
        _ => Err(format!("`{text}` is out of range: {advice}")),
    }
}

#[cfg(test)]
mod tests {
    use super::{bytes, count, counted, duration, parse_count, scaled, three_digits, volume};

    #[test]
    fn digits_are_grouped_in_threes() {
        assert_eq!(count(0), "0");
        assert_eq!(count(999), "999");
        assert_eq!(count(65_536), "65,536");
        assert_eq!(count(1_000_000), "1,000,000");
    }

    #[test]
    fn numbers_that_round_up_get_the_next_prefix() {
        assert_eq!(scaled(999.96e3), "1.00 M");
        assert_eq!(scaled(5.214e6), "5.21 M");
        assert_eq!(scaled(12.0), "12.0 ");
        assert_eq!(bytes(1_234_567), "1.23 MB");
        assert_eq!(bytes(12), "12 B");
        assert_eq!(three_digits(0.0), "0");
        assert_eq!(three_digits(0.000_12), "1.20e-4");
    }

    #[test]
    fn nouns_are_singular_or_plural() {
        assert_eq!(counted(1, "frame"), "1 frame");
        assert_eq!(counted(0, "frame"), "0 frames");
        assert_eq!(counted(66_560, "particle"), "66,560 particles");
    }

    #[test]
    fn volumes_have_suitable_units() {
        assert_eq!(volume(1.95e6), "1950000 m^3");
        assert_eq!(volume(0.2538), "254 l");
        assert_eq!(volume(1.2e-5), "12.0 ml");
        assert_eq!(volume(9.6e-13), "9.60e-4 mm^3");
        assert_eq!(volume(0.0), "0 l");
    }

    #[test]
    fn durations_have_suitable_units() {
        assert_eq!(duration(0.424), "0.42 s");
        assert_eq!(duration(151.2), "2 min 31 s");
        assert_eq!(duration(11_100.0), "3 h 5 min");
        assert_eq!(duration(f64::NAN), "unknown");
        assert_eq!(duration(f64::INFINITY), "unknown");
    }

    #[test]
    fn counts_accept_k_and_m() {
        assert_eq!(parse_count("64k"), Ok(65_536));
        assert_eq!(parse_count("1M"), Ok(1_048_576));
        assert_eq!(parse_count("8000"), Ok(8000));
        for wrong in ["", "0", "K", "-1", "1.5K", "999M", "99999999999"] {
            assert!(parse_count(wrong).is_err(), "{wrong:?}");
        }
    }
}
