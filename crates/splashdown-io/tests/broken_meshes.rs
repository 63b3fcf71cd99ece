//! Mesh files that are malformed, truncated, of other formats or malicious. The error contains the file and the reason.

mod common;

use std::fs;
use std::path::PathBuf;

use common::gltf_files::{CUBE_AT_ORIGIN, Cube, glb, glb_of, gltf_inside};
use proptest::prelude::*;
use splashdown_io::{Format, IoError, read_mesh, write_mesh, write_particles};
use tempfile::TempDir;

/// Writes `contents`; returns the path and the folder, which is removed on drop.
fn file(name: &str, contents: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, contents).unwrap();
    (folder, path)
}

/// The error message of a file that must be refused.
fn message(name: &str, contents: &[u8]) -> String {
    let (_keep, path) = file(name, contents);
    let message = match read_mesh(&path) {
        Ok(mesh) => panic!("{name} was read as {} triangles", mesh.len()),
        Err(error) => error.to_string(),
    };
    assert!(message.contains(name) && !message.contains('\n'), "{message}");
    message
}

#[track_caller]
fn refused(name: &str, contents: &[u8], reason: &str) {
    let message = message(name, contents);
    assert!(message.contains(reason), "wanted `{reason}`, got: {message}");
}

/// The bytes of a small mesh in each format.
fn whole_files() -> Vec<(&'static str, Vec<u8>)> {
    let torus = common::torus(1.0, 0.25, 6, 5);
    let mut files: Vec<_> = ["whole.obj", "whole.stl", "whole.ply", "whole.vtk", "whole.vtp"]
        .into_iter()
        .map(|name| {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join(name);
            write_mesh(&path, &torus).unwrap();
            (name, fs::read(path).unwrap())
        })
        .collect();
    let text = "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid x\n";
    files.push(("text.stl", text.repeat(9).into_bytes()));
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        element face 2\nproperty list uint int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
    files.push(("text.ply", text.into()));
    files.push(("whole.gltf", gltf_inside(&Cube::new(CUBE_AT_ORIGIN)).into_bytes()));
    files.push(("whole.glb", glb(&Cube::new(CUBE_AT_ORIGIN))));
    files
}

#[test]
fn files_of_other_formats_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let missing = read_mesh(&folder.path().join("absent.obj")).unwrap_err();
    assert!(
        matches!(missing, IoError::Read { .. }) && missing.to_string().contains("absent.obj"),
        "{missing}"
    );
    let unknown = read_mesh(&folder.path().join("boat.fbx")).unwrap_err().to_string();
    let endings = Format::endings(Format::reads_meshes);
    assert!(endings.len() == 7 && endings.iter().all(|ending| unknown.contains(ending)), "{unknown}");
    assert!(matches!(read_mesh(&folder.path().join("boat")), Err(IoError::UnknownFormat { .. })));
    for name in ["folder.obj", "folder.stl", "folder.ply", "folder.glb", "folder.vtk", "folder.vtp"] {
        let path = folder.path().join(name);
        fs::create_dir(&path).unwrap();
        let message = read_mesh(&path).unwrap_err().to_string();
        assert!(message.contains("it is a folder"), "{message}");
    }
    for (name, _) in whole_files() {
        message(name, b"");
        message(name, b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x02\0");
        message(name, &[0xff; 300]);
        message(name, "just some words\nin two lines\n".as_bytes());
        message(name, &vec![b'{'; 100_000]);
    }
}

#[test]
#[cfg(unix)]
fn a_device_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["endless.obj", "endless.stl", "endless.ply", "endless.glb", "endless.vtk", "endless.vtp"] {
        let path = folder.path().join(name);
        std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
        let message = read_mesh(&path).unwrap_err().to_string();
        assert!(message.contains("not a regular file"), "{message}");
    }
}

#[test]
fn malformed_obj_files_are_refused_with_the_line() {
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (rest, reason) in [
        ("", "no triangles (3 vertices"),
        ("f 1 2\n", "line 4: a face with 2 corners"),
        ("f\n", "line 4: a face with 0 corners"),
        ("f 1 2 4\n", "line 4: a face uses vertex 4, but the file has 3 vertices (numbered from 1)"),
        ("\n# x\nf 1 2 0\n", "line 6: vertex 0: the vertices of an OBJ file are numbered from 1"),
        ("f 1 2 -4\n", "line 4: a face uses vertex -4, but there are 3 vertices"),
        ("f 1 2 -9223372036854775808\n", "line 4: a face uses vertex -9223372036854775808"),
        ("f 1 2 9223372036854775807\n", "line 4: a face uses vertex 9223372036854775807"),
        ("f 1 2 99999999999999999999\n", "line 4: `99999999999999999999` is not a vertex number"),
        ("f 1 2 4294967296\n", "line 4: a face uses vertex 4294967296"),
        ("f 1 2 c\n", "line 4: `c` is not a vertex number"),
        ("v 1 2\n", "line 4: a vertex needs three coordinates"),
        ("v 1 2 3,5\n", "line 4: `3,5` is not a coordinate"),
        (
            "v NaN 0 0\nv 0 inf 0\nf 1 2 3\n",
            "2 of its 5 vertices are not finite, the first is number 3 (from 0)",
        ),
        ("v 1e99 0 0\nf 1 2 3\n", "1 of its 4 vertices are not finite"),
    ] {
        refused("given.obj", format!("{corners}{rest}").as_bytes(), reason);
    }
    refused("given.obj", b"one\ntwo\n\nthree", "none of its 3 lines is a vertex");
    // Control: the same vertices with a valid face.
    let (_keep, path) = file("given.obj", format!("{corners}f 1 2 3\n").as_bytes());
    assert_eq!(read_mesh(&path).unwrap().triangles, [[0, 1, 2]]);
}

#[test]
fn malformed_stl_files_are_refused_with_the_line_or_the_missing_bytes() {
    let (name, whole) = (
        "given.stl",
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n",
    );
    for (from, to, reason) in [
        ("vertex 1 0 0\n", "", "line 7: a facet with 2 corners"),
        ("vertex 1 0 0\n", "vertex 1 0\n", "line 5: a vertex needs three numbers"),
        ("vertex 1 0 0\n", "vertex 1 0 zero\n", "line 5: a vertex needs three numbers"),
        ("vertex 1 0 0\n", "vertex 1 0 nan\n", "1 of its 3 vertices are not finite"),
        ("endfacet\nendsolid\n", "", "without `endsolid`"),
        ("endsolid\n", "", "without `endsolid`"),
        ("endfacet\n", "facet normal 0 0 1\n", "line 8: a facet begins inside another"),
        ("outer loop", "inner loop", "line 3: `inner` is not a keyword of STL"),
    ] {
        refused(name, whole.replacen(from, to, 1).as_bytes(), reason);
    }
    refused(name, b"solid empty\nendsolid empty\n", "no triangles (0 vertices");
    refused(name, &[0; 84], "no triangles (0 vertices");
    refused(name, &[0; 83], "its 83 bytes are fewer than the 84 of a binary header");
    refused(
        name,
        &[0xff; 84],
        "declares 4294967295 triangles, which need 214748364834 bytes, but the file has 84",
    );
}

#[test]
fn a_ply_file_of_points_is_refused_as_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.ply");
    write_particles(&path, &common::particles(7)).unwrap();
    let message = read_mesh(&path).unwrap_err().to_string();
    assert!(
        message.contains("no element `face`") && message.contains("(7 points): a mesh needs faces too"),
        "{message}"
    );
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uint uint vertex_indices\nend_header\n";
    // No memory may be allocated for the 4 * 10^9 entries that the list declares.
    refused("given.ply", &[header.as_bytes(), &[0xff; 8]].concat(), "in element `face`");
}

#[test]
fn malformed_gltf_files_are_refused_with_the_reason() {
    let json = Cube::new(CUBE_AT_ORIGIN).json("");
    let buffer = Cube::new(CUBE_AT_ORIGIN).buffer;
    for (from, to, reason) in [
        ("\"count\": 24", "\"count\": 25", "does not fit"),
        ("\"count\": 24", "\"count\": 18446744073709551615", "does not fit"),
        ("\"count\": 24", "\"count\": 0", "a triangle uses vertex"),
        ("\"count\": 24", "\"count\": 20", "in mesh 0: a triangle uses vertex 20, but there are 20 vertices"),
        ("\"count\": 36", "\"count\": 35", "is not a multiple of 3"),
        ("\"count\": 36", "\"count\": 0", "no triangles (8 vertices"),
        ("\"byteOffset\": 288", "\"byteOffset\": 18446744073709551615", "does not fit"),
        ("5126", "5125", "5126 (float)"),
        ("5123", "5122", "(unsigned)"),
        ("5123", "9999", "(unsigned)"),
        ("\"VEC3\"", "\"VEC2\"", "5126 (float)"),
        ("\"mode\": 4", "\"mode\": 1", "no triangles"),
        ("\"POSITION\": 0", "\"POSITION\": 9", "uses array 9, but has 2"),
        ("\"buffer\": 0", "\"buffer\": 7", "uses buffer 7, but has 1"),
        ("\"mesh\": 0", "\"mesh\": 1", "uses mesh 1, but has 1"),
        ("\"mesh\": 0", "\"mesh\": 0, \"children\": [0]", "or of itself"),
        ("\"nodes\": [0]", "\"nodes\": [0, 0]", "more than one node"),
        ("\"scene\": 0, \"scenes\": [{\"nodes\": [0]}],", "", "it has 0"),
        (
            "\"mesh\": 0",
            "\"mesh\": 0, \"scale\": [1e38, 1e38, 1e38], \"translation\": [3e38, 0, 3e38]",
            "not finite",
        ),
        (
            "\"version\": \"2.0\"}",
            "\"version\": \"2.0\"}, \"extensionsRequired\": [\"KHR_draco_mesh_compression\"]",
            "KHR_draco_mesh_compression",
        ),
        ("\"byteLength\": 360", "\"byteLength\": 364", "360 of its 364 bytes"),
        ("\"byteLength\": 360", "\"uri\": \"absent.bin\", \"byteLength\": 360", "absent.bin"),
        (
            "\"byteLength\": 360",
            "\"uri\": \"https://example.org/a.bin\", \"byteLength\": 360",
            "https://example.org/a.bin",
        ),
        ("\"byteLength\": 360", "\"uri\": \"data:,abc\", \"byteLength\": 360", "base64"),
        ("\"byteLength\": 360", "\"uri\": \"data:x;base64,@@@@\", \"byteLength\": 360", "in buffer 0"),
    ] {
        let changed = json.replacen(from, to, 1);
        assert_ne!(changed, json, "{from}");
        let (_keep, path) = file("given.glb", &glb_of(&changed, &buffer));
        let message = match read_mesh(&path) {
            Ok(mesh) => panic!("{to}: read as {} triangles", mesh.len()),
            Err(error) => error.to_string(),
        };
        assert!(message.contains(reason), "{to}: wanted `{reason}`, got: {message}");
    }
    // The length in the header must be at least 12, the size of the header.
    for length in [0_u32, 11, 12, u32::MAX] {
        let mut bytes = glb_of(&json, &buffer);
        bytes[8..12].copy_from_slice(&length.to_le_bytes());
        message("given.glb", &bytes);
    }
}

#[test]
fn a_binary_file_cut_at_any_byte_is_refused() {
    for (name, whole) in whole_files() {
        let (keep, path) = file(name, &whole);
        assert!(read_mesh(&path).is_ok(), "{name}: {:?}", read_mesh(&path));
        let (mut read, triangles) = (0, read_mesh(&path).unwrap().len());
        // Truncated in place, which is hundreds of times as fast as writing each length.
        let cut = fs::File::options().write(true).open(&path).unwrap();
        for length in (0..whole.len()).rev() {
            cut.set_len(length as u64).unwrap();
            match read_mesh(&path) {
                Ok(mesh) => {
                    read += 1;
                    assert!(mesh.check().is_ok() && !mesh.is_empty());
                    assert!(!name.contains(".vt") || mesh.len() == triangles, "{name} of {length} bytes");
                }
                Err(error) => assert!(error.to_string().contains(name), "{error}"),
            }
        }
        drop(keep);
        match name {
            // A shorter OBJ file is valid; other text files may lack their last digits or line feed.
            "whole.obj" => assert!(read > 0),
            // The normals at its end are not read.
            "whole.vtk" => assert!(read < 30 * 12 + 100, "{read}"),
            // After the arrays of the triangles.
            "whole.vtp" => assert_eq!(read, "\n</AppendedData>\n</VTKFile>\n".len()),
            // Every solid but the last may be missing.
            "text.stl" => assert!(read <= 6 * 9, "{read}"),
            "text.ply" | "whole.gltf" => assert!(read <= 2, "{name}: {read}"),
            // Without the padding after the buffer the length in the header is wrong.
            _ => assert_eq!(read, 0, "{name}"),
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn a_file_with_changed_bytes_does_not_cause_a_panic(
        which in 0_usize..9,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let (name, mut bytes) = whole_files().swap_remove(which);
        for (at, to) in changes {
            let at = at.index(bytes.len());
            bytes[at] = to;
        }
        let (_keep, path) = file(name, &bytes);
        // Both outcomes are valid, but a mesh must be consistent.
        if let Ok(mesh) = read_mesh(&path) {
            prop_assert!(mesh.check().is_ok() && !mesh.is_empty());
            prop_assert!(mesh.vertices.iter().flatten().all(|v| v.is_finite()));
        }
    }

    #[test]
    fn changed_numbers_in_a_gltf_file_do_not_cause_a_panic(
        at in any::<prop::sample::Index>(),
        to in prop_oneof![Just("-1"), Just("0"), Just("1"), Just("2"), Just("7"), Just("4294967295"), Just("18446744073709551615"), Just("1e300"), Just("null"), Just("[]"), Just("\"x\"")],
    ) {
        let cube = Cube::new(CUBE_AT_ORIGIN);
        let json = cube.json("");
        let numbers: Vec<(usize, usize)> = json
            .match_indices(|c: char| c.is_ascii_digit())
            .filter(|&(i, _)| !json[..i].ends_with(|c: char| c.is_ascii_digit()))
            .map(|(i, _)| (i, i + json[i..].find(|c: char| !c.is_ascii_digit()).unwrap()))
            .collect();
        let (start, end) = numbers[at.index(numbers.len())];
        let changed = format!("{}{to}{}", &json[..start], &json[end..]);
        let (_keep, path) = file("given.glb", &glb_of(&changed, &cube.buffer));
        if let Ok(mesh) = read_mesh(&path) {
            prop_assert!(mesh.check().is_ok() && !mesh.is_empty());
        }
    }
}

#[test]
fn a_buffer_outside_of_the_folder_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("scene");
    fs::create_dir_all(inside.join("parts")).unwrap();
    let cube = Cube::new(CUBE_AT_ORIGIN);
    for place in ["secret.bin", "scene/parts/own.bin", "scene/own file.bin"] {
        fs::write(folder.path().join(place), &cube.buffer).unwrap();
    }
    let read = |uri: &str| {
        let path = inside.join("a.gltf");
        fs::write(&path, cube.json(&format!("\"uri\": \"{uri}\","))).unwrap();
        read_mesh(&path).map(|mesh| mesh.len()).map_err(|error| error.to_string())
    };
    // Control: files in the folder and below it are read.
    for uri in ["parts/own.bin", "./own%20file.bin"] {
        assert_eq!(read(uri), Ok(12), "{uri}");
    }
    let absolute = folder.path().join("secret.bin").display().to_string().replace('\\', "/");
    let mut outside = vec![
        "../secret.bin".to_owned(),
        "parts/../../secret.bin".to_owned(),
        "%2e%2e/secret.bin".to_owned(),
        "%2E%2E%2Fsecret.bin".to_owned(),
        r"..\\secret.bin".to_owned(),
        "file:secret.bin".to_owned(),
        "a%00.bin".to_owned(),
        absolute.replace('/', "%2F"),
        absolute,
    ];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.path().join("secret.bin"), inside.join("link.bin")).unwrap();
        outside.push("link.bin".to_owned());
    }
    for uri in outside {
        let message = read(&uri).unwrap_err();
        assert!(message.contains("outside of the folder"), "{uri}: {message}");
    }
    assert!(read("absent.bin").unwrap_err().contains("cannot read"));
}

/// A small file that refers to the same bytes many times.
#[test]
fn data_that_grows_beyond_the_limit_is_refused() {
    // Five million nodes would be needed with the default limit, so the mesh is large and used often.
    let corners: Vec<u16> = (0..60_000).map(|n| n % 3).collect();
    let nodes: Vec<String> = (0..600).map(|_| "{\"mesh\": 0}".to_owned()).collect();
    let roots: Vec<String> = (0..600).map(|n| n.to_string()).collect();
    let cube =
        Cube::of(&format!("[{}]", nodes.join(",")), &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &corners);
    let bytes = glb(&cube.scene(&format!("[{}]", roots.join(","))));
    assert!(bytes.len() < 1 << 18, "{}", bytes.len());
    refused("many.glb", &bytes, "may take 256.0 MiB");
}

/// A text file of two triangles with the lines that follow its points.
fn legacy(kind: &str, cells: &str) -> Vec<u8> {
    format!(
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET {kind}\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n{cells}\n"
    )
    .into_bytes()
}

#[test]
fn malformed_vtk_files_are_refused_with_the_reason() {
    for (kind, cells, reason) in [
        ("STRUCTURED_GRID", "", "STRUCTURED_GRID"),
        ("POLYDATA", "", "no triangles"),
        ("POLYDATA", "POLYGONS 1 4\n3 0 1", "cut short"),
        ("POLYDATA", "POLYGONS 1 3\n3 0 1", "cut short"),
        ("POLYDATA", "POLYGONS 2 4\n3 0 1 2", "1 cells instead of 2"),
        ("POLYDATA", "POLYGONS 1 4\n3 0 1 4", "uses vertex 4"),
        ("POLYDATA", "POLYGONS 1 4\n3 0 1 -1", "-1 is not a vertex number"),
        ("POLYDATA", "POLYGONS 1 3\n2 0 1", "2 corners"),
        ("POLYDATA", "POLYGONS 99999999999 4\n3 0 1 2", "instead of 99999999999"),
        ("POLYDATA", "POLYGONS 1 99999999999\n3 0 1 2", "cut short"),
        ("POLYDATA", "POLYGONS 1 18446744073709551615\n3 0 1 2", "too large"),
        (
            "POLYDATA",
            "POLYGONS 2 3\nOFFSETS vtktypeint64\n0 5\nCONNECTIVITY vtktypeint64\n0 1 2",
            "ends at 5",
        ),
        ("POLYDATA", "POLYGONS 3 3\nOFFSETS int\n0 3 1\nCONNECTIVITY int\n0 1 2", "ends at 1"),
        ("POLYDATA", "POLYGONS 2 3\nOFFSETS float\n0 nan\nCONNECTIVITY int\n0 1 2", "NaN is not a count"),
        ("POLYDATA", "TRIANGLE_STRIPS 1 4\n3 0 1 2", "strips"),
        ("POLYDATA", "SPHERES 1", "SPHERES"),
        ("UNSTRUCTURED_GRID", "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10", "no triangles"),
        ("UNSTRUCTURED_GRID", "CELLS 1 4\n3 0 1 2", "no triangles"),
    ] {
        refused("given.vtk", &legacy(kind, cells), reason);
    }
    refused("points.vtk", &legacy("POLYDATA", "VERTICES 1 2\n1 0"), "no triangles");

    let xml = |piece: &str| {
        format!(
            "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"3\" {piece}</Piece></PolyData></VTKFile>"
        )
    };
    let array = |name: &str, text: &str| {
        format!("<DataArray type=\"Float64\" Name=\"{name}\" format=\"ascii\">{text}</DataArray>")
    };
    let points = format!("<Points>{}</Points>", array("Points", "0 0 0 1 0 0 0 1 0"));
    let polys = |corners: &str, ends: &str| {
        let arrays = array("connectivity", corners) + &array("offsets", ends);
        xml(&format!("NumberOfPolys=\"1\">{points}<Polys>{arrays}</Polys>"))
    };
    let (_keep, path) = file("good.vtp", polys("0 1 2", "3").as_bytes());
    assert_eq!(read_mesh(&path).unwrap().triangles, [[0, 1, 2]], "negative control");
    for (content, reason) in [
        (polys("0 1 3", "3"), "vertex number 3"),
        (polys("0 1 0.5", "3"), "0.5 is not a vertex number"),
        (polys("0 1", "2"), "2 corners"),
        (polys("0 1 2", "4"), "3 numbers for 4"),
        (polys("0 1 2", "-3"), "-3 is not a count"),
        (polys("0 1 2", "1e18"), "is not a count"),
        (polys("0 1 2", "nan"), "NaN is not a count"),
        (xml(&format!("NumberOfPolys=\"1\">{points}")), "no array `offsets`"),
        (xml("NumberOfPolys=\"1\">"), "no array of points"),
        (xml(&format!("NumberOfPolys=\"-1\">{points}")), "-1"),
        (xml(&format!("NumberOfPolys=\"99999999999\">{points}")), "99999999999"),
        (xml(&format!("NumberOfStrips=\"1\">{points}")), "strips"),
        (xml(&format!(">{points}")), "no triangles"),
        (xml(">").replace("PolyData", "UnstructuredGrid"), "VTKFile of type PolyData is read"),
    ] {
        refused("given.vtp", content.as_bytes(), reason);
    }
}
