//! The times of the pictures of a film.

/// Which frame a picture is drawn from, and the time between both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The number of the frame.
    pub frame: u32,
    /// The time of the picture after that of the frame, in frames: -0.5 to 0.5.
    pub offset: f64,
}

/// The pictures of a film of these frames (ascending). A film that is `slow` times slower shows this many pictures per
/// frame, each drawn from the nearest frame. Pictures nearest to a frame that does not exist are left out. A faster film
/// shows every frame.
pub fn moments(frames: &[u32], slow: f32) -> Vec<Moment> {
    let slow = f64::from(slow.max(1.0));
    let (Some(&first), Some(&last)) = (frames.first(), frames.last()) else { return Vec::new() };
    let pictures = (f64::from(last - first) * slow + 1e-6).floor();
    let of_frame = |&frame: &u32| {
        let place = f64::from(frame - first);
        // A picture half-way between two frames is drawn from the earlier one.
        let begin = (((place - 0.5) * slow).floor() + 1.0).max(0.0);
        let end = ((place + 0.5) * slow).floor().min(pictures);
        (begin as u64..=end as u64)
            .map(move |picture| Moment { frame, offset: picture as f64 / slow - place })
    };
    frames.iter().flat_map(of_frame).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(frames: &[u32], slow: f32) -> Vec<(u32, f64)> {
        moments(frames, slow).into_iter().map(|moment| (moment.frame, moment.offset)).collect()
    }

    #[test]
    fn a_film_at_full_speed_shows_every_frame() {
        assert_eq!(places(&[3, 4, 6], 1.0), [(3, 0.0), (4, 0.0), (6, 0.0)]);
        assert_eq!(places(&[3, 4, 6], 0.5), [(3, 0.0), (4, 0.0), (6, 0.0)]);
        assert_eq!(places(&[9], 4.0), [(9, 0.0)]);
        assert_eq!(places(&[], 4.0), []);
    }

    #[test]
    fn a_slow_film_shows_pictures_between_the_frames() {
        let expected = [(3, 0.0), (3, 0.25), (3, 0.5), (4, -0.25), (4, 0.0)];
        assert_eq!(places(&[3, 4], 4.0), expected);
        // Around a missing frame there are no pictures.
        assert_eq!(places(&[0, 2], 3.0), [(0, 0.0), (0, 1.0 / 3.0), (2, 5.0 / 3.0 - 2.0), (2, 0.0)]);
        // Times are evenly spaced whatever the factor.
        let times: Vec<f64> = moments(&(0..=40).collect::<Vec<_>>(), 2.7)
            .iter()
            .map(|m| f64::from(m.frame) + m.offset)
            .collect();
        assert_eq!(times.len(), 109);
        // A stray frame does not add pictures of those between.
        assert_eq!(moments(&[0, u32::MAX], 100.0).len(), 101);
        assert!(times.windows(2).all(|pair| (pair[1] - pair[0] - 1.0 / f64::from(2.7_f32)).abs() < 1e-9));
    }
}
