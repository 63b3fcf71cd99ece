//! Kills a test that hangs, and names it.
//!
//! Rust's harness prints `test NAME has been running for over 60 seconds` once per slow test, and its result when it
//! ends. A test without a result [`LIMIT`] after its start is killed together with its binary; Cargo then starts the
//! next one. A binary that prints nothing at all for [`SILENCE`] is killed too.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// Time limit of a test. The slowest takes about a minute.
pub const LIMIT: Duration = Duration::from_secs(600);
/// Longest time without any output. Compiling one crate takes a minute at most.
pub const SILENCE: Duration = Duration::from_secs(1200);

/// Time after which the harness reports a slow test.
const REPORTED_AFTER: Duration = Duration::from_secs(60);
const SLOW: &str = " has been running for over 60 seconds";

/// The slow tests, and the time of the last output.
#[derive(Debug)]
pub struct Watch {
    /// Start of each slow test that has no result yet.
    slow: BTreeMap<String, Instant>,
    binary: String,
    last_line: Instant,
    limit: Duration,
}

impl Watch {
    /// Watches a run that starts now, with [`LIMIT`] for each test.
    pub fn new(now: Instant) -> Self {
        Self { slow: BTreeMap::new(), binary: "the build".to_owned(), last_line: now, limit: LIMIT }
    }

    /// The same with another limit.
    #[cfg(test)]
    pub fn with_limit(self, limit: Duration) -> Self {
        Self { limit, ..self }
    }

    /// Reads a line of the harness or of Cargo.
    pub fn see(&mut self, line: &str, now: Instant) {
        self.last_line = now;
        let line = line.trim();
        let running = line.strip_prefix("Running ").or_else(|| line.strip_prefix("Doc-tests "));
        if let Some(binary) = running {
            self.binary = binary.to_owned();
            self.slow.clear();
        } else if let Some(name) = line.strip_prefix("test ") {
            if let Some(name) = name.strip_suffix(SLOW) {
                let start = now.checked_sub(REPORTED_AFTER).unwrap_or(now);
                self.slow.insert(name.to_owned(), start);
            } else if let Some((name, _)) = name.rsplit_once(" ... ") {
                self.slow.remove(name);
            }
        }
    }

    /// The hung tests with their binary; `None` if none hangs.
    pub fn hung(&self, now: Instant) -> Option<String> {
        let late = |start: Instant| now.duration_since(start) > self.limit;
        let tests: Vec<&str> =
            self.slow.iter().filter(|(_, start)| late(**start)).map(|(name, _)| name.as_str()).collect();
        let binary = &self.binary;
        if !tests.is_empty() {
            let names = tests.join(", ");
            return Some(format!("{names} in {binary} took more than {} minutes", self.limit.as_secs() / 60));
        }
        let silent = now.duration_since(self.last_line) > SILENCE;
        silent.then(|| format!("{binary} printed nothing for {} minutes", SILENCE.as_secs() / 60))
    }

    /// Clears the tests that were running, after they were killed.
    pub fn killed(&mut self, now: Instant) {
        self.slow.clear();
        self.last_line = now;
    }
}

#[cfg(test)]
mod tests {
    use super::{LIMIT, SILENCE, Watch};
    use std::time::{Duration, Instant};

    const RUNNING: &str = "     Running tests/flow.rs (target/debug/deps/flow-0)";

    #[test]
    fn a_test_beyond_the_limit_is_named_with_its_binary() {
        let start = Instant::now();
        let at = |seconds: u64| start + Duration::from_secs(seconds);
        let mut watch = Watch::new(start);
        watch.see(RUNNING, start);
        watch.see("test quick has been running for over 60 seconds", at(60));
        watch.see("test deep::slow has been running for over 60 seconds", at(61));
        watch.see("test quick ... ok", at(70));
        assert_eq!(watch.hung(at(LIMIT.as_secs())), None);
        let reason = watch.hung(at(LIMIT.as_secs() + 2)).expect("it hangs");
        assert!(reason.starts_with("deep::slow in tests/flow.rs"), "{reason}");
        watch.killed(at(LIMIT.as_secs() + 2));
        assert_eq!(watch.hung(at(LIMIT.as_secs() + 3)), None);
    }

    #[test]
    fn a_result_ends_the_watch() {
        let start = Instant::now();
        let mut watch = Watch::new(start);
        watch.see("test slow has been running for over 60 seconds", start);
        watch.see("test slow ... FAILED", start);
        assert_eq!(watch.hung(start + LIMIT + Duration::from_secs(1)), None);
    }

    #[test]
    fn a_silent_binary_is_named() {
        let start = Instant::now();
        let mut watch = Watch::new(start);
        watch.see(RUNNING, start);
        let reason = watch.hung(start + SILENCE + Duration::from_secs(1)).expect("it hangs");
        assert!(reason.starts_with("tests/flow.rs"), "{reason}");
    }
}
