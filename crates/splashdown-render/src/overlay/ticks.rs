//! Round tick values along an axis, and their labels.

/// About `count` round values between `low` and `high`, and their step: 1, 2, 2.5 or 5 times a
/// power of ten.
pub(crate) fn ticks(low: f64, high: f64, count: usize) -> (Vec<f64>, f64) {
    let rough = (high - low) / count.max(2) as f64;
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|step| step * (1.0 + 1e-9) >= rough)
        .unwrap_or(10.0 * power);
    let first = (low / step - 1e-6).ceil() as i64;
    let last = (high / step + 1e-6).floor() as i64;
    ((first..=last).map(|i| i as f64 * step).collect(), step)
}

/// A number with as many decimals as its step needs, with U+2212 as minus sign.
pub(crate) fn label(value: f64, step: f64) -> String {
    let mut decimals = 0;
    while decimals < 9
        && (step * 10f64.powi(decimals)).fract().min(1.0 - (step * 10f64.powi(decimals)).fract()) > 1e-6
    {
        decimals += 1;
    }
    let text = format!("{value:.*}", decimals as usize);
    match text.strip_prefix('-') {
        Some(positive) if positive.chars().any(|c| ('1'..='9').contains(&c)) => format!("−{positive}"),
        Some(positive) => positive.to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64) -> Vec<String> {
        let (values, step) = ticks(low, high, 6);
        values.into_iter().map(|value| label(value, step)).collect()
    }

    #[test]
    fn ticks_are_round_and_labels_have_the_required_decimals() {
        assert_eq!(labels(0.0, 5.0), ["0", "1", "2", "3", "4", "5"]);
        assert_eq!(labels(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(990.0, 1030.0), ["990", "1000", "1010", "1020", "1030"]);
        assert_eq!(labels(-0.11, 0.11), ["−0.10", "−0.05", "0.00", "0.05", "0.10"]);
    }

    #[test]
    fn the_number_of_ticks_is_bounded() {
        for i in 0..400 {
            let high = 1.07f64.powi(i - 200);
            for low in [0.0, -high, 0.9 * high] {
                let (values, _) = ticks(low, high, 6);
                assert!((1..=8).contains(&values.len()), "{low} to {high}: {values:?}");
                assert!(values.iter().all(|v| *v >= low - 1e-5 * high && *v <= high * (1.0 + 1e-5)));
            }
        }
    }
}
