//! A small image drawn on the host: rectangles and text.

use ab_glyph::{Font, FontRef, Glyph, PxScale, ScaleFont, point};

/// sRGB with straight alpha, row by row from the upper left.
#[derive(Clone, Debug)]
pub(crate) struct Canvas {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 4]>,
}

/// Ubuntu Light, the font of egui. It is embedded, so that text looks the same on every system.
fn font() -> FontRef<'static> {
    FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).expect("a test parses the embedded font")
}

impl Canvas {
    /// A transparent canvas.
    pub fn new([width, height]: [u32; 2]) -> Canvas {
        Canvas { width, height, pixels: vec![[255, 255, 255, 0]; width as usize * height as usize] }
    }

    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    pub fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.pixels)
    }

    /// Blends a colour over a pixel; pixels outside the canvas are ignored.
    fn blend(&mut self, x: i32, y: i32, [r, g, b]: [u8; 3], opacity: f32) {
        if x < 0 || y < 0 || x >= self.width as i32 || y >= self.height as i32 || opacity <= 0.0 {
            return;
        }
        let pixel = &mut self.pixels[y as usize * self.width as usize + x as usize];
        let below = f32::from(pixel[3]) / 255.0 * (1.0 - opacity);
        let alpha = opacity + below;
        for (channel, new) in pixel.iter_mut().zip([r, g, b]) {
            *channel = ((f32::from(new) * opacity + f32::from(*channel) * below) / alpha).round() as u8;
        }
        pixel[3] = (255.0 * alpha).round() as u8;
    }

    pub fn fill(&mut self, [x, y]: [i32; 2], [width, height]: [i32; 2], colour: [u8; 3], opacity: f32) {
        for row in y..y + height {
            for column in x..x + width {
                self.blend(column, row, colour, opacity);
            }
        }
    }

    /// Fills the whole canvas as a rectangle with rounded corners.
    pub fn panel(&mut self, radius: f32, colour: [u8; 3], opacity: f32) {
        let [width, height] = self.size().map(|side| side as f32);
        for y in 0..self.height as i32 {
            for x in 0..self.width as i32 {
                // Distance from the centre of the corner's circle along an axis; 0 along the
                // straight sides.
                let offset = |at: f32, side: f32| (radius - at).max(at - (side - radius)).max(0.0);
                let corner = offset(x as f32 + 0.5, width).hypot(offset(y as f32 + 0.5, height));
                self.blend(x, y, colour, opacity * (radius + 0.5 - corner).clamp(0.0, 1.0));
            }
        }
    }

    /// Draws a line of text that starts at `x` on the given baseline.
    pub fn text(&mut self, [x, baseline]: [f32; 2], height: f32, colour: [u8; 3], text: &str) {
        let font = font();
        for glyph in glyphs(&font, height, text) {
            let position = point(glyph.position.x + x, baseline);
            let placed = Glyph { position, ..glyph };
            if let Some(outline) = font.outline_glyph(placed) {
                let corner = outline.px_bounds().min;
                outline.draw(|dx, dy, coverage| {
                    // The font is thin; this makes it slightly bolder.
                    let ink = coverage.clamp(0.0, 1.0).powf(0.7);
                    self.blend(corner.x as i32 + dx as i32, corner.y as i32 + dy as i32, colour, ink);
                });
            }
        }
    }

    #[cfg(test)]
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 4] {
        self.pixels[(y * self.width + x) as usize]
    }
}

/// The characters of a caption that the font of pictures lacks, each once; they are drawn as boxes.
///
/// ```
/// use splashdown_render::missing_characters;
/// assert_eq!(missing_characters("Dam break, t = 0.5 s, ρ = 1000 kg/m³"), []);
/// assert_eq!(missing_characters("水 and 水"), ['水']);
/// ```
pub fn missing_characters(text: &str) -> Vec<char> {
    let font = font();
    let mut missing: Vec<char> = Vec::new();
    for character in text.chars().filter(|&character| font.glyph_id(character).0 == 0) {
        if !missing.contains(&character) {
            missing.push(character);
        }
    }
    missing
}

/// Width of a line of text in pixels.
pub(crate) fn text_width(height: f32, text: &str) -> f32 {
    let font = font();
    let scaled = font.as_scaled(PxScale::from(height));
    glyphs(&font, height, text).last().map_or(0.0, |last| last.position.x + scaled.h_advance(last.id))
}

/// The glyphs of a line, starting at x = 0.
fn glyphs(font: &FontRef<'_>, height: f32, text: &str) -> Vec<Glyph> {
    let scale = PxScale::from(height);
    let scaled = font.as_scaled(scale);
    let mut x = 0.0;
    let mut placed: Vec<Glyph> = Vec::with_capacity(text.len());
    for character in text.chars() {
        let id = scaled.glyph_id(character);
        if let Some(before) = placed.last() {
            x += scaled.h_advance(before.id) + scaled.kern(before.id, id);
        }
        placed.push(id.with_scale_and_position(scale, point(x, 0.0)));
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_all_required_characters() {
        let font = font();
        for character in "abcXYZ0123456789.,-+/[](){}³²°µ·×−".chars() {
            assert!(font.glyph_id(character).0 != 0, "no glyph for {character}");
        }
        assert_eq!(font.glyph_id('\u{4e00}').0, 0, "negative control: a character that the font lacks");
    }

    #[test]
    fn text_is_drawn_at_its_position_and_nowhere_else() {
        let mut canvas = Canvas::new([120, 40]);
        let width = text_width(20.0, "speed");
        canvas.text([10.0, 30.0], 20.0, [0, 0, 0], "speed");
        let inked: Vec<u32> = (0..120).filter(|&x| (0..40).any(|y| canvas.pixel(x, y)[3] > 60)).collect();
        assert!(inked[0] >= 10 && inked[0] <= 13, "{inked:?}");
        let last = *inked.last().unwrap() as f32;
        assert!((last - (10.0 + width)).abs() < 4.0, "last ink at {last}, the text is {width} wide");
    }

    #[test]
    fn drawing_outside_the_canvas_is_ignored() {
        let mut canvas = Canvas::new([4, 3]);
        canvas.fill([-2, -2], [3, 3], [10, 20, 30], 1.0);
        canvas.text([-50.0, 100.0], 30.0, [0, 0, 0], "beyond");
        assert_eq!(canvas.pixel(0, 0), [10, 20, 30, 255]);
        assert_eq!(canvas.pixel(1, 0)[3], 0);
    }
}
