//! The position in a finished run that is played: a clock over the numbers of its frames. It needs no files.

/// The smallest and the largest time scale, in simulated seconds per second.
pub const TIME_SCALES: std::ops::RangeInclusive<f32> = 0.05..=8.0;

/// The position in a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Timeline {
    /// Ascending, never empty.
    frames: Vec<u32>,
    /// Frames per simulated second.
    frame_rate: f64,
    /// Simulated time in s.
    position: f64,
    /// The last call of [`tick`](Self::tick), in s of the window's clock.
    ticked: Option<f64>,
    /// Whether it plays.
    pub playing: bool,
    /// Whether it starts again after the last frame.
    pub looping: bool,
    /// Simulated seconds per second.
    pub time_scale: f32,
    /// Frames that cannot be read.
    pub left_out: Vec<u32>,
    /// Whether the run can be continued from a checkpoint.
    pub can_continue: bool,
    /// Whether any frame has particles.
    pub has_particles: bool,
    /// Whether any frame has a mesh.
    pub has_meshes: bool,
}

impl Timeline {
    /// Starts at the first of these frames; `None` without frames.
    pub fn new(mut frames: Vec<u32>, frame_rate: f32) -> Option<Self> {
        frames.sort_unstable();
        frames.dedup();
        let first = *frames.first()?;
        let frame_rate = f64::from(frame_rate);
        Some(Self {
            position: f64::from(first) / frame_rate,
            frames,
            frame_rate,
            ticked: None,
            playing: true,
            looping: true,
            time_scale: 1.0,
            left_out: Vec::new(),
            can_continue: false,
            has_particles: true,
            has_meshes: true,
        })
    }

    /// The first and the last frame.
    pub fn range(&self) -> (u32, u32) {
        (self.frames[0], self.frames[self.frames.len() - 1])
    }

    /// The number of frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Never true.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// The current frame: the last one at or before the position.
    pub fn current(&self) -> u32 {
        self.frames[self.index()]
    }

    /// The current frame and those that follow it, at most `count`. After the last one follows the first.
    pub fn upcoming(&self, count: usize) -> impl Iterator<Item = u32> + '_ {
        let (start, len) = (self.index(), self.frames.len());
        (0..count.min(len)).map(move |ahead| self.frames[(start + ahead) % len])
    }

    /// How many frames after the current one a frame follows. Frames just passed are the farthest.
    pub fn distance(&self, number: u32) -> usize {
        let (start, len) = (self.index(), self.frames.len());
        let index = self.frames.partition_point(|&frame| frame < number).min(len - 1);
        (index + len - start) % len
    }

    /// Advances to a time of the window's clock in s. While the current frame is not ready the position waits.
    pub fn tick(&mut self, now: f64, is_ready: bool) {
        let passed = self.ticked.replace(now).map_or(0.0, |before| (now - before).max(0.0));
        if !self.playing || !is_ready {
            return;
        }
        // A slow picture advances by more than one frame, but never by more than half a second.
        self.position += f64::from(self.time_scale) * passed.min(0.5);
        let (first, last) = self.range();
        let end = (f64::from(last) + 1.0) / self.frame_rate;
        if self.position < end {
            return;
        }
        if self.looping {
            self.seek(first);
        } else {
            self.seek(last);
            self.playing = false;
        }
    }

    /// Seconds of wall time until the next frame is due.
    pub fn until_next(&self) -> f64 {
        let next = self.frames.get(self.index() + 1).map(|&frame| f64::from(frame));
        let next = next.unwrap_or_else(|| f64::from(self.range().1) + 1.0);
        ((next / self.frame_rate - self.position) / f64::from(self.time_scale)).max(0.0)
    }

    /// Goes to a frame, or to the last one before it.
    pub fn seek(&mut self, number: u32) {
        let (first, last) = self.range();
        self.position = f64::from(number.clamp(first, last)) / self.frame_rate;
        self.position = f64::from(self.current()) / self.frame_rate;
    }

    /// Pauses and goes to the next frame, or the previous one if `offset` is -1.
    pub fn step(&mut self, offset: isize) {
        self.playing = false;
        let index = self.index().saturating_add_signed(offset).min(self.frames.len() - 1);
        self.seek(self.frames[index]);
    }

    /// Plays or pauses. At the end it starts again from the first frame.
    pub fn toggle(&mut self) {
        let (first, last) = self.range();
        if !self.playing && self.current() == last {
            self.seek(first);
        }
        self.playing = !self.playing;
    }

    /// Leaves out a frame that cannot be read. Returns false if no frame would remain.
    pub fn leave_out(&mut self, number: u32) -> bool {
        if self.frames == [number] {
            self.playing = false;
            return false;
        }
        let was_current = self.current() == number;
        if let Ok(index) = self.frames.binary_search(&number) {
            let next = self.frames.remove(index);
            self.left_out.push(next);
            if was_current {
                let index = index.min(self.frames.len() - 1);
                self.seek(self.frames[index]);
            }
        }
        true
    }

    fn index(&self) -> usize {
        // The position of a frame is not always exactly the time of its number.
        let number = self.position * self.frame_rate + 1e-6;
        self.frames.partition_point(|&frame| f64::from(frame) <= number).saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timeline() -> Timeline {
        Timeline::new(vec![7, 2, 3, 5, 2], 50.0).unwrap()
    }

    #[test]
    fn the_clock_follows_the_time_scale_and_stays_on_frames_that_exist() {
        let mut timeline = timeline();
        assert_eq!((timeline.current(), timeline.range(), timeline.len()), (2, (2, 7), 4));
        timeline.tick(10.0, true);
        timeline.tick(10.021, true);
        assert_eq!(timeline.current(), 3);
        // Frame 4 is missing: frame 3 remains.
        timeline.tick(10.041, true);
        assert_eq!(timeline.current(), 3);
        timeline.time_scale = 0.5;
        timeline.tick(10.061, true);
        assert_eq!(timeline.current(), 3);
        timeline.tick(10.081, true);
        assert_eq!(timeline.current(), 5);
        // A frame that is not ready holds the clock.
        timeline.tick(10.5, false);
        timeline.tick(10.501, true);
        assert_eq!(timeline.current(), 5);
    }

    #[test]
    fn the_end_loops_or_stops() {
        for looping in [true, false] {
            let mut timeline = timeline();
            timeline.looping = looping;
            timeline.tick(0.0, true);
            timeline.seek(7);
            timeline.tick(0.019, true);
            assert_eq!((timeline.current(), timeline.playing), (7, true));
            timeline.tick(0.021, true);
            assert_eq!((timeline.current(), timeline.playing), if looping { (2, true) } else { (7, false) });
        }
        let mut ended = timeline();
        ended.step(100);
        assert_eq!((ended.current(), ended.playing), (7, false));
        ended.toggle();
        assert_eq!((ended.current(), ended.playing), (2, true));
    }

    #[test]
    fn steps_and_seeks_end_on_frames() {
        let mut timeline = timeline();
        timeline.step(1);
        assert_eq!(timeline.current(), 3);
        timeline.step(1);
        assert_eq!(timeline.current(), 5);
        timeline.step(-1);
        timeline.step(-1);
        timeline.step(-1);
        assert_eq!(timeline.current(), 2);
        for (number, expected) in [(0, 2), (4, 3), (6, 5), (900, 7)] {
            timeline.seek(number);
            assert_eq!(timeline.current(), expected, "{number}");
        }
        // The times of many frame rates are not exact in binary.
        let frames: Vec<u32> = (0..3000).collect();
        for rate in [23.976_f32, 24.0, 30.0, 59.94, 60.0, 1000.0] {
            let mut timeline = Timeline::new(frames.clone(), rate).unwrap();
            for &frame in &frames {
                timeline.seek(frame);
                assert_eq!(timeline.current(), frame, "{rate}");
            }
        }
    }

    #[test]
    fn the_frames_just_passed_are_the_farthest() {
        let mut timeline = timeline();
        timeline.seek(5);
        assert_eq!(timeline.upcoming(9).collect::<Vec<_>>(), [5, 7, 2, 3]);
        assert_eq!([5, 7, 2, 3].map(|frame| timeline.distance(frame)), [0, 1, 2, 3]);
    }

    #[test]
    fn frames_left_out_are_skipped_until_none_remains() {
        let mut timeline = timeline();
        timeline.seek(3);
        assert!(timeline.leave_out(3));
        assert_eq!(timeline.current(), 5);
        timeline.seek(7);
        assert!(timeline.leave_out(7));
        assert_eq!(timeline.current(), 5);
        assert!(timeline.leave_out(2) && !timeline.leave_out(5));
        assert_eq!((timeline.current(), timeline.left_out.clone()), (5, vec![3, 7, 2]));
        assert_eq!(Timeline::new(Vec::new(), 50.0), None);
    }

    #[test]
    fn the_next_frame_is_due_after_its_distance_over_the_speed() {
        let mut timeline = timeline();
        timeline.seek(3);
        timeline.time_scale = 2.0;
        assert!((timeline.until_next() - 0.02).abs() < 1e-9, "{}", timeline.until_next());
    }
}
