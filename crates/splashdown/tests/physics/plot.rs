//! A chart as SVG: dots are measured, lines are simulated.

use plotters::prelude::*;
use plotters::style::register_font;

use super::figures::Series;

const SIZE: (u32, u32) = (760, 360);
/// Readable on white, and distinguishable with colour vision deficiency (Okabe & Ito 2008).
const COLOURS: [RGBColor; 4] =
    [RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(0, 158, 115), RGBColor(204, 121, 167)];

/// Draws a chart whose axes cover all data.
pub fn draw(title: &str, axes: [&str; 2], measured: &Series, simulated: &[(&str, &Series)]) -> String {
    let all = || simulated.iter().flat_map(|(_, series)| series.iter()).chain(measured);
    let range = |value: fn(&(f64, f64)) -> f64| {
        let (low, high) =
            all().map(value).fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
        let margin = 0.03 * (high - low).max(1e-9);
        low - margin..high + margin
    };
    // plotters has no built-in font.
    assert!(register_font("sans-serif", FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT).is_ok());
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        area.fill(&WHITE).unwrap();
        let mut chart = ChartBuilder::on(&area)
            .caption(title, ("sans-serif", 18))
            .margin(10)
            .x_label_area_size(40)
            .y_label_area_size(70)
            .build_cartesian_2d(range(|p| p.0), range(|p| p.1))
            .unwrap();
        chart.configure_mesh().x_desc(axes[0]).y_desc(axes[1]).light_line_style(WHITE).draw().unwrap();
        for ((name, series), colour) in simulated.iter().zip(COLOURS.iter().cycle()) {
            let line = LineSeries::new(series.iter().copied(), colour.stroke_width(2));
            let sample = move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2));
            chart.draw_series(line).unwrap().label(*name).legend(sample);
        }
        let dots = measured.iter().map(|&point| Circle::new(point, 3, BLACK.filled()));
        let sample = |(x, y)| Circle::new((x + 9, y), 3, BLACK.filled());
        chart.draw_series(dots).unwrap().label("measured").legend(sample);
        let labels = chart.configure_series_labels();
        { labels }.background_style(WHITE.mix(0.8)).border_style(BLACK.mix(0.2)).draw().unwrap();
        area.present().unwrap();
    }
    text
}
