//! A page of measurements, with date, machine and command.

use std::fs;
use std::path::Path;
use std::time::SystemTime;

use anyhow::{Context, Result};

use crate::process::{self, root, say};

/// A page that is printed section by section and written at the end.
pub struct Page {
    text: String,
}

impl Page {
    /// Starts a page with its title, the date, the machine and the command.
    pub fn new(title: &str, command: &str, binary: &Path) -> Result<Self> {
        let mut page = Self { text: String::new() };
        page.add(&format!("# {title}"));
        page.add(&format!("Written by `{}`, {}, on {}", command.trim(), date(), machine(binary)?));
        page.add(&format!(
            "Shared machines are noisy: ratios of one run are more reliable than single times.{}",
            load().map_or_else(String::new, |load| format!(" Load before the first measurement: {load}."))
        ));
        Ok(page)
    }

    /// Adds a paragraph, a table or a heading.
    pub fn add(&mut self, paragraph: &str) {
        say(format!("\n{paragraph}"));
        if !self.text.is_empty() {
            self.text.push('\n');
        }
        self.text += paragraph.trim();
        self.text.push('\n');
    }

    /// Adds a part that the guide includes by this name.
    pub fn add_anchored(&mut self, name: &str, part: &str) {
        self.add(&format!("<!-- ANCHOR: {name} -->\n{}\n<!-- ANCHOR_END: {name} -->", part.trim()));
    }

    /// Writes the page to a path relative to the repository.
    pub fn write(self, path: &str) -> Result<()> {
        fs::write(root().join(path), self.text).with_context(|| format!("cannot write {path}"))?;
        say(format!("\nWritten: {path}"));
        Ok(())
    }
}

/// Today, in UTC.
pub fn date() -> String {
    date_of(SystemTime::now())
}

/// The day of a time, in UTC.
pub fn date_of(time: SystemTime) -> String {
    let seconds = time.duration_since(SystemTime::UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let [year, month, day] = civil(seconds / 86_400);
    format!("{year}-{month:02}-{day:02}")
}

/// Year, month and day of the days since 1970-01-01 (Hinnant, "chrono-Compatible Low-Level Date Algorithms",
/// 2014). Years begin in March here, so that the leap day is their last.
fn civil(days: u64) -> [u64; 3] {
    let days = days + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let january = month >= 10;
    let number = if january { month - 9 } else { month + 3 };
    [year + era * 400 + u64::from(january), number, day - (153 * month + 2) / 5 + 1]
}

/// The load average of the last minute, where the system provides it.
fn load() -> Option<String> {
    Some(fs::read_to_string("/proc/loadavg").ok()?.split_whitespace().next()?.to_owned())
}

/// Number of hardware threads of this machine.
pub fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Processor, threads, instructions and adapters in one line, as `splashdown doctor` finds them.
fn machine(binary: &Path) -> Result<String> {
    let output = process::command(binary).args(["doctor", "--json"]).output()?;
    let json = String::from_utf8_lossy(&output.stdout).into_owned();
    let adapters = texts(&json, "name").into_iter().zip(texts(&json, "kind"));
    let mut adapters: Vec<String> = adapters.map(|(name, kind)| format!("{name} ({kind})")).collect();
    if !texts(&json, "kind").iter().any(|kind| kind.ends_with(" GPU")) {
        adapters.push("no GPU".to_owned());
    }
    Ok(format!(
        "{}, {} threads ({}), {}.",
        processor(),
        threads(),
        list(&json, "features"),
        adapters.join(", ")
    ))
}

/// All string values with this name.
fn texts(json: &str, name: &str) -> Vec<String> {
    let key = format!("\"{name}\":\"");
    json.split(&key).skip(1).filter_map(|rest| Some(rest.split_once('"')?.0.to_owned())).collect()
}

/// The strings of the list with this name, separated by commas.
fn list(json: &str, name: &str) -> String {
    let key = format!("\"{name}\":[");
    let inside =
        json.split_once(&key).and_then(|(_, rest)| rest.split_once(']')).map_or("", |(list, _)| list);
    inside.replace('"', "").replace(',', ", ")
}

/// The name of the processor, where the system provides it in a file.
fn processor() -> String {
    let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    model.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::{civil, list, texts};

    #[test]
    fn days_are_converted_to_dates() {
        for (days, date) in [
            (0, [1970, 1, 1]),
            (59, [1970, 3, 1]),
            (11_016, [2000, 2, 29]),
            (11_017, [2000, 3, 1]),
            (20_453, [2025, 12, 31]),
            (20_454, [2026, 1, 1]),
        ] {
            assert_eq!(civil(days), date);
        }
    }

    #[test]
    fn the_output_of_doctor_is_read() {
        let json = r#"{"cpu":{"features":["avx2","fma"]},"adapters":[{"name":"a (b)","kind":"software driver"},{"name":"c"}]}"#;
        assert_eq!(list(json, "features"), "avx2, fma");
        assert_eq!(texts(json, "name"), ["a (b)", "c"]);
        assert_eq!(texts(json, "kind"), ["software driver"]);
        assert_eq!(list("{}", "features"), "");
    }
}
