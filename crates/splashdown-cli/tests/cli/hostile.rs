//! Input that is made to exhaust memory, to block, or to control the terminal.

use std::fs;
use std::io::{Cursor, Write as _};

use crate::place::{Outcome, Place, assert_refused, stderr};

/// An NPZ file of this many positions, all zero, which compress by a factor of a thousand.
fn zeros(positions: usize) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({positions}, 3), }}\n");
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Deflated)
        .compression_level(Some(1));
    zip.start_file("positions.npy", options)?;
    zip.write_all(b"\x93NUMPY\x01\x00")?;
    zip.write_all(&(header.len() as u16).to_le_bytes())?;
    zip.write_all(header.as_bytes())?;
    let block = vec![0; 12 << 16];
    for start in (0..positions).step_by(1 << 16) {
        zip.write_all(&block[..12 * (positions - start).min(1 << 16)])?;
    }
    Ok(zip.finish()?.into_inner())
}

#[test]
fn an_archive_that_becomes_large_is_refused() -> Outcome {
    let place = Place::new()?;
    // 300 MiB in 1.3 MB.
    let bytes = zeros(25 << 20)?;
    assert!(bytes.len() < 2 << 20, "{}", bytes.len());
    place.write("large.npz", bytes)?;
    let surface = |file: &str, more: &[&str]| {
        let arguments = ["surface", file, "-o", "a.ply", "--particle-spacing", "0.1", "--device", "cpu"];
        place.splashdown(&[&arguments[..], more].concat()).output()
    };
    let output = surface("large.npz", &[])?;
    assert_refused(&output, 3, &["large.npz", "300.0 MiB", "256.0 MiB", "--input-limit"]);
    // The limit can be set.
    place.write("small.npz", zeros(200_000)?)?;
    assert_refused(&surface("small.npz", &["--input-limit", "0.001"])?, 3, &["2.3 MiB", "1.0 MiB"]);
    assert_refused(&surface("small.npz", &["--input-limit", "0"])?, 2, &["--input-limit", "GiB"]);
    let output = surface("small.npz", &["--input-limit", "1"])?;
    assert!(!stderr(&output).contains("--input-limit"), "{}", stderr(&output));
    Ok(())
}

#[test]
#[cfg(unix)]
fn pipes_and_devices_are_refused() -> Outcome {
    let place = Place::new()?;
    let checkpoint = ["run", "--resume", "pipe.splashdown"];
    let cases: [(&str, &[&str], i32); 7] = [
        ("pipe.toml", &["check", "pipe.toml"], 3),
        ("pipe.npz", &["surface", "pipe.npz", "-o", "a.ply", "--particle-spacing", "0.1"], 3),
        ("pipe.ply", &["surface", "pipe.ply", "-o", "a.ply", "--particle-spacing", "0.1"], 3),
        ("pipe.npy", &["surface", "pipe.npy", "-o", "a.ply", "--particle-spacing", "0.1"], 3),
        ("pipe.csv", &["plot", "pipe.csv", "-o", "a.svg"], 3),
        ("pipe.splashdown", &checkpoint, 5),
        ("pipe", &["run", "pipe"], 3),
    ];
    for (name, arguments, code) in cases {
        let made = std::process::Command::new("mkfifo").arg(place.path(name)).status()?;
        assert!(made.success());
        // Reading the pipe would wait for ever.
        let mut command = place.splashdown(arguments);
        let output = command.timeout(std::time::Duration::from_secs(20)).output()?;
        assert_refused(&output, code, &[name, "pipe"]);
    }
    assert_refused(&place.splashdown(&["check", "/dev/zero"]).output()?, 3, &["/dev/zero", "device"]);
    assert_refused(&place.splashdown(&["plot", "/dev/zero", "-o", "a.svg"]).output()?, 3, &["device"]);
    Ok(())
}

#[test]
#[cfg(feature = "plot")]
fn a_table_of_thousands_of_columns_is_refused_and_columns_can_be_selected() -> Outcome {
    let place = Place::new()?;
    let columns = |unit: fn(usize) -> String| {
        let names: Vec<String> = (0..3000).map(|n| format!("c{n} ({})", unit(n))).collect();
        let row = vec!["1"; 3001].join(",");
        format!("time (s),{}\n{row}\n{row}\n", names.join(","))
    };
    place.write("units.csv", columns(|n| format!("u{n}")))?;
    place.write("same.csv", columns(|_| "m".to_owned()))?;
    for out in ["a.svg", "a.png"] {
        let output = place.splashdown(&["plot", "units.csv", "-o", out]).output()?;
        assert_refused(&output, 2, &["3000 columns with 3000 units", "--columns"]);
        assert_refused(
            &place.splashdown(&["plot", "same.csv", "-o", out]).output()?,
            2,
            &["3000 columns with 1 unit"],
        );
        let output = place.splashdown(&["plot", "units.csv", "-o", out, "--columns", "c7,c2999"]).output()?;
        assert!(output.status.success(), "{}", stderr(&output));
    }
    assert_eq!(image::open(place.path("a.png"))?.height(), 580);
    let output = place.splashdown(&["plot", "units.csv", "-o", "a.svg", "--columns", "c7,d"]).output()?;
    assert_refused(&output, 2, &["`d`", "c0, c1"]);
    // Forty panels are drawn.
    let many: Vec<String> = (0..40).map(|n| format!("c{n}")).collect();
    let output =
        place.splashdown(&["plot", "units.csv", "-o", "a.png", "--columns", &many.join(",")]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    Ok(())
}

#[test]
#[cfg(feature = "plot")]
fn control_characters_in_names_are_replaced() -> Outcome {
    let place = Place::new()?;
    place.write("a.csv", "time (s),he\u{1b}[31might\u{7}\u{0} (m),w\u{8}idth (m)\n0,1,2\n1,2,3\n")?;
    let output = place.splashdown(&["plot", "a.csv", "-o", "a.svg", "--title", "a\u{1b}b"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let text = fs::read_to_string(place.path("a.svg"))?;
    assert!(!text.chars().any(|c| c.is_control() && c != '\n'), "no control characters");
    let document = roxmltree::Document::parse(&text)?;
    assert!(
        document
            .descendants()
            .any(|node| node.text().is_some_and(|text| text.contains("he\u{fffd}[31might")))
    );
    // Messages do not control the terminal.
    place.write("b.csv", "time (s),a (m)\n0,\u{1b}]0;x\u{7}\n")?;
    let output = place.splashdown(&["plot", "b.csv", "-o", "b.svg"]).output()?;
    assert_refused(&output, 3, &["line 2", "\u{fffd}]0;x\u{fffd}"]);
    let name = "c\u{1b}[2J.toml";
    let output = place.splashdown(&["check", name]).output()?;
    assert!(
        !stderr(&output).contains('\u{1b}') && stderr(&output).contains("c\u{fffd}[2J"),
        "{:?}",
        stderr(&output)
    );
    Ok(())
}
