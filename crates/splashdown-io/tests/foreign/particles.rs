//! Particles opened by other software.

use std::path::PathBuf;

use splashdown_io::{ParticleInfo, Particles, read_particles, write_particles};

use crate::common;
use crate::python::{Found, Sums, read, same};

/// Particles with ids that fit the signed integers of BGEO.
fn given() -> Particles {
    let ids = (0..300).map(|n| (n * 7919) % 1009).collect();
    common::particles(300).with_ids(ids).with_info(ParticleInfo::new(0.75, 0.02))
}

/// The same particles with one velocity, one position, time and spacing changed.
fn changed(given: &Particles) -> Particles {
    let mut changed = given.clone();
    changed.velocities[17][1] *= -1.0;
    changed.positions[17][1] += 1e-3;
    changed.info = ParticleInfo::new(0.76, 0.021);
    changed
}

/// Writes both sets and compares them with the arrays that `reader` finds. The changed set must differ.
fn opens(test: &str, reader: &str, ending: &str, names: [&str; 4], info: [&str; 2]) {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| -> PathBuf { folder.path().join(format!("{name}.{ending}")) };
    let (right, wrong) = (given(), changed(&given()));
    write_particles(&path("right"), &right).unwrap();
    write_particles(&path("wrong"), &wrong).unwrap();
    assert_eq!(read_particles(&path("right")).unwrap(), right);
    let Some(found) = read(test, reader, &[&path("right"), &path("wrong")]) else { return };
    let [velocity, density, pressure, id] = names;
    same(&found[0], "positions", &Sums::vectors(&right.positions));
    if !velocity.is_empty() {
        same(&found[0], velocity, &Sums::vectors(&right.velocities));
        assert!(!Sums::vectors(&right.velocities).agrees(&found[1][velocity], 1e-9), "the control");
    }
    for (name, sums) in [
        (density, Sums::numbers(&right.densities)),
        (pressure, Sums::numbers(&right.pressures)),
        (id, Sums::numbers(&right.ids)),
    ] {
        if !name.is_empty() {
            same(&found[0], name, &sums);
        }
    }
    assert!(!Sums::vectors(&right.positions).agrees(&found[1]["positions"], 1e-9), "the control");
    for (name, value) in info.into_iter().zip([0.75, 0.02]).filter(|(name, _)| !name.is_empty()) {
        let sum = |found: &Found| found.get(name).map(|sums| sums.sum());
        let near = |given: Option<f64>| given.is_some_and(|given| (given - value).abs() < 1e-9);
        assert!(near(sum(&found[0])), "`{name}` of {reader}: {:?}", sum(&found[0]));
        assert!(!near(sum(&found[1])), "the control of {name}");
    }
}

const NAMES: [&str; 4] = ["velocity", "density", "pressure", "id"];
const FIELDS: [&str; 2] = ["field TimeValue", "field particle_spacing"];

#[test]
fn vtk_opens_legacy_vtk() {
    opens("vtk_opens_legacy_vtk", "vtk", "vtk", NAMES, FIELDS);
}

#[test]
fn vtk_opens_vtu_and_vtp() {
    opens("vtk_opens_vtu", "vtu", "vtu", NAMES, FIELDS);
    opens("vtk_opens_vtp", "vtp", "vtp", NAMES, FIELDS);
    // VTK takes the time of the file from it.
    opens("vtk_opens_vtu", "vtu", "vtu", NAMES, ["time steps", ""]);
    opens("vtk_opens_vtp", "vtp", "vtp", NAMES, ["time steps", ""]);
}

#[test]
fn meshio_opens_legacy_vtk_and_vtu() {
    // It skips the field data of legacy files.
    opens("meshio_opens_legacy_vtk", "meshio", "vtk", NAMES, [""; 2]);
    opens("meshio_opens_vtu", "meshio", "vtu", NAMES, FIELDS);
}

#[test]
fn meshio_opens_ply() {
    // Its reader returns single properties.
    opens("meshio_opens_ply", "meshio", "ply", ["", "density", "pressure", "id"], [""; 2]);
}

#[test]
fn numpy_opens_npz() {
    opens(
        "numpy_opens_npz",
        "numpy",
        "npz",
        ["velocities", "densities", "pressures", "ids"],
        ["time", "particle_spacing"],
    );
}

#[test]
fn splashsurf_opens_bgeo() {
    opens("splashsurf_opens_bgeo", "splashsurf", "bgeo", [""; 4], [""; 2]);
}
