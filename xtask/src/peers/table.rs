//! Tables in Markdown.

/// A table with a header row; numeric columns are right-aligned.
pub struct Table {
    text: String,
}

impl Table {
    /// A table with these column headers; all columns except the first contain numbers.
    pub fn new(heads: &[&str]) -> Self {
        let rule = std::iter::once("---").chain(std::iter::repeat_n("---:", heads.len().saturating_sub(1)));
        let rule = rule.collect::<Vec<_>>().join("|");
        Self { text: format!("| {} |\n|{rule}|", heads.join(" | ")) }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: &[String]) {
        self.text += &format!("\n| {} |", cells.join(" | "));
    }

    /// The table as Markdown.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// A number and the minimum that it should reach: `12.3 (bar 10: met)`.
pub fn at_least(value: f64, bar: f64) -> String {
    verdict(value, bar, value >= bar)
}

/// A number and the maximum that it should not exceed, in the form of [`at_least`].
pub fn at_most(value: f64, bar: f64) -> String {
    verdict(value, bar, value <= bar)
}

fn verdict(value: f64, bar: f64, met: bool) -> String {
    format!("{value:.2} (bar {bar}: {})", if met { "met" } else { "**missed**" })
}

#[cfg(test)]
mod tests {
    use super::{Table, at_least, at_most};

    #[test]
    fn rows_have_as_many_columns_as_the_header() {
        let mut table = Table::new(&["who", "ms", "ratio"]);
        table.row(&["we".into(), "1.0".into(), "10".into()]);
        assert_eq!(table.text(), "| who | ms | ratio |\n|---|---:|---:|\n| we | 1.0 | 10 |");
    }

    #[test]
    fn values_are_compared_with_their_bars() {
        assert_eq!(at_least(10.0, 10.0), "10.00 (bar 10: met)");
        assert_eq!(at_least(9.994, 10.0), "9.99 (bar 10: **missed**)");
        assert_eq!(at_most(1.0, 1.0), "1.00 (bar 1: met)");
        assert!(at_most(1.2, 1.0).contains("missed"));
        assert!(at_most(f64::NAN, 1.0).contains("missed") && at_least(f64::NAN, 1.0).contains("missed"));
    }
}
