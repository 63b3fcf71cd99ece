//! Reading along while the tests run. Rust's test harness hides what a passing test prints, and a skipped test passes;
//! `--show-output` makes it print that at the end, and this filter keeps of it only the lines that say `SKIPPED:`.

use std::collections::BTreeMap;

/// The word that a skipped test prints.
pub const MARK: &str = "SKIPPED:";

/// Reads the harness's output line by line.
#[derive(Debug, Default)]
pub struct Filter {
    in_successes: bool,
    /// Why something was skipped, and how often.
    pub skipped: BTreeMap<String, usize>,
    /// Tests that passed.
    pub passed: usize,
    /// Tests that failed.
    pub failed: usize,
}

impl Filter {
    /// Takes in a line; true if it should be shown.
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
    fn skips_are_shown_and_counted_and_chatter_is_not() {
        let mut filter = Filter::default();
        let shown: Vec<&str> = OUTPUT.lines().filter(|line| filter.see(line)).collect();
        assert!(shown.contains(&"SKIPPED: no Vulkan driver"));
        assert!(shown.contains(&"the reason"), "a failure's output must stay visible");
        assert!(!shown.contains(&"chatter"));
        assert_eq!((filter.passed, filter.failed), (2, 1));
        assert_eq!(filter.skipped.get("SKIPPED: no Vulkan driver"), Some(&1));
    }

    #[test]
    fn a_skip_outside_of_the_successes_counts_too() {
        let mut filter = Filter::default();
        assert!(filter.see("[thread] SKIPPED: no data"));
        assert!(filter.see("[thread] SKIPPED: no data"));
        assert_eq!(filter.skipped.get("SKIPPED: no data"), Some(&2));
    }
}
