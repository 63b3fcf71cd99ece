//! A chart as SVG: dots are measurements or theory, lines are simulations.

use std::fmt::Write as _;

const WIDTH: f64 = 860.0;
const HEIGHT: f64 = 360.0;
/// Margins of the plotting area: left, top, right and bottom.
const MARGINS: [f64; 4] = [70.0, 34.0, 130.0, 46.0];
/// Readable on white, and distinguishable with colour vision deficiency (Okabe & Ito 2008).
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

/// One axis: the range of its data, extended by a margin, and its ticks.
struct Axis {
    low: f64,
    high: f64,
    step: f64,
}

impl Axis {
    fn new(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
        let margin = 0.03 * (high - low).max(1e-9);
        let (low, high) = (low - margin, high + margin);
        // One, two or five times a power of ten, with at most eight ticks.
        let power = 10.0_f64.powf(((high - low) / 8.0).log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].map(|k| k * power).into_iter().find(|step| (high - low) / step <= 8.0);
        Self { low, high, step: step.unwrap_or(10.0 * power) }
    }

    /// The share of the axis below a value.
    fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// The ticks and their labels.
    fn ticks(&self) -> Vec<(f64, String)> {
        let digits = (-self.step.log10().floor()).max(0.0) as usize;
        let first = (self.low / self.step).ceil() as i64;
        let last = (self.high / self.step).floor() as i64;
        let label =
            |value: f64| if digits > 5 { format!("{value:.1e}") } else { format!("{value:.digits$}") };
        (first..=last).map(|k| k as f64 * self.step).map(|value| (value, label(value))).collect()
    }
}

/// Draws a chart whose axes cover all data.
pub fn draw(
    title: &str,
    names: &[String; 2],
    dots: &[(f64, f64)],
    curves: &[(&str, &[(f64, f64)])],
) -> String {
    let all = || curves.iter().flat_map(|(_, points)| points.iter()).chain(dots);
    let [x_axis, y_axis] = [Axis::new(all().map(|p| p.0)), Axis::new(all().map(|p| p.1))];
    let [left, top, right, bottom] = MARGINS;
    let (wide, high) = (WIDTH - left - right, HEIGHT - top - bottom);
    let x = |value: f64| left + wide * x_axis.share(value);
    let y = |value: f64| top + high * (1.0 - y_axis.share(value));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"sans-serif\" \
         font-size=\"13\">\n<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#fff\"/>\n"
    );
    let mut text = |x: f64, y: f64, more: &str, words: &str| {
        let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\"{more}>{}</text>", escaped(words));
    };
    text(left, 20.0, " font-size=\"15\"", title);
    text(left + 0.5 * wide, HEIGHT - 8.0, " text-anchor=\"middle\"", &names[0]);
    let turned = format!(" text-anchor=\"middle\" transform=\"rotate(-90 14 {:.1})\"", top + 0.5 * high);
    text(14.0, top + 0.5 * high, &turned, &names[1]);
    for (value, label) in x_axis.ticks() {
        text(x(value), top + high + 18.0, " text-anchor=\"middle\"", &label);
    }
    for (value, label) in y_axis.ticks() {
        text(left - 6.0, y(value) + 4.0, " text-anchor=\"end\"", &label);
    }
    for (k, (name, _)) in curves.iter().enumerate() {
        let colour = COLOURS[k % COLOURS.len()];
        let more = format!(" fill=\"{colour}\"");
        text(left + wide + 10.0, top + 18.0 + 17.0 * k as f64, &more, name);
    }
    let mut line = |from: (f64, f64), to: (f64, f64)| {
        let _ = writeln!(
            svg,
            "<path d=\"M{:.1} {:.1}L{:.1} {:.1}\" stroke=\"#ddd\"/>",
            from.0, from.1, to.0, to.1
        );
    };
    for (value, _) in x_axis.ticks() {
        line((x(value), top), (x(value), top + high));
    }
    for (value, _) in y_axis.ticks() {
        line((left, y(value)), (left + wide, y(value)));
    }
    for (k, (_, points)) in curves.iter().enumerate() {
        let path: Vec<String> = points.iter().map(|p| format!("{:.1} {:.1}", x(p.0), y(p.1))).collect();
        let colour = COLOURS[k % COLOURS.len()];
        let _ = writeln!(
            svg,
            "<path d=\"M{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\"/>",
            path.join("L")
        );
    }
    for p in dots {
        let _ = writeln!(svg, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"2.2\" fill=\"#333\"/>", x(p.0), y(p.1));
    }
    svg + "</svg>\n"
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let axis = Axis::new([0.0, 3.7].into_iter());
        let labels: Vec<String> = axis.ticks().into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["0.0", "0.5", "1.0", "1.5", "2.0", "2.5", "3.0", "3.5"]);
    }

    #[test]
    fn every_point_is_inside_the_frame() {
        let axes = ["x".to_owned(), "y".to_owned()];
        let svg = draw("a < b", &axes, &[(0.0, -1.0), (2.0, 5.0)], &[("one", &[(1.0, 1.0), (2.0, 2.0)])]);
        assert!(svg.contains("a &lt; b"), "{svg}");
        let numbers = svg.split("cx=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
        let inside = |x: f64| (MARGINS[0]..=WIDTH - MARGINS[2]).contains(&x);
        assert!(numbers.map(|text| text.parse().unwrap()).all(inside), "{svg}");
        assert_eq!(svg.matches("<circle").count(), 2);
    }
}
