//! Drawing: one panel per unit, stacked, with a common time axis.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::register_font;

use super::table::{Curve, unit};

/// The font family in SVG files. The program that displays the file chooses the font.
const FONT: &str = "sans-serif";

/// Readable on white and distinguishable with colour-vision deficiency (Okabe & Ito 2008).
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(90, 90, 90),
];

/// Curves of one unit.
#[derive(Debug)]
pub struct Panel {
    /// The quantity with its unit; for several quantities the unit alone.
    label: String,
    curves: Vec<Curve>,
}

impl Panel {
    /// Number of curves.
    pub fn len(&self) -> usize {
        self.curves.len()
    }
}

/// Groups curves into panels by unit, in order of appearance.
pub fn panels(curves: Vec<Curve>) -> Vec<Panel> {
    let mut panels: Vec<Panel> = Vec::new();
    for curve in curves {
        match panels.iter_mut().find(|panel| unit(&panel.label) == unit(&curve.quantity)) {
            Some(panel) => {
                if panel.label != curve.quantity {
                    panel.label = unit(&curve.quantity).to_owned();
                }
                panel.curves.push(curve);
            }
            None => panels.push(Panel { label: curve.quantity.clone(), curves: vec![curve] }),
        }
    }
    panels
}

/// The text of an SVG file.
///
/// # Errors
/// The message of the drawing library.
pub fn svg(panels: &[Panel], title: Option<&str>, size: (u32, u32)) -> Result<String, String> {
    prepare()?;
    let mut text = String::new();
    draw(&SVGBackend::with_string(&mut text, size).into_drawing_area(), panels, title)?;
    Ok(text)
}

/// RGBA pixels, row by row from the top.
///
/// # Errors
/// The message of the drawing library.
pub fn pixels(panels: &[Panel], title: Option<&str>, size: (u32, u32)) -> Result<Vec<u8>, String> {
    prepare()?;
    let mut rgb = vec![255; size.0 as usize * size.1 as usize * 3];
    draw(&BitMapBackend::with_buffer(&mut rgb, size).into_drawing_area(), panels, title)?;
    Ok(rgb.as_chunks::<3>().0.iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect())
}

/// Registers the built-in font, so that text looks the same on every machine.
fn prepare() -> Result<(), String> {
    let font = epaint_default_fonts::UBUNTU_LIGHT;
    register_font(FONT, FontStyle::Normal, font).map_err(|_| "the built-in font cannot be read".to_owned())
}

fn draw<DB: DrawingBackend>(
    area: &DrawingArea<DB, Shift>,
    panels: &[Panel],
    title: Option<&str>,
) -> Result<(), String> {
    let message = |error: DrawingAreaErrorKind<DB::ErrorType>| format!("the plot cannot be drawn: {error}");
    area.fill(&WHITE).map_err(message)?;
    let titled;
    let area = match title {
        Some(title) => {
            titled = area.titled(title, (FONT, 22)).map_err(message)?;
            &titled
        }
        None => area,
    };
    let times = panels.iter().flat_map(|panel| &panel.curves).flat_map(|curve| &curve.points);
    let times = range(times.map(|point| point.0), 0.0);
    let areas = area.split_evenly((panels.len().max(1), 1));
    let last = panels.len().saturating_sub(1);
    for (number, (area, panel)) in areas.iter().zip(panels).enumerate() {
        draw_panel(area, panel, times.clone(), number == last).map_err(message)?;
    }
    area.present().map_err(message)
}

fn draw_panel<DB: DrawingBackend>(
    area: &DrawingArea<DB, Shift>,
    panel: &Panel,
    times: Range<f64>,
    is_last: bool,
) -> Result<(), DrawingAreaErrorKind<DB::ErrorType>> {
    let values = panel.curves.iter().flat_map(|curve| &curve.points);
    let values = range(values.map(|point| point.1), 0.05);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(if is_last { 44 } else { 26 })
        .y_label_area_size(84)
        .build_cartesian_2d(times.clone(), values.clone())?;
    let (x_step, y_step) = (times.end - times.start, values.end - values.start);
    let (x_label, y_label) = (|v: &f64| label(*v, x_step), |v: &f64| label(*v, y_step));
    let mut mesh = chart.configure_mesh();
    mesh.light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.12))
        .label_style((FONT, 14))
        .axis_desc_style((FONT, 16))
        .x_label_formatter(&x_label)
        .y_label_formatter(&y_label)
        .y_desc(panel.label.as_str());
    if is_last {
        mesh.x_desc(panel.curves.first().map_or("", |curve| curve.against.as_str()));
    }
    mesh.draw()?;
    for (curve, colour) in panel.curves.iter().zip(COLOURS.iter().cycle()) {
        let style = colour.stroke_width(2);
        let sample = move |(x, y)| PathElement::new([(x, y), (x + 20, y)], style);
        // A curve is interrupted at gaps. A single point between two gaps is drawn as a dot.
        let is_gap = |point: &(f64, f64)| !(point.0.is_finite() && point.1.is_finite());
        let mut runs: Vec<&[(f64, f64)]> = curve.points.split(is_gap).filter(|run| !run.is_empty()).collect();
        runs.sort_by_key(|run| std::cmp::Reverse(run.len()));
        for (number, run) in runs.iter().enumerate() {
            let series = match run {
                [point] => chart.draw_series([Circle::new(*point, 2, colour.filled())])?,
                _ => chart.draw_series(LineSeries::new(run.iter().copied(), style))?,
            };
            if number == 0 {
                series.label(curve.name.as_str()).legend(sample);
            }
        }
    }
    let mut legend = chart.configure_series_labels();
    legend.position(SeriesLabelPosition::UpperRight).label_font((FONT, 14)).margin(8);
    legend.background_style(WHITE.mix(0.85)).border_style(BLACK.mix(0.2)).draw()
}

/// The range of the finite numbers with a margin on both sides; for equal numbers a range around them; else 0 to 1.
fn range(values: impl Iterator<Item = f64>, margin: f64) -> Range<f64> {
    // With larger numbers the width of the range would overflow.
    let finite = values.filter(|value| value.is_finite() && value.abs() < 1e300);
    let (low, high) = finite.fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return 0.0..1.0;
    }
    let width = high - low;
    // Numbers that differ only by rounding get a wider range, so that its labels differ.
    if width <= 1e-9 * low.abs().max(high.abs()).max(1e-30) {
        let around = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
        return low - around..high + around;
    }
    low - margin * width..high + margin * width
}

/// A label of an axis, with enough digits to distinguish neighbouring labels.
fn label(value: f64, width: f64) -> String {
    // The drawing library adds up steps, so that zero becomes a tiny number.
    let value = if value.abs() < 1e-9 * width { 0.0 } else { value };
    let largest = value.abs().max(width);
    if largest >= 1e6 || width < 1e-4 {
        return format!("{value:.2e}");
    }
    let decimals = (2.0 - width.log10()).floor().clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(name: &str, quantity: &str, points: &[(f64, f64)]) -> Curve {
        Curve {
            name: name.to_owned(),
            quantity: quantity.to_owned(),
            against: "time (s)".to_owned(),
            points: points.to_vec(),
        }
    }

    #[test]
    fn curves_with_the_same_unit_share_a_panel() {
        let made = panels(vec![
            curve("a", "height (m)", &[(0.0, 1.0)]),
            curve("b", "pressure (Pa)", &[(0.0, 1.0)]),
            curve("c", "height (m)", &[(0.0, 1.0)]),
            curve("d", "depth (m)", &[(0.0, 1.0)]),
        ]);
        let labels: Vec<&str> = made.iter().map(|panel| panel.label.as_str()).collect();
        assert_eq!(labels, ["(m)", "pressure (Pa)"]);
        assert_eq!(made[0].curves.len(), 3);
    }

    #[test]
    fn pictures_have_axes_units_and_a_legend() {
        let points: Vec<_> = (0..50).map(|i| (0.1 * f64::from(i), f64::from(i).sin())).collect();
        let gaps = [(0.0, 0.5), (1.0, f64::NAN), (2.0, 0.25), (3.0, 0.75)];
        let panels = panels(vec![
            curve("left <gauge>", "height (m)", &points),
            curve("right", "height (m)", &gaps),
            curve("wall", "pressure (Pa)", &[(0.0, 1e5), (5.0, 1e5)]),
        ]);
        let text = svg(&panels, Some("A dam breaks"), (800, 600)).unwrap();
        for word in
            ["left &lt;gauge&gt;", "right", "wall", "height (m)", "pressure (Pa)", "time (s)", "A dam breaks"]
        {
            assert!(text.contains(word), "{word} is missing");
        }
        roxmltree::Document::parse(&text).unwrap();
        let drawn = pixels(&panels, None, (800, 600)).unwrap();
        assert_eq!(drawn.len(), 800 * 600 * 4);
        let blue = drawn.chunks_exact(4).filter(|pixel| pixel[..3] == [0, 114, 178]).count();
        assert!(blue > 300, "{blue} pixels of the first curve");
        // Text is drawn: the topmost rows contain only the title.
        let titled = pixels(&panels, Some("A dam breaks"), (800, 600)).unwrap();
        let dark = |drawn: &[u8]| {
            let rows = drawn[..4 * 800 * 10].chunks_exact(4);
            rows.filter(|pixel| pixel[..3].iter().all(|&c| c < 100)).count()
        };
        assert_eq!(dark(&drawn), 0);
        assert!(dark(&titled) > 50, "{} dark pixels", dark(&titled));
    }

    #[test]
    fn ranges_and_labels_are_readable() {
        assert_eq!(range([f64::NAN].into_iter(), 0.1), 0.0..1.0);
        assert_eq!(range([1e308, -1e308].into_iter(), 0.1), 0.0..1.0);
        assert_eq!(range([2.0, 2.0].into_iter(), 0.1), 1.8..2.2);
        assert_eq!(label(0.30000000000000004, 1.0), "0.30");
        assert_eq!(label(1e-18, 1.0), "0.00");
        assert_eq!(label(12_345.0, 2000.0), "12345");
        assert_eq!(label(2.5e6, 1e6), "2.50e6");
    }
}
