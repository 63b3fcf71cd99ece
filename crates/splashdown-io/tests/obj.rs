//! Writing OBJ files. They are read by `tobj`, which shares no code with the writer.

mod common;

use proptest::prelude::*;
use splashdown_io::{Mesh, obj, write_mesh};

/// Positions and normals of the corners of all triangles, as read by an OBJ reader.
fn corners(text: &[u8]) -> Vec<([f32; 3], Option<[f32; 3]>)> {
    let (models, _) = tobj::load_obj_buf(&mut &text[..], &tobj::LoadOptions::default(), |_| {
        Err(tobj::LoadError::GenericFailure)
    })
    .expect("a readable OBJ");
    let at = |array: &[f32], index: u32| std::array::from_fn(|axis| array[3 * index as usize + axis]);
    let mut found = Vec::new();
    for model in models {
        let mesh = model.mesh;
        for (corner, &index) in mesh.indices.iter().enumerate() {
            let normal = mesh.normal_indices.get(corner).map(|&index| at(&mesh.normals, index));
            found.push((at(&mesh.positions, index), normal));
        }
    }
    found
}

fn expected(mesh: &Mesh) -> Vec<([f32; 3], Option<[f32; 3]>)> {
    let corner = |&index: &u32| (mesh.vertices[index as usize], mesh.normals.get(index as usize).copied());
    mesh.triangles.iter().flatten().map(corner).collect()
}

fn written(mesh: &Mesh) -> Vec<u8> {
    let mut text = Vec::new();
    obj::write_mesh_to(&mut text, mesh).expect("memory takes everything");
    text
}

fn vector() -> impl Strategy<Value = [f32; 3]> {
    use prop::num::f32::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    prop::array::uniform3(POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn every_corner_is_exact(
        vertices in prop::collection::vec((vector(), vector()), 3..40),
        picks in prop::collection::vec(any::<[prop::sample::Index; 3]>(), 1..80),
        normals in any::<bool>(),
    ) {
        let triangles = picks.iter().map(|pick| pick.map(|corner| corner.index(vertices.len()) as u32)).collect();
        let mesh = Mesh::new(vertices.iter().map(|v| v.0).collect(), triangles).with_normals(vertices.iter().filter(|_| normals).map(|v| v.1).collect());
        prop_assert_eq!(corners(&written(&mesh)), expected(&mesh));
    }
}

#[test]
fn a_mesh_larger_than_the_buffer_is_exact() {
    let torus = common::torus(1.0, 0.3, 120, 60);
    let text = written(&torus);
    assert!(text.len() > 4 * 65_536);
    assert_eq!(corners(&text), expected(&torus));

    // Control: another vertex in one corner is detected.
    let mut other = torus.clone();
    other.triangles[5000][1] = 0;
    assert_ne!(corners(&written(&other)), expected(&torus));
}

#[test]
fn numbers_have_no_superfluous_digits() {
    let cube = common::cube([0.0; 3], 0.5);
    let text = String::from_utf8(written(&cube)).unwrap();
    assert!(text.contains("\nv 0.5 0.0 0.5\n") && text.contains("\nf 1 5 7\n"), "{text}");
    assert!(!text.contains("//"));
}

#[test]
fn the_ending_of_the_name_selects_the_format() {
    let folder = tempfile::tempdir().unwrap();
    let cube = common::cube([0.0; 3], 0.5);
    let path = folder.path().join("cube.OBJ");
    write_mesh(&path, &cube).unwrap();
    assert_eq!(corners(&std::fs::read(&path).unwrap()), expected(&cube));
    let message = write_mesh(&folder.path().join("cube.xyz"), &cube).unwrap_err().to_string();
    assert!(message.contains("cube.xyz") && message.contains(".ply, .vtk, .vtp, .obj, .stl"), "{message}");
}
