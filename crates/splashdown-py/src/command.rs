//! The command line.

use pyo3::prelude::*;

/// Runs the command `splashdown` with these arguments, the first of which is the name of the program, and returns its exit
/// code.
#[pyfunction]
pub fn run_command(py: Python<'_>, arguments: Vec<String>) -> u8 {
    py.detach(|| splashdown_cli::run(arguments))
}
