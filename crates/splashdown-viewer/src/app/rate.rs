//! The number of pictures per second.

/// Seconds over which pictures are counted.
const PERIOD: f64 = 0.5;

/// Counts pictures while something plays. An idle window draws only after input, at no rate.
#[derive(Default)]
pub(super) struct PictureRate {
    /// The start of the period in s of the window's clock, and the pictures since then.
    period: Option<(f64, u32)>,
    rate: f32,
}

impl PictureRate {
    /// Counts a picture at a time of the window's clock in s. Returns the rate of the last period in 1/s, or 0 if nothing
    /// plays.
    pub fn count(&mut self, now: f64, is_playing: bool) -> f32 {
        if !is_playing {
            *self = Self::default();
            return 0.0;
        }
        let (since, pictures) = self.period.get_or_insert((now, 0));
        let passed = now - *since;
        if passed >= PERIOD {
            self.rate = ((f64::from(*pictures) + 1.0) / passed) as f32;
            self.period = Some((now, 0));
        } else if passed > 0.0 {
            *pictures += 1;
        }
        self.rate
    }
}

#[cfg(test)]
mod tests {
    use super::PictureRate;

    #[test]
    fn pictures_are_counted_while_the_window_plays() {
        let mut rate = PictureRate::default();
        let mut last = 0.0;
        for picture in 0..200_u8 {
            last = rate.count(10.0 + f64::from(picture) / 60.0, true);
        }
        assert!((last - 60.0).abs() < 1.0, "{last}");
        // Two pictures at once, as after a movement of the mouse.
        for offset in [0.0, 0.0013] {
            assert_eq!(rate.count(20.0 + offset, false), 0.0);
        }
        assert_eq!(rate.count(30.0, true), 0.0);
        let slow = (1..=4).map(|picture| rate.count(30.0 + f64::from(picture) / 5.0, true)).last().unwrap();
        assert!((slow - 5.0).abs() < 0.5, "{slow}");
    }
}
