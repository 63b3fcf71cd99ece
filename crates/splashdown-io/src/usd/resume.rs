//! Continuing the series of an earlier process.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::PathBuf;
use std::sync::Mutex;

use super::spool::{self, Attribute, Spool};
use super::{HEADER, Place, Series, State};
use crate::error::IoError;

/// Longest line of a file that is not a line of samples.
const SHORT: u64 = 1 << 12;

impl Series {
    /// Continues after the frame `last`, from the kept files or from the complete file. `None` if neither ends with
    /// this frame.
    pub(super) fn resume(
        place: Place,
        head: String,
        attributes: &'static [Attribute],
        last: u32,
    ) -> Result<Option<Self>, IoError> {
        let kept = place.parts(attributes).filter(|parts| parts.iter().all(|part| part.is_file()));
        let state = kept.and_then(|parts| continued(&parts, attributes, last).ok().flatten());
        let series =
            Self { state: Mutex::new(State { spools: Vec::new(), frames: None }), place, head, attributes };
        let state = match state {
            Some(state) => Some(state),
            None => series.split(last).map_err(|error| series.failed(&error))?,
        };
        Ok(state.map(|state| Self { state: Mutex::new(state), ..series }))
    }

    /// Splits a complete file into its attributes.
    fn split(&self, last: u32) -> io::Result<Option<State>> {
        let Ok(file) = File::open(&self.place.path) else { return Ok(None) };
        if !file.metadata()?.is_file() {
            return Ok(None);
        }
        let mut from = BufReader::with_capacity(1 << 16, file);
        let mut start = vec![0; HEADER.len()];
        if io::Read::read_exact(&mut from, &mut start).is_err() || start != HEADER.as_bytes() {
            return Ok(None);
        }
        let mut spools = self.create()?;
        let mut frames: Vec<Vec<u32>> = vec![Vec::new(); spools.len()];
        while let Some(line) = spool::short_line(&mut from, SHORT)? {
            let Some(n) = self.attributes.iter().position(|attribute| spool::is_head(&line, attribute))
            else {
                continue;
            };
            while let Some(frame) = spools[n].copy_line(&mut from, last)? {
                frames[n].push(frame);
            }
        }
        let all = frames.first().cloned().unwrap_or_default();
        for (spool, frames) in spools.iter_mut().zip(&mut frames) {
            // An attribute that no frame has is not in the file.
            if frames.is_empty() {
                all.iter().try_for_each(|&frame| spool.empty(frame))?;
                frames.clone_from(&all);
            }
        }
        let state = range(&frames, last).map(|frames| State { spools, frames: Some(frames) });
        if state.is_none() {
            spool::remove(&self.place.parts(self.attributes).unwrap_or_default());
        }
        Ok(state)
    }
}

fn continued(parts: &[PathBuf], attributes: &'static [Attribute], last: u32) -> io::Result<Option<State>> {
    let (mut spools, mut frames) = (Vec::new(), Vec::new());
    for (path, attribute) in parts.iter().zip(attributes) {
        let (spool, own) = Spool::continued(path, attribute, last)?;
        spools.push(spool);
        frames.push(own);
    }
    Ok(range(&frames, last).map(|frames| State { spools, frames: Some(frames) }))
}

/// The first and the last frame, if all attributes have the same frames without gaps, up to `last`.
fn range(frames: &[Vec<u32>], last: u32) -> Option<[u32; 2]> {
    let all = frames.first()?;
    let first = *all.first()?;
    let complete = frames.iter().all(|own| own == all) && all.iter().copied().eq(first..=last);
    complete.then_some([first, last])
}

#[cfg(test)]
mod tests {
    use super::range;

    #[test]
    fn only_complete_series_continue() {
        assert_eq!(range(&[vec![2, 3, 4], vec![2, 3, 4]], 4), Some([2, 4]));
        assert_eq!(range(&[vec![2, 3, 4], vec![2, 3]], 4), None);
        assert_eq!(range(&[vec![2, 4]], 4), None);
        assert_eq!(range(&[vec![2, 3]], 4), None);
        assert_eq!(range(&[Vec::new()], 4), None);
    }
}
