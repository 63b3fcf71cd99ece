//! Growing tables: reading while they grow, unusual names and numbers, full disks.

use std::fs;
use std::path::Path;

use splashdown_io::{CsvLog, IoError, WriteCause};

#[test]
fn every_row_is_in_the_file_when_the_call_returns() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("probe.csv");
    fs::write(&path, "something older and longer than the new header").unwrap();
    let mut log = CsvLog::create(&path, &["time (s)", "p (Pa)", "at 1,2 \"left\""]).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "time (s),p (Pa),\"at 1,2 \"\"left\"\"\"\n");
    log.row(&[0.0, -1234.5, 0.1]).unwrap();
    log.row(&[1e-9, f64::NAN, f64::INFINITY]).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert_eq!(text.lines().nth(1), Some("0.0,-1234.5,0.1"));
    let fields: Vec<&str> = text.lines().nth(2).unwrap().split(',').collect();
    assert_eq!(fields[0].parse(), Ok(1e-9));
    assert_eq!(fields[1..], ["", "inf"]);
    assert!(text.ends_with('\n') && log.path() == path);
}

#[test]
fn numbers_are_read_back_exactly() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("numbers.csv");
    let mut log = CsvLog::create(&path, &["x"]).unwrap();
    let values = [0.1 + 0.2, f64::MAX, f64::MIN_POSITIVE, 5e-324, -0.0, 1.0 / 3.0, 123_456_789.123_456_78];
    values.iter().for_each(|&value| log.row(&[value]).unwrap());
    log.row(&[f64::NAN]).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let read: Vec<f64> = text.lines().skip(1).filter_map(|line| line.parse().ok()).collect();
    assert_eq!(read.map_bits(), values.to_vec().map_bits());
    assert_eq!(text.lines().last(), Some("\"\""));
}

trait Bits {
    fn map_bits(self) -> Vec<u64>;
}

impl Bits for Vec<f64> {
    fn map_bits(self) -> Vec<u64> {
        self.into_iter().map(f64::to_bits).collect()
    }
}

#[test]
fn a_row_of_another_length_is_refused_and_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("probe.csv");
    let mut log = CsvLog::create(&path, &["a", "b"]).unwrap();
    for row in [&[][..], &[1.0], &[1.0, 2.0, 3.0]] {
        let error = log.row(row).unwrap_err();
        assert!(matches!(error, IoError::Columns { expected: 2, .. }));
        assert!(error.to_string().contains("probe.csv"), "{error}");
    }
    log.row(&[1.0, 2.0]).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "a,b\n1.0,2.0\n");
}

#[test]
fn a_missing_folder_is_reported() {
    let error = CsvLog::create(Path::new("no/such/folder/probe.csv"), &["a"]).unwrap_err();
    assert!(matches!(error, IoError::Write { cause: WriteCause::MissingFolder, .. }), "{error}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_reported() {
    let error = CsvLog::create(Path::new("/dev/full"), &["a"]).unwrap_err();
    assert!(matches!(error, IoError::Write { cause: WriteCause::DiskFull, .. }), "{error}");
    assert!(
        error.to_string().contains("/dev/full") && error.to_string().contains("free some space"),
        "{error}"
    );
}

/// The variable with the file name for the part of the next test that runs in its own process.
const LIMITED: &str = "SPLASHDOWN_TEST_LIMITED_CSV";

/// The file size limit of `ulimit` cuts a row in the middle, like a full disk.
#[test]
#[cfg(target_os = "linux")]
fn a_row_that_does_not_fit_leaves_only_complete_rows() {
    if let Some(path) = std::env::var_os(LIMITED) {
        let mut log = CsvLog::create(Path::new(&path), &["x", "y"]).unwrap();
        let error = (0..100_000).find_map(|n| log.row(&[f64::from(n), 0.123_456_789]).err()).unwrap();
        assert!(matches!(error, IoError::Write { cause: WriteCause::TooLarge, .. }), "{error}");
        // The next row also fails and leaves no partial row.
        log.row(&[1.0 / 3.0, 2.0 / 3.0]).unwrap_err();
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("limited.csv");
    let status = std::process::Command::new("sh")
        .args([
            "-c",
            "trap '' XFSZ; ulimit -f 4; exec \"$0\" --exact a_row_that_does_not_fit_leaves_only_complete_rows",
        ])
        .arg(std::env::current_exe().unwrap())
        .env(LIMITED, &path)
        .stdout(std::process::Stdio::null())
        .status()
        .unwrap();
    assert!(status.success());
    let text = fs::read_to_string(&path).unwrap();
    // 4 blocks of 512 or 1024 bytes are not a multiple of the length of these rows.
    assert!((1900..=4096).contains(&text.len()) && !text.len().is_multiple_of(512), "{} bytes", text.len());
    assert!(text.ends_with(",0.123456789\n"), "{text}");
    assert!(text.lines().skip(1).enumerate().all(|(n, line)| line == format!("{n}.0,0.123456789")), "{text}");
}
