//! PLY: round trips, files of other programs, malformed files.

mod common;

use std::fs;
use std::path::PathBuf;

use proptest::prelude::*;
use splashdown_io::{Mesh, Particles, ply, write_mesh, write_particles};
use tempfile::TempDir;

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// The bits of floats, because NaN is not equal to itself.
fn bits<const N: usize>(rows: &[[f32; N]]) -> Vec<[u32; N]> {
    rows.iter().map(|row| row.map(f32::to_bits)).collect()
}

fn scalar_bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn assert_same_bits(a: &Particles, b: &Particles) {
    assert_eq!(a.ids, b.ids);
    assert_eq!(bits(&a.positions), bits(&b.positions));
    assert_eq!(bits(&a.velocities), bits(&b.velocities));
    assert_eq!(scalar_bits(&a.densities), scalar_bits(&b.densities));
    assert_eq!(scalar_bits(&a.pressures), scalar_bits(&b.pressures));
}

fn vector() -> impl Strategy<Value = [f32; 3]> {
    // Every kind of float except signalling NaN, whose bits may change.
    prop::array::uniform3(prop::num::f32::ANY)
}

prop_compose! {
    /// Any values, any attributes; also with lengths around the writer's chunk size.
    fn some_particles()(count in prop_oneof![0..40_usize, 2047..2050_usize], has in any::<[bool; 4]>())
        (count in Just(count),
         rows in prop::collection::vec((vector(), vector(), prop::num::f32::ANY, prop::num::f32::ANY, any::<u32>()), count),
         has in Just(has)) -> Particles {
        let keep = |wanted: bool| if wanted { count } else { 0 };
        Particles::from_positions(rows.iter().map(|row| row.0).collect()).with_velocities(rows.iter().take(keep(has[0])).map(|row| row.1).collect()).with_densities(rows.iter().take(keep(has[1])).map(|row| row.2).collect()).with_pressures(rows.iter().take(keep(has[2])).map(|row| row.3).collect()).with_ids(rows.iter().take(keep(has[3])).map(|row| row.4).collect())
    }
}

prop_compose! {
    fn some_mesh()(vertices in prop::collection::vec((vector(), vector(), vector()), 1..60), [normals, velocities] in any::<[bool; 2]>())
        (triangles in prop::collection::vec(prop::array::uniform3(0..vertices.len() as u32), 0..120),
         vertices in Just(vertices), [normals, velocities] in Just([normals, velocities])) -> Mesh {
        Mesh::new(vertices.iter().map(|v| v.0).collect(), triangles).with_normals(vertices.iter().filter(|_| normals).map(|v| v.1).collect()).with_velocities(vertices.iter().filter(|_| velocities).map(|v| v.2).collect())
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn particles_round_trip_bit_by_bit(particles in some_particles()) {
        let folder = folder();
        let path = folder.path().join("particles.ply");
        let bytes = write_particles(&path, &particles).unwrap();
        prop_assert_eq!(bytes, fs::metadata(&path).unwrap().len());
        assert_same_bits(&ply::read_particles(&path).unwrap(), &particles);
    }

    #[test]
    fn meshes_round_trip_bit_by_bit(mesh in some_mesh()) {
        let folder = folder();
        let path = folder.path().join("mesh.ply");
        write_mesh(&path, &mesh).unwrap();
        let read = ply::read_mesh(&path).unwrap();
        prop_assert_eq!(bits(&read.vertices), bits(&mesh.vertices));
        prop_assert_eq!(bits(&read.normals), bits(&mesh.normals));
        prop_assert_eq!(read.triangles, mesh.triangles);
    }

    #[test]
    fn a_file_cut_anywhere_is_refused(particles in some_particles(), at in 0.0..1.0_f64) {
        prop_assume!(!particles.is_empty());
        let folder = folder();
        let path = folder.path().join("cut.ply");
        write_particles(&path, &particles).unwrap();
        let whole = fs::read(&path).unwrap();
        fs::write(&path, &whole[..(whole.len() as f64 * at) as usize]).unwrap();
        let message = ply::read_particles(&path).unwrap_err().to_string();
        prop_assert!(message.contains("cut.ply"), "{}", message);
    }

    #[test]
    fn a_file_with_a_changed_byte_does_not_cause_a_panic(mesh in some_mesh(), at in any::<prop::sample::Index>(), to in any::<u8>()) {
        let folder = folder();
        let path = folder.path().join("changed.ply");
        write_mesh(&path, &mesh).unwrap();
        let mut bytes = fs::read(&path).unwrap();
        let at = at.index(bytes.len());
        bytes[at] = to;
        fs::write(&path, bytes).unwrap();
        // Both outcomes are valid, but a mesh must be consistent.
        if let Ok(read) = ply::read_mesh(&path) {
            prop_assert!(read.check().is_ok());
        }
    }
}

#[test]
fn the_round_trip_test_detects_one_changed_bit() {
    let folder = folder();
    let path = folder.path().join("particles.ply");
    let particles = common::particles(100);
    write_particles(&path, &particles).unwrap();
    let mut bytes = fs::read(&path).unwrap();
    let last = bytes.len() - 36 * 7 - 20;
    bytes[last] ^= 1;
    fs::write(&path, bytes).unwrap();
    let read = ply::read_particles(&path).unwrap();
    assert_ne!(read, particles);
    assert_eq!(read.len(), particles.len());
}

/// Writes `contents`; returns the path and the folder, which is removed on drop.
fn file(contents: &[u8]) -> (TempDir, PathBuf) {
    let folder = folder();
    let path = folder.path().join("given.ply");
    fs::write(&path, contents).unwrap();
    (folder, path)
}

#[test]
fn a_foreign_text_file_with_other_types_and_quads_is_read() {
    let text = "ply\r\nformat ascii 1.0\r\ncomment made elsewhere\r\nobj_info scanned\r\nelement camera 1\r\nproperty float focal\r\n\
        element vertex 4\r\nproperty double z\r\nproperty uchar red\r\nproperty double x\r\nproperty int y\r\n\
        property list uchar float weights\r\nelement face 1\r\nproperty list uint8 uint16 vertex_index\r\nend_header\r\n\
        35\r\n0.5 255 0 0 0\r\n0.5 0 1 0 2 1e-1 0.5\r\n0.5 0 1 1 0\r\n0.5 9 0 1 1 1.0\r\n4 0 1 2 3";
    let (_keep, path) = file(text.as_bytes());
    let mesh = ply::read_mesh(&path).unwrap();
    assert_eq!(mesh.vertices, [[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [1.0, 1.0, 0.5], [0.0, 1.0, 0.5]]);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert!(mesh.normals.is_empty());

    // The vertices of a mesh are not particles; without faces they are.
    assert!(ply::read_particles(&path).unwrap_err().to_string().contains("it is a mesh of 1 face,"));
    let (_keep, path) = file(text.replace("face 1", "face 0").as_bytes());
    let particles = ply::read_particles(&path).unwrap();
    assert_eq!(particles.positions, mesh.vertices);
    assert!(particles.ids.is_empty() && particles.velocities.is_empty());
}

#[test]
fn a_foreign_big_endian_file_is_read() {
    let mut bytes =
        b"ply\nformat binary_big_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
        property float z\nproperty double id\nproperty float rho\nproperty float vx\nend_header\n"
            .to_vec();
    for (row, id) in [([1.0_f32, 2.0, 3.0], 7.0_f64), ([-1.0, -2.0, -3.0], 16_777_217.0)] {
        row.iter().for_each(|value| bytes.extend(value.to_be_bytes()));
        bytes.extend(id.to_be_bytes());
        [998.2_f32, 5.0].iter().for_each(|value| bytes.extend(value.to_be_bytes()));
    }
    let (_keep, path) = file(&bytes);
    let particles = ply::read_particles(&path).unwrap();
    assert_eq!(particles.positions, [[1.0, 2.0, 3.0], [-1.0, -2.0, -3.0]]);
    assert_eq!(particles.ids, [7, 16_777_217]);
    assert_eq!(particles.densities, [998.2; 2]);
    assert!(particles.velocities.is_empty(), "one component is not a velocity");
}

#[test]
fn malformed_files_are_refused_with_the_reason() {
    let xyz = "property float x\nproperty float y\nproperty float z\n";
    let header = |body: &str| format!("ply\nformat ascii 1.0\n{body}end_header\n");
    let triangle =
        "element vertex 3\n".to_owned() + xyz + "element face 1\nproperty list uchar int vertex_indices\n";
    let corners = "0 0 0\n1 0 0\n0 1 0\n";
    let cases = [
        (String::new(), "does not begin with the line `ply`"),
        ("solid cube\n".to_owned(), "does not begin with the line `ply`"),
        ("ply\nformat ascii 1.0\nelement vertex 3\n".to_owned(), "end_header"),
        (header(&format!("element point 1\n{xyz}")) + "0 0 0\n", "no element `face`, only: point"),
        (
            header("element vertex 1\nproperty float x\nproperty float y\nelement face 0\n") + "0 0\n",
            "no property `z`",
        ),
        (
            header(&format!("element vertex 999999999999\n{xyz}element face 0\n")),
            "declares 999999999999 `vertex`",
        ),
        (header("element vertex 99999999999\nelement face 0\n"), "without any property"),
        (header(&triangle) + "0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n", "zero"),
        (header(&triangle) + corners, "in element `face`"),
        (header(&triangle) + corners + "3 0 1 3\n", "triangle 0 uses vertex 3, but the mesh has 3 vertices"),
        (header(&triangle) + corners + "3 0 1 -1\n", "vertex_indices"),
        (header(&triangle) + corners + "2 0 1\n", "face 0 has 2 corners"),
        (header(&triangle) + corners + "0\n", "face 0 has no corners"),
        (header(&triangle) + corners + "99999999999 0 1\n", "in element `face`"),
    ];
    for (text, reason) in cases {
        let (_keep, path) = file(text.as_bytes());
        let message = ply::read_mesh(&path).unwrap_err().to_string();
        assert!(
            message.contains(reason) && message.contains("given.ply"),
            "wanted `{reason}`, got: {message}"
        );
        assert!(!message.contains('\n'), "{message}");
    }
    // Control: the complete file is read.
    let (_keep, path) = file((header(&triangle) + corners + "3 0 1 2\n").as_bytes());
    assert_eq!(ply::read_mesh(&path).unwrap().triangles, [[0, 1, 2]]);
}

/// A header of the given lines after `ply` and the format.
fn header(format: &str, lines: &[&str]) -> String {
    format!("ply\nformat {format} 1.0\n{}\nend_header\n", lines.join("\n"))
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z";

#[test]
fn malformed_header_lines_are_named() {
    for (line, reason) in [
        ("element vertex 2", "line 7 (`element vertex 2`): the element `vertex` is declared twice"),
        ("element face many", "`many` is not a count"),
        ("element face -1", "`-1` is not a count"),
        ("element face", "it is not one of `format`, `element`"),
        ("property float x", "the property `x` is declared twice"),
        ("property half w", "the type `half` is not known; allowed are char,"),
        ("property list float int w", "the count of a list must be an integer"),
        ("property list int w", "allowed are `property TYPE NAME` and `property list TYPE TYPE NAME`"),
        ("property w", "allowed are `property TYPE NAME`"),
        ("format ascii 2.0", "`binary_big_endian` of version 1.0 are read"),
        ("format morse 1.0", "the formats `ascii`, `binary_little_endian`"),
        ("\u{7f}\u{1}", "line 7"),
    ] {
        let (_keep, path) = file(header("ascii", &["element vertex 1", XYZ, line]).as_bytes());
        let message = ply::read_particles(&path).unwrap_err().to_string();
        assert!(message.contains(reason) && !message.contains('\n'), "wanted `{reason}`, got: {message}");
    }
    let (_keep, path) = file(b"ply\nproperty float x\nend_header\n");
    assert!(ply::read_particles(&path).unwrap_err().to_string().contains("must follow its `element`"));
    let (_keep, path) = file(b"ply\nelement vertex 0\nend_header\n");
    assert!(ply::read_particles(&path).unwrap_err().to_string().contains("no line `format`"));
    let (_keep, path) = file(&[b"ply\ncomment ".as_slice(), &[b'x'; 2_000_000]].concat());
    assert!(ply::read_particles(&path).unwrap_err().to_string().contains("line 2 has more than"));
}

#[test]
fn text_is_read_with_every_notation_of_numbers() {
    let lines = ["comment", "element vertex 4", XYZ, "property int id", "property uchar p", "comment last"];
    let text = header("ascii", &lines)
        + "1 .5 2. 7 0\n\n  -1e3\t+4 1E-2 2.0 255 after the last property\r\nnan inf -inf 3 1\n0 0 0 4 2";
    let (_keep, path) = file(text.as_bytes());
    let particles = ply::read_particles(&path).unwrap();
    assert_eq!(particles.positions[..2], [[1.0, 0.5, 2.0], [-1000.0, 4.0, 0.01]]);
    assert!(
        particles.positions[2][0].is_nan()
            && particles.positions[2][1..] == [f32::INFINITY, f32::NEG_INFINITY]
    );
    assert_eq!(particles.ids, [7, 2, 3, 4]);
    assert_eq!(particles.pressures, [0.0, 255.0, 1.0, 2.0]);
    for (wrong, reason) in [
        ("1 .5 2. 7 0", "file ends after 3"),
        ("0 0 0 4 256", "line 16: `256` is not a number of the type of property `p`"),
        ("0 0 0 0.5 2", "`0.5` is not a number of the type of property `id`"),
        ("0 0 0 -4 2", "property `id`: -4 is not an integer from 0 to 4294967295"),
        ("0 0 0 4", "line 16: it ends before property `p`"),
    ] {
        let changed = if reason.contains("ends after") {
            text.replace(&format!("{wrong}\n"), "")
        } else {
            text.replace("0 0 0 4 2", wrong)
        };
        let (_keep, path) = file(changed.as_bytes());
        let message = ply::read_particles(&path).unwrap_err().to_string();
        assert!(message.contains(reason), "wanted `{reason}`, got: {message}");
    }
}

/// More rows than fit into a block, faces before vertices, skipped lists, and several number types.
#[test]
fn a_large_file_with_elements_in_another_order_is_read() {
    const VERTICES: u32 = 40_000;
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let lines = [
            "element edge 3\nproperty list uchar double weights",
            "element face 20000\nproperty uchar flags\nproperty list ushort uint vertex_indices\nproperty list int short u",
            &format!("element vertex {VERTICES}"),
            "property ushort y\nproperty double x\nproperty list uchar uchar name\nproperty float z",
        ];
        let mut bytes = header(format, &lines).into_bytes();
        let mut row = |values: &[(usize, f64)]| {
            for &(kind, value) in values {
                let little = match kind {
                    1 => vec![value as u8],
                    2 => (value as i64 as u16).to_le_bytes().to_vec(),
                    3 => (value as i64 as u32).to_le_bytes().to_vec(),
                    4 => (value as f32).to_le_bytes().to_vec(),
                    _ => value.to_le_bytes().to_vec(),
                };
                match format {
                    "ascii" => bytes.extend(format!("{value} ").bytes()),
                    "binary_big_endian" => bytes.extend(little.iter().rev()),
                    _ => bytes.extend(little),
                }
            }
            if format == "ascii" {
                bytes.push(b'\n');
            }
        };
        for _ in 0..3 {
            row(&[(1, 2.0), (8, 0.5), (8, -0.5)]);
        }
        for face in 0..20_000 {
            let corners =
                [f64::from(face), f64::from(face + 1), f64::from(face + 2), f64::from(VERTICES - 1 - face)];
            let corners = &corners[..if face % 2 == 0 { 4 } else { 3 }];
            let mut values = vec![(1, 9.0), (2, corners.len() as f64)];
            values.extend(corners.iter().map(|&corner| (3, corner)));
            values.extend([(3, 2.0), (2, -1.0), (2, 300.0)]);
            row(&values);
        }
        for vertex in 0..VERTICES {
            let value = f64::from(vertex);
            row(&[(2, value), (8, -value), (1, 1.0), (1, 65.0), (4, value + 0.5)]);
        }
        let (_keep, path) = file(&bytes);
        let mesh = ply::read_mesh(&path).unwrap();
        assert_eq!(mesh.vertices.len(), VERTICES as usize, "{format}");
        for (vertex, position) in mesh.vertices.iter().enumerate() {
            let value = vertex as f32;
            assert_eq!(*position, [-value, value, value + 0.5], "{format}");
        }
        assert_eq!(mesh.triangles.len(), 30_000, "{format}");
        assert_eq!(mesh.triangles[..3], [[0, 1, 2], [0, 2, VERTICES - 1], [1, 2, 3]], "{format}");
        assert_eq!(mesh.triangles[29_999], [19_999, 20_000, 20_001], "{format}");
        // Cut inside the last row.
        let (_keep, path) = file(&bytes[..bytes.len() - 3 - usize::from(format == "ascii") * 12]);
        let message = ply::read_mesh(&path).unwrap_err().to_string();
        assert!(message.contains("in element `vertex`: "), "{message}");
    }
}

#[test]
fn malicious_list_lengths_do_not_allocate_memory() {
    for (count, item) in [("uint", "double"), ("int", "uchar"), ("uint", "uint")] {
        for name in ["vertex_indices", "other"] {
            let property = format!("property list {count} {item} {name}");
            let corners = "property list uchar uchar vertex_index";
            let lines = ["element face 1", &property, corners, "element vertex 0", XYZ];
            let bytes = [header("binary_little_endian", &lines).as_bytes(), &[0xff; 20]].concat();
            let (_keep, path) = file(&bytes);
            let message = ply::read_mesh(&path).unwrap_err().to_string();
            assert!(message.contains("in element `face`: row 0: "), "{message}");
            let reason =
                if count == "int" { "-1 is not an integer from 0" } else { "bytes are needed, 16 are left" };
            assert!(message.contains(reason) || name == "other", "{message}");
        }
    }
}

#[test]
fn a_missing_file_is_named() {
    let path = folder().path().join("absent.ply");
    let message = ply::read_particles(&path).unwrap_err().to_string();
    assert!(message.contains("absent.ply"), "{message}");
}
