//! The limit for the data that one input file may become in memory.
//!
//! A few megabytes of ZIP, gzip or zlib can declare and contain terabytes, and a small glTF or VTU file can refer to the
//! same bytes many times. Sizes are therefore compared with a limit before anything is decompressed or decoded.

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};

/// The default limit is this multiple of the file's size. Particles at rest on a lattice compress by a factor of 30.
const RATIO: u64 = 64;

/// The default limit of small files.
const SMALL: u64 = 256 << 20;

/// The limit in bytes; 0 selects the default.
static LIMIT: AtomicU64 = AtomicU64::new(0);

/// Sets the largest size of the data of one input file after decompression, for this process. `None` selects the default:
/// 64 times the size of the file, and at least 256 MiB.
pub fn set_input_limit(bytes: Option<u64>) {
    LIMIT.store(bytes.map_or(0, |bytes| bytes.max(1)), Ordering::Relaxed);
}

/// The part of the limit that a file has not used yet.
#[derive(Debug)]
pub(crate) struct Budget {
    file: u64,
    limit: u64,
    used: u64,
}

impl Budget {
    /// The budget of a file of this many bytes.
    pub(crate) fn of_file(bytes: u64) -> Self {
        let limit = match LIMIT.load(Ordering::Relaxed) {
            0 => SMALL.max(bytes.saturating_mul(RATIO)),
            limit => limit,
        };
        Self { file: bytes, limit, used: 0 }
    }

    /// Accounts for data of this size.
    ///
    /// # Errors
    /// A message that begins with `what` if the data exceeds the limit.
    pub(crate) fn take(&mut self, bytes: u64, what: impl fmt::Display) -> Result<(), String> {
        self.used = self.used.saturating_add(bytes);
        if self.used <= self.limit {
            return Ok(());
        }
        let [used, file, limit] = [self.used, self.file, self.limit].map(Size);
        Err(format!(
            "{what} needs {used} in total, but the data of this file of {file} may take {limit}; if you trust the file, \
             raise the limit (`--input-limit` in GiB)"
        ))
    }
}

/// A size in bytes, for people.
struct Size(u64);

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let units = [("GiB", 30), ("MiB", 20), ("KiB", 10)];
        match units.iter().find(|(_, shift)| self.0 >> shift > 0) {
            Some((unit, shift)) => write!(f, "{:.1} {unit}", self.0 as f64 / f64::from(1_u32 << shift)),
            None => write!(f, "{} bytes", self.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Budget;

    #[test]
    fn the_default_limit_grows_with_the_file() {
        let mut small = Budget::of_file(4 << 20);
        assert!(small.take(200 << 20, "a").is_ok());
        let message = small.take(100 << 20, "array `b`").unwrap_err();
        assert!(message.starts_with("array `b` needs 300.0 MiB") && message.contains("4.0 MiB"), "{message}");
        assert!(Budget::of_file(1 << 30).take(60 << 30, "a").is_ok());
        assert!(Budget::of_file(0).take(u64::MAX, "a").is_err());
    }
}
