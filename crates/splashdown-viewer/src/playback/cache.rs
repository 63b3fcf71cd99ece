//! Frames in memory, up to a limit in bytes.

use std::collections::BTreeMap;

/// Frames by number. The farthest frames are removed when the limit is exceeded.
#[derive(Debug)]
pub struct Cache<T> {
    frames: BTreeMap<u32, (T, usize)>,
    limit: usize,
    bytes: usize,
    /// Bytes of the largest frame so far.
    largest: usize,
}

/// The frame shown and the next one are kept whatever their size.
const MIN_FRAMES: usize = 2;

impl<T> Cache<T> {
    pub fn new(limit: usize) -> Self {
        Self { frames: BTreeMap::new(), limit, bytes: 0, largest: 0 }
    }

    pub fn get(&self, number: u32) -> Option<&T> {
        self.frames.get(&number).map(|(frame, _)| frame)
    }

    /// The number of frames that fit if all are as large as the largest one. Before the first it is not known, and two.
    pub fn capacity(&self) -> usize {
        if self.frames.is_empty() { MIN_FRAMES } else { (self.limit / self.largest.max(1)).max(MIN_FRAMES) }
    }

    /// Adds a frame of this size, and removes those with the largest `distance` while the limit is exceeded.
    pub fn insert(&mut self, number: u32, frame: T, bytes: usize, distance: impl Fn(u32) -> usize) {
        if let Some((_, old)) = self.frames.insert(number, (frame, bytes)) {
            self.bytes -= old;
        }
        self.bytes += bytes;
        self.largest = self.largest.max(bytes);
        while self.bytes > self.limit && self.frames.len() > MIN_FRAMES {
            let Some(farthest) = self.frames.keys().copied().max_by_key(|&number| distance(number)) else {
                break;
            };
            if let Some((_, bytes)) = self.frames.remove(&farthest) {
                self.bytes -= bytes;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(cache: &Cache<()>) -> Vec<u32> {
        cache.frames.keys().copied().collect()
    }

    #[test]
    fn the_farthest_frames_are_removed_first() {
        let mut cache = Cache::new(100);
        assert_eq!(cache.capacity(), 2);
        let from = |current: u32| move |number: u32| ((number + 10 - current) % 10) as usize;
        for number in 0..5 {
            cache.insert(number, (), 25, from(number));
        }
        // Of 0 to 4 with 4 shown, 3 is the last that a loop reaches again.
        assert_eq!((numbers(&cache), cache.capacity()), (vec![0, 1, 2, 4], 4));
        assert!(cache.get(4).is_some() && cache.get(3).is_none());
        // The same frame again does not count twice.
        cache.insert(4, (), 25, from(4));
        assert_eq!((numbers(&cache), cache.bytes), (vec![0, 1, 2, 4], 100));
    }

    #[test]
    fn two_frames_remain_even_if_they_exceed_the_limit() {
        let mut cache = Cache::new(100);
        for number in 0..4 {
            cache.insert(number, (), 500, |other| (other + 10 - number) as usize % 10);
        }
        assert_eq!((cache.frames.len(), cache.capacity()), (2, 2));
        assert!(cache.get(3).is_some());
    }
}
