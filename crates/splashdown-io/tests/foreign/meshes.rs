//! Meshes opened by other software.

use std::path::PathBuf;

use splashdown_io::{Attribute, Mesh, read_mesh, write_mesh};

use crate::common;
use crate::python::{Found, Sums, close, read, same};

fn given() -> Mesh {
    let mut mesh = common::torus(0.4, 0.15, 24, 12);
    mesh.velocities = mesh.vertices.iter().map(|&[x, y, z]| [2.0 * z, 0.1 + x * y, -2.0 * x]).collect();
    let (heights, places) = (mesh.vertices.iter().map(|vertex| vertex[1]), mesh.vertices.as_flattened());
    mesh.attributes = vec![
        Attribute {
            name: "temperature".to_owned(),
            components: 1,
            values: heights.map(|y| 290.0 + y).collect(),
        },
        Attribute {
            name: "force".to_owned(),
            components: 3,
            values: places.iter().map(|x| 3.0 * x - 0.1).collect(),
        },
    ];
    mesh
}

/// The same mesh with one vertex, one velocity and two attributes changed, and a flipped triangle.
fn changed(given: &Mesh) -> Mesh {
    let mut changed = given.clone();
    changed.vertices[20][0] += 1e-3;
    changed.velocities[20][2] += 0.1;
    changed.attributes[0].values[20] += 1.0;
    changed.attributes[1].values[20] += 1.0;
    changed.triangles[3].swap(0, 1);
    changed
}

/// The arrays that a reader finds in a mesh of this format, and in a changed mesh.
fn found(test: &str, reader: &str, ending: &str) -> Option<[Found; 2]> {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| -> PathBuf { folder.path().join(format!("{name}.{ending}")) };
    write_mesh(&path("right"), &given()).unwrap();
    write_mesh(&path("wrong"), &changed(&given())).unwrap();
    read(test, reader, &[&path("right"), &path("wrong")])?.try_into().ok()
}

fn check(found: &[Found; 2], arrays: &[(&str, Sums)]) {
    for (name, wanted) in arrays {
        same(&found[0], name, wanted);
        assert!(*name == "normals" || !wanted.agrees(&found[1][*name], 1e-9), "the control of {name}");
    }
}

#[test]
fn vtk_opens_surfaces() {
    let mesh = given();
    let vectors = [
        ("positions", Sums::vectors(&mesh.vertices)),
        ("normals", Sums::vectors(&mesh.normals)),
        ("velocity", Sums::vectors(&mesh.velocities)),
        ("temperature", Sums::numbers(&mesh.attributes[0].values)),
        ("force", Sums::vectors(mesh.attributes[1].values.as_chunks().0)),
    ];
    for (reader, ending) in [("vtk-surface", "vtk"), ("vtp", "vtp")] {
        let Some(found) = found("vtk_opens_surfaces", reader, ending) else { return };
        check(&found, &vectors);
        check(&found, &[("cells", Sums::corners(&mesh.triangles, true))]);
        same(&found[0], "active normals", &Sums::vectors(&mesh.normals));
    }
}

#[test]
fn meshio_opens_ply_with_attributes() {
    let mesh = given();
    let Some(found) = found("meshio_opens_ply_with_attributes", "meshio", "ply") else { return };
    let axis = |vectors: &[[f32; 3]], axis: usize| -> Sums {
        Sums::numbers(&vectors.iter().map(|vector| vector[axis]).collect::<Vec<_>>())
    };
    check(
        &found,
        &[
            ("positions", Sums::vectors(&mesh.vertices)),
            ("vz", axis(&mesh.velocities, 2)),
            ("temperature", Sums::numbers(&mesh.attributes[0].values)),
        ],
    );
    for (number, name) in ["force_x", "force_y", "force_z"].into_iter().enumerate() {
        same(&found[0], name, &axis(mesh.attributes[1].values.as_chunks().0, number));
    }
}

#[test]
fn vtk_opens_ply() {
    let mesh = given();
    let Some(found) = found("vtk_opens_ply", "vtk-ply", "ply") else { return };
    check(
        &found,
        &[
            ("positions", Sums::vectors(&mesh.vertices)),
            ("normals", Sums::vectors(&mesh.normals)),
            ("cells", Sums::corners(&mesh.triangles, true)),
        ],
    );
}

#[test]
fn trimesh_opens_glb_with_velocities() {
    let mesh = given();
    let Some(found) = found("trimesh_opens_glb_with_velocities", "trimesh", "glb") else { return };
    check(
        &found,
        &[
            ("positions", Sums::vectors(&mesh.vertices)),
            ("_VELOCITY", Sums::vectors(&mesh.velocities)),
            ("cells", Sums::corners(&mesh.triangles, false)),
            ("volume", Sums::numbers(&[mesh.volume()])),
        ],
    );
    let volume = Sums::numbers(&[1.0_f64]);
    same(&found[0], "is volume", &volume);
    assert!(!volume.agrees(&found[1]["is volume"], 0.5), "the control");
}

#[test]
fn trimesh_opens_obj_ply_and_stl() {
    let mesh = given();
    for ending in ["obj", "ply", "stl"] {
        let test = format!("trimesh_opens_obj_ply_and_stl ({ending})");
        let Some(found) = found(&test, "trimesh", ending) else { return };
        // Text is read in double precision, so the last digits differ.
        close(&found[0], "volume", &Sums::numbers(&[mesh.volume()]), 1e-6);
        if ending != "stl" {
            close(&found[0], "positions", &Sums::vectors(&mesh.vertices), 1e-6);
            assert!(!Sums::vectors(&mesh.vertices).agrees(&found[1]["positions"], 1e-6), "the control");
        }
    }
}

/// Rotates y up to z up, as Blender does with formats that define y as up.
fn turned(values: &[[f32; 3]]) -> Vec<[f32; 3]> {
    values.iter().map(|&[x, y, z]| [x, -z, y]).collect()
}

#[test]
fn blender_opens_glb_and_ply() {
    let mesh = given();
    // Blender's readers do not merge vertices; the object of a PLY file is not rotated.
    for (ending, positions) in [("glb", turned(&mesh.vertices)), ("ply", mesh.vertices.clone())] {
        let test = format!("blender_opens_glb_and_ply ({ending})");
        let Some(found) = found(&test, "blender", ending) else { return };
        let frame = |name: &str| format!("{name}@1");
        close(&found[0], &frame("positions"), &Sums::vectors(&positions), 1e-6);
        close(&found[0], &frame("triangles"), &Sums::numbers(&[mesh.len() as f64]), 0.0);
        assert!(!Sums::vectors(&positions).agrees(&found[1][&frame("positions")], 1e-6), "the control");
    }
}

#[test]
fn meshes_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    for ending in ["ply", "obj", "glb", "vtk", "vtp"] {
        let path = folder.path().join(format!("mesh.{ending}"));
        write_mesh(&path, &given()).unwrap();
        let read = read_mesh(&path).unwrap();
        assert_eq!((read.vertices, read.triangles), (given().vertices, given().triangles), "{ending}");
        write_mesh(&path, &Mesh::default()).unwrap();
        assert!(read_mesh(&path).is_err(), "{ending}: a mesh without triangles is refused");
    }
}
