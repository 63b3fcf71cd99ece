//! Filters the output of the tests. Rust's test harness hides the output of a passing test, and a skipped test passes.
//! `--show-output` prints that output at the end; this filter passes on only the lines with `SKIPPED:`.

use std::collections::BTreeMap;

/// The prefix that a skipped test prints.
pub const MARK: &str = "SKIPPED:";

/// Reads the harness's output line by line.
#[derive(Debug, Default)]
pub struct Filter {
    in_successes: bool,
    /// The reasons for skipping, each with its count.
    pub skipped: BTreeMap<String, usize>,
    /// Number of tests that passed.
    pub passed: usize,
    /// Number of tests that failed.
    pub failed: usize,
}

impl Filter {
    /// Processes a line; true if it should be shown.
    pub fn see(&mut self, line: &str) -> bool {
        if let Some(at) = line.find(MARK) {
            *self.skipped.entry(line[at..].trim().to_owned()).or_default() += 1;
            return true;
        }
        if let Some(result) = line.strip_prefix("test result:") {
            self.in_successes = false;
            self.count(result);
        } else if line == "failures:" {
            self.in_successes = false;
        } else if line == "successes:" {
            self.in_successes = true;
        }
        !self.in_successes
    }

    /// Reads ` ok. 12 passed; 0 failed; ...`.
    fn count(&mut self, result: &str) {
        let number = |what: &str| {
            let before = result.split(what).next()?;
            before
                .rsplit(|c: char| !c.is_ascii_digit())
                .find(|digits| !digits.is_empty())?
                .parse::<usize>()
                .ok()
        };
        self.passed += number(" passed").unwrap_or(0);
        self.failed += number(" failed").unwrap_or(0);
    }
}

#[cfg(test)]
mod tests {
    use super::Filter;

    const OUTPUT: &str = "\
running 2 tests
test a ... ok
test b ... ok

successes:

---- a stdout ----
chatter
SKIPPED: no Vulkan driver

successes:
    a
    b

test result: ok. 2 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s

running 1 test
test c ... FAILED

failures:

---- c stdout ----
the reason

failures:
    c

test result: FAILED. 0 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s
";

    #[test]
    fn skips_are_shown_and_counted_but_other_output_is_hidden() {
        let mut filter = Filter::default();
        let shown: Vec<&str> = OUTPUT.lines().filter(|line| filter.see(line)).collect();
        assert!(shown.contains(&"SKIPPED: no Vulkan driver"));
        assert!(shown.contains(&"the reason"), "a failure's output must stay visible");
        assert!(!shown.contains(&"chatter"));
        assert_eq!((filter.passed, filter.failed), (2, 1));
        assert_eq!(filter.skipped.get("SKIPPED: no Vulkan driver"), Some(&1));
    }

    #[test]
    fn a_skip_outside_the_successes_is_counted() {
        let mut filter = Filter::default();
        assert!(filter.see("[thread] SKIPPED: no data"));
        assert!(filter.see("[thread] SKIPPED: no data"));
        assert_eq!(filter.skipped.get("SKIPPED: no data"), Some(&2));
    }
}
