//! `splashdown plot`.

use std::fs;

use crate::place::{Outcome, Place, assert_refused, stderr};

#[test]
fn tables_become_pictures() -> Outcome {
    let place = Place::new()?;
    fs::write(place.path("left.csv"), "time (s),height (m)\n0,0.5\n0.1,0.4\n0.2,0.3\n")?;
    fs::write(place.path("gate.csv"), "time (s),force x (N),torque z (N m)\n0,1,2\n0.1,,3\n0.2,5,4\n")?;
    let output =
        place.splashdown(&["plot", "left.csv", "gate.csv", "-o", "plot.svg", "--title", "Dam"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let svg = fs::read_to_string(place.path("plot.svg"))?;
    let document = roxmltree::Document::parse(&svg)?;
    assert!(document.root_element().has_tag_name("svg"));
    let words: Vec<&str> = document.descendants().filter_map(|node| node.text()).map(str::trim).collect();
    for word in ["Dam", "time (s)", "height (m)", "force x (N)", "left", "gate: force x", "gate: torque z"] {
        assert!(words.contains(&word), "{word} is missing among {words:?}");
    }
    let output = place.splashdown(&["plot", "left.csv", "-o", "plot.png", "--size", "400x300"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let picture = image::open(place.path("plot.png"))?.to_rgb8();
    assert_eq!(picture.dimensions(), (400, 300));
    assert!(
        picture.pixels().filter(|pixel| pixel.0 == [0, 114, 178]).count() > 100,
        "a curve in the first colour"
    );
    Ok(())
}

#[test]
fn invalid_tables_and_outputs_are_refused() -> Outcome {
    let place = Place::new()?;
    fs::write(place.path("good.csv"), "time (s),height (m)\n0,0.5\n")?;
    fs::write(place.path("bad.csv"), "time (s),height (m)\n0,0.5\n0.1,high\n")?;
    for (table, out, code, words) in [
        ("absent.csv", "p.svg", 3, &["absent.csv"][..]),
        ("bad.csv", "p.svg", 3, &["bad.csv", "line 3", "high"]),
        ("good.csv", "p.pdf", 2, &["p.pdf", ".svg, .png"]),
        ("good.csv", "missing/p.svg", 5, &["missing"]),
    ] {
        assert_refused(&place.splashdown(&["plot", table, "-o", out]).output()?, code, words);
    }
    fs::create_dir(place.path("probes"))?;
    let folder = place.splashdown(&["plot", "probes", "-o", "a.svg"]).output()?;
    assert_refused(&folder, 3, &["folder", "*.csv"]);
    Ok(())
}
