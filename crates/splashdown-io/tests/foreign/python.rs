//! Runs the Python readers.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// The exit code of `read.py` if a package is not installed.
const MISSING: i32 = 77;

/// Sums of an array.
#[derive(Debug, Clone, PartialEq)]
pub struct Sums {
    shape: Vec<usize>,
    sum: f64,
    weighted: f64,
    /// Weighted sum of absolute values, to which the tolerance is relative. Python does not compute it.
    amount: f64,
}

/// The sums of the arrays that a reader finds, by name.
pub type Found = BTreeMap<String, Sums>;

impl Sums {
    /// The sums of rows of numbers.
    pub fn of<const N: usize>(rows: impl IntoIterator<Item = [f64; N]>) -> Self {
        let flat: Vec<f64> = rows.into_iter().flatten().collect();
        let shape = if N == 1 { vec![flat.len()] } else { vec![flat.len() / N, N] };
        let weight = |n: usize| (n % 97 + 1) as f64;
        Self {
            shape,
            sum: flat.iter().sum(),
            weighted: flat.iter().enumerate().map(|(n, value)| value * weight(n)).sum(),
            amount: flat.iter().enumerate().map(|(n, value)| value.abs() * weight(n)).sum(),
        }
    }

    /// The sums of vectors.
    pub fn vectors(values: &[[f32; 3]]) -> Self {
        Self::of(values.iter().map(|value| value.map(f64::from)))
    }

    /// The sums of scalars.
    pub fn numbers<T: Copy + Into<f64>>(values: &[T]) -> Self {
        Self::of(values.iter().map(|&value| [value.into()]))
    }

    /// The sums of the vertex numbers of triangles, in rows of three or in a single row.
    pub fn corners(triangles: &[[u32; 3]], flat: bool) -> Self {
        let values = triangles.iter().map(|triangle| triangle.map(f64::from));
        if flat { Self::of(values.flatten().map(|corner| [corner])) } else { Self::of(values) }
    }

    /// The sum of the values.
    pub fn sum(&self) -> f64 {
        self.sum
    }

    /// Whether another array has the same shape and the same sums, within this fraction of the absolute values.
    pub fn agrees(&self, other: &Self, tolerance: f64) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= tolerance * self.amount.max(other.amount) + 1e-12;
        self.shape == other.shape && near(self.sum, other.sum) && near(self.weighted, other.weighted)
    }
}

/// The arrays that `reader` finds in each file; `None`, with a message on stderr, if Python or a package is missing.
pub fn read(test: &str, reader: &str, files: &[&Path]) -> Option<Vec<Found>> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign/read.py");
    let mut python = Command::new(interpreter());
    python.arg(script);
    for file in files {
        python.arg(reader).arg(file);
    }
    let skip = |reason: &str| {
        let _ = writeln!(
            std::io::stderr(),
            "SKIPPED: {test}: {reason}; `cargo xtask test --all` installs the packages if possible"
        );
        None
    };
    let output = match python.output() {
        Ok(output) => output,
        Err(error) => return skip(&format!("Python cannot be started ({error})")),
    };
    let stderr = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(MISSING) {
        return skip(stderr.trim());
    }
    assert!(output.status.success(), "{reader} refuses {files:?}:\n{stderr}");
    let stdout = String::from_utf8_lossy(&output.stdout);
    let answer: Vec<Value> = serde_json::from_str(stdout.lines().last().unwrap()).unwrap();
    Some(answer.iter().map(found).collect())
}

fn found(answer: &Value) -> Found {
    let arrays = answer.as_object().unwrap().iter();
    arrays.map(|(name, sums)| (name.clone(), sums_of(sums))).collect()
}

fn sums_of(sums: &Value) -> Sums {
    let number = |key: &str| sums[key].as_f64().unwrap();
    let shape = sums["shape"].as_array().unwrap();
    Sums {
        shape: shape.iter().map(|size| size.as_u64().unwrap() as usize).collect(),
        sum: number("sum"),
        weighted: number("weighted"),
        amount: 0.0,
    }
}

/// The interpreter: `SPLASHDOWN_PYTHON`, the one in the environment of `cargo xtask`, or the system's.
fn interpreter() -> PathBuf {
    if let Some(named) = std::env::var_os("SPLASHDOWN_PYTHON") {
        return named.into();
    }
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let made = ["bin/python", "Scripts/python.exe"].map(|name| target.join("python").join(name));
    made.into_iter().find(|path| path.exists()).unwrap_or_else(|| "python3".into())
}

/// Asserts that an array equals the written one.
#[track_caller]
pub fn same(found: &Found, name: &str, wanted: &Sums) {
    close(found, name, wanted, 1e-9);
}

/// Like [`same`], for readers that compute in single precision.
#[track_caller]
pub fn close(found: &Found, name: &str, wanted: &Sums, tolerance: f64) {
    let Some(given) = found.get(name) else {
        panic!("there is no `{name}` among {:?}", found.keys());
    };
    assert!(wanted.agrees(given, tolerance), "`{name}`: wanted {wanted:?}, found {given:?}");
}
