//! A chart as SVG: dots are measurements or theory, lines are simulations.

use anyhow::{Context as _, Result, anyhow};
use plotters::prelude::*;
use plotters::style::register_font;

const SIZE: (u32, u32) = (860, 360);
/// Readable on white, and distinguishable with colour vision deficiency (Okabe & Ito 2008).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// Points of a curve.
type Points = [(f64, f64)];

/// Draws a chart whose axes cover all data.
pub fn draw(title: &str, axes: &[String; 2], dots: &Points, curves: &[(&str, &Points)]) -> Result<String> {
    // plotters has no built-in font.
    register_font("sans-serif", FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT)
        .map_err(|_| anyhow!("the font of charts is invalid"))?;
    let mut text = String::new();
    write(&mut text, title, axes, dots, curves).with_context(|| format!("cannot draw {title:?}"))?;
    Ok(text)
}

fn write(
    text: &mut String,
    title: &str,
    axes: &[String; 2],
    dots: &Points,
    curves: &[(&str, &Points)],
) -> Result<()> {
    let all = || curves.iter().flat_map(|(_, points)| points.iter()).chain(dots);
    let range = |value: fn(&(f64, f64)) -> f64| {
        let (low, high) =
            all().map(value).fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
        let margin = 0.03 * (high - low).max(1e-9);
        low - margin..high + margin
    };
    let area = SVGBackend::with_string(text, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(title, ("sans-serif", 16))
        .margin(10)
        .margin_right(150)
        .x_label_area_size(40)
        .y_label_area_size(70)
        .build_cartesian_2d(range(|p| p.0), range(|p| p.1))?;
    chart.configure_mesh().x_desc(&axes[0]).y_desc(&axes[1]).light_line_style(WHITE).draw()?;
    for (k, ((name, points), &colour)) in curves.iter().zip(COLOURS.iter().cycle()).enumerate() {
        chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))?;
        // The names are beside the curves, so that they hide nothing.
        let place = (SIZE.0 as i32 - 145, 50 + 18 * k as i32);
        area.draw(&Text::new(*name, place, ("sans-serif", 13).into_font().color(&colour)))?;
    }
    chart.draw_series(dots.iter().map(|&point| Circle::new(point, 2, BLACK.filled())))?;
    area.present()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chart_contains_all_points_and_names() {
        let axes = ["x".to_owned(), "y".to_owned()];
        let curves: &[(&str, &Points)] = &[("one", &[(1.0, 1.0), (2.0, 2.0)])];
        let svg = draw("a < b", &axes, &[(0.0, -1.0), (2.0, 5.0)], curves).unwrap();
        assert!(svg.contains("a &lt; b") && svg.contains("one"), "{svg}");
        assert_eq!(svg.matches("<circle").count(), 2);
    }
}
