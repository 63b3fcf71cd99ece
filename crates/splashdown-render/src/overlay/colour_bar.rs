//! The colour bar at the right border, and the caption in the lower left corner.

use super::canvas::{Canvas, text_width};
use super::ticks::{label, ticks};
use crate::{Colouring, Quantity};

const INK: [u8; 3] = [22, 32, 44];
const PAPER: [u8; 3] = [255, 255, 255];
/// The largest side of a texture that WebGPU guarantees.
const LARGEST: u32 = 8192;

/// Sizes in pixels, derived from the height of the picture.
struct Layout {
    text: f32,
    pad: f32,
    bar: [i32; 2],
    tick: i32,
    corner_radius: f32,
}

impl Layout {
    fn new([_, height]: [u32; 2]) -> Layout {
        let scale = (height as f32 / 720.0).clamp(0.3, 6.0);
        let px = |length: f32| (length * scale).round() as i32;
        Layout {
            text: (21.0 * scale).max(9.0),
            pad: (12.0 * scale).max(3.0),
            bar: [px(20.0).max(4), px(280.0)],
            tick: px(6.0).max(2),
            corner_radius: 8.0 * scale,
        }
    }
}

/// Title, and the factor from SI units to the displayed unit.
fn title(quantity: Quantity, range: [f32; 2]) -> (&'static str, f64) {
    let largest = range[0].abs().max(range[1].abs());
    match quantity {
        Quantity::Speed => ("speed [m/s]", 1.0),
        Quantity::Density => ("density [kg/m³]", 1.0),
        Quantity::Pressure if largest >= 1e6 => ("pressure [MPa]", 1e-6),
        Quantity::Pressure if largest >= 1e4 => ("pressure [kPa]", 1e-3),
        Quantity::Pressure => ("pressure [Pa]", 1.0),
    }
}

/// Draws the bar with title, unit and ticks. Returns its corner in the picture and the image, or
/// `None` if the picture is too small for it.
pub(crate) fn draw_colour_bar(
    colouring: &Colouring,
    range: [f32; 2],
    picture_size: [u32; 2],
) -> Option<([u32; 2], Canvas)> {
    let layout = Layout::new(picture_size);
    let (title, factor) = title(colouring.quantity, range);
    let [low, high] = range.map(|value| f64::from(value) * factor);
    let (values, step) = ticks(low, high, 6);
    let numbers: Vec<String> = values.iter().map(|&value| label(value, step)).collect();

    let [bar_width, bar_height] = layout.bar;
    let numbers_width = numbers.iter().map(|text| text_width(layout.text, text)).fold(0.0, f32::max);
    let scale_width = bar_width as f32 + 2.0 * layout.tick as f32 + numbers_width;
    let inner_width = scale_width.max(text_width(layout.text, title));
    let top = layout.pad + 1.5 * layout.text;
    let width = (inner_width + 2.0 * layout.pad).ceil() as u32;
    // The space below the bar contains the lower half of the lowest label.
    let height = (top + bar_height as f32 + 0.4 * layout.text + layout.pad).ceil() as u32;
    let margin = (1.5 * layout.pad) as u32;
    if 2 * width + margin > picture_size[0] || height + 2 * margin > picture_size[1] {
        return None;
    }

    let mut canvas = Canvas::new([width, height]);
    canvas.panel(layout.corner_radius, PAPER, 0.72);
    canvas.text([layout.pad, layout.pad + 0.8 * layout.text], layout.text, INK, title);
    let (left, top) = (layout.pad.round() as i32, top.round() as i32);
    canvas.fill([left - 1, top - 1], [bar_width + 2, bar_height + 2], INK, 0.55);
    for row in 0..bar_height {
        let t = 1.0 - row as f32 / (bar_height - 1).max(1) as f32;
        canvas.fill([left, top + row], [bar_width, 1], colouring.map.sample(t), 1.0);
    }
    let right = left + bar_width + 1;
    for (value, text) in values.iter().zip(&numbers) {
        let fraction = ((value - low) / (high - low)).clamp(0.0, 1.0);
        let y = top as f32 + (1.0 - fraction as f32) * (bar_height - 1) as f32;
        canvas.fill([right, y.round() as i32], [layout.tick, 1], INK, 0.9);
        let x = (right + layout.tick) as f32 + 0.25 * layout.text;
        canvas.text([x, y + 0.32 * layout.text], layout.text, INK, text);
    }
    Some(([picture_size[0] - width - margin, (picture_size[1] - height) / 2], canvas))
}

/// Draws a line of text. Returns its corner in the picture and the image, or `None` if the picture
/// is too small for it or the text longer than a texture.
pub(crate) fn draw_caption(text: &str, picture_size: [u32; 2]) -> Option<([u32; 2], Canvas)> {
    let layout = Layout::new(picture_size);
    let margin = (1.5 * layout.pad) as u32;
    let width = (text_width(layout.text, text) + 2.0 * layout.pad).ceil() as u32;
    let height = (1.9 * layout.text).ceil() as u32;
    if width > LARGEST || width + 2 * margin > picture_size[0] || height + 2 * margin > picture_size[1] {
        return None;
    }
    let mut canvas = Canvas::new([width, height]);
    canvas.panel(layout.corner_radius, PAPER, 0.72);
    canvas.text([layout.pad, 1.25 * layout.text], layout.text, INK, text);
    Some(([margin, picture_size[1] - height - margin], canvas))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ColourMap;

    fn colouring(quantity: Quantity) -> Colouring {
        Colouring::new(quantity, [0.0, 2.0]).with_map(ColourMap::Viridis)
    }

    #[test]
    fn the_bar_spans_the_whole_colour_map() {
        let ([x, y], canvas) = draw_colour_bar(&colouring(Quantity::Speed), [0.0, 2.0], [1280, 720]).unwrap();
        let [width, height] = canvas.size();
        assert!(x > 1000 && x + width < 1280 && y > 0 && y + height < 720);
        let column: Vec<[u8; 4]> = (0..height).map(|row| canvas.pixel(22, row)).collect();
        let of = |t| {
            let [r, g, b] = ColourMap::Viridis.sample(t);
            column.iter().position(|&pixel| pixel == [r, g, b, 255])
        };
        let (upper, lower) = (of(1.0).unwrap(), of(0.0).unwrap());
        assert_eq!(lower - upper, 279, "the bar has 280 rows");
        // Negative control: the bar does not contain the end of another map.
        let [r, g, b] = ColourMap::Inferno.sample(1.0);
        assert!(!column.contains(&[r, g, b, 255]));
    }

    #[test]
    fn the_unit_of_pressure_follows_the_range() {
        assert_eq!(title(Quantity::Pressure, [0.0, 900.0]).0, "pressure [Pa]");
        assert_eq!(title(Quantity::Pressure, [-20_000.0, 900.0]), ("pressure [kPa]", 1e-3));
        assert_eq!(title(Quantity::Pressure, [0.0, 2e6]).0, "pressure [MPa]");
    }

    #[test]
    fn small_pictures_have_no_labels() {
        assert!(draw_colour_bar(&colouring(Quantity::Density), [0.0, 1.0], [40, 20]).is_none());
        assert!(draw_caption("t = 1.000 s, 65536 particles", [40, 20]).is_none());
        assert!(draw_caption("t = 1.000 s, 65536 particles", [640, 360]).is_some());
    }
}
