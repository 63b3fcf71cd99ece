//! Compares `splashdown surface` with the program splashsurf, with equal parameters.
//!
//! Smoothed meshes differ. Both programs implement the same paper, in which an iteration blends the current position
//! of a vertex with the mean of its neighbours. splashsurf 0.14 swaps its buffers first and uses the position of the
//! previous iteration. After 10 iterations the volumes of this small block differ by 0.5 %; after 20 iterations those
//! of 64,000 splashing particles differ by 20 %.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use splashdown_io::{Particles, write_particles};

use crate::place::{Outcome, Place, stderr};

const SPACING: f32 = 0.05;
const CELL: f32 = 0.5 * SPACING;

/// The exit code of the script if a package is not installed.
const MISSING: i32 = 77;

/// A block of particles, displaced at random from their lattice, with drops above it.
fn fluid() -> Particles {
    let mut state = 1_u32;
    let mut unit = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32 - 0.5
    };
    let lattice = (0..16 * 16 * 16).map(|i| [i % 16, i / 16 % 16, i / 256].map(|c| c as f32));
    let mut positions: Vec<[f32; 3]> = lattice.map(|p| p.map(|c| SPACING * (c + 0.4 * unit()))).collect();
    positions.extend((0..30).map(|_| [unit() + 0.4, 0.5 * unit() + 1.2, unit() + 0.4]));
    Particles::from_positions(positions)
}

/// The Python interpreter, as in the tests of `splashdown-io`: `SPLASHDOWN_PYTHON`, the environment of `cargo xtask`, or
/// the system's.
fn python() -> PathBuf {
    if let Some(named) = std::env::var_os("SPLASHDOWN_PYTHON") {
        return named.into();
    }
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap_or(Path::new("."));
    let made = ["bin/python", "Scripts/python.exe"].map(|name| target.join("python").join(name));
    made.into_iter().find(|path| path.exists()).unwrap_or_else(|| "python3".into())
}

/// Distance in cells between our mesh and that of splashsurf, and the ratio of their volumes; `None` if Python or a
/// package is missing.
fn compare(
    place: &Place,
    smoothing: u32,
    level: &str,
) -> Result<Option<(f64, f64)>, Box<dyn std::error::Error>> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers/splashsurf.py");
    let mut peer = Command::new(python());
    peer.arg(script).arg(place.path("fluid.ply"));
    peer.args([&SPACING.to_string(), &CELL.to_string(), &smoothing.to_string(), level]);
    let output = match peer.arg(place.path("mesh.ply")).output() {
        Ok(output) => output,
        Err(_) => return Ok(None),
    };
    if output.status.code() == Some(MISSING) {
        return Ok(None);
    }
    assert!(output.status.success(), "{}", stderr(&output));
    let answer: Value = serde_json::from_slice(&output.stdout)?;
    let number = |key: &str| answer[key].as_f64().unwrap_or(f64::NAN);
    Ok(Some((number("distance"), number("ours") / number("theirs"))))
}

#[test]
fn the_surface_equals_that_of_splashsurf() -> Outcome {
    let place = Place::new()?;
    write_particles(&place.path("fluid.ply"), &fluid())?;
    let spacing = SPACING.to_string();
    for smoothing in [0, 10] {
        let iterations = smoothing.to_string();
        let arguments =
            ["surface", "fluid.ply", "-o", "mesh.ply", "-s", &spacing, "--smoothing", &iterations];
        let output = place.splashdown(&[&arguments[..], &["--device", "cpu"]].concat()).output()?;
        assert!(output.status.success(), "{}", stderr(&output));
        let Some((distance, volume)) = compare(&place, smoothing, "0.6")? else {
            let _ = writeln!(
                std::io::stderr(),
                "SKIPPED: the_surface_equals_that_of_splashsurf: pysplashsurf and vtk are not installed; `cargo xtask test` \
                 installs them if possible"
            );
            return Ok(());
        };
        eprintln!("smoothing {smoothing}: {distance} cells, volume ratio {volume}");
        assert!(distance < 0.5, "smoothing {smoothing}: {distance} cells");
        assert!((volume - 1.0).abs() < 0.01, "smoothing {smoothing}: volume ratio {volume}");
        // Controls: a surface about 0.1 spacings farther out, and the other number of iterations.
        let Some((_, volume)) = compare(&place, smoothing, "0.5")? else { return Ok(()) };
        assert!((volume - 1.0).abs() > 0.01, "the control's volume ratio is {volume}");
        let Some((distance, _)) = compare(&place, 10 - smoothing, "0.6")? else { return Ok(()) };
        assert!(distance > 0.5, "the control's distance is {distance} cells");
    }
    Ok(())
}
