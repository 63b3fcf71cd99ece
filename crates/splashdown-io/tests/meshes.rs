//! Reading meshes of every format: round trips, and comparisons with independent readers.

mod common;

use std::fs;
use std::path::Path;

use common::gltf_files::{CUBE_AT_ORIGIN, glb, gltf_beside, gltf_inside};
use splashdown_io::{Mesh, read_mesh, write_mesh};

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// The sorted triangles of a mesh as corner positions, independent of vertex numbers. Each triangle is rotated to begin
/// with its smallest corner, which preserves its orientation.
fn triangle_positions(mesh: &Mesh) -> Vec<[[u32; 3]; 3]> {
    let ordered = |v: [f32; 3]| v.map(|c| (c + 0.0).to_bits());
    let mut triangles: Vec<_> = mesh
        .triangles
        .iter()
        .map(|t| {
            let mut corners = t.map(|index| ordered(mesh.vertices[index as usize]));
            let first = (0..3).min_by_key(|&i| corners[i]).unwrap();
            corners.rotate_left(first);
            corners
        })
        .collect();
    triangles.sort_unstable();
    triangles
}

#[test]
fn meshes_round_trip_in_every_format() {
    let folder = folder();
    let torus = common::torus(1.0, 0.3, 24, 16);
    let mut turned = torus.clone();
    turned.triangles[5].swap(0, 1);
    assert_ne!(
        triangle_positions(&turned),
        triangle_positions(&torus),
        "the comparison must detect one flipped triangle"
    );
    for name in ["torus.obj", "torus.stl", "torus.ply", "TORUS.STL", "torus.vtk", "torus.vtp"] {
        let path = folder.path().join(name);
        let bytes = write_mesh(&path, &torus).unwrap();
        assert_eq!(bytes, fs::metadata(&path).unwrap().len());
        let read = read_mesh(&path).unwrap();
        assert_eq!(triangle_positions(&read), triangle_positions(&torus), "{name}");
        assert_eq!(read.vertices.len(), torus.vertices.len(), "{name}");
        assert!(read.normals.is_empty() && read.topology().unwrap().is_watertight(), "{name}");
        assert!((read.volume() - torus.volume()).abs() < 1e-9, "{name}");
    }
}

#[test]
fn velocities_of_a_ply_mesh_are_read_if_they_are_finite() {
    let folder = folder();
    let path = folder.path().join("moving.ply");
    let torus = common::torus(1.0, 0.3, 12, 8);
    let mut velocities: Vec<[f32; 3]> = (0..torus.vertices.len()).map(|i| [i as f32, 0.0, -1.0]).collect();
    write_mesh(&path, &torus.clone().with_velocities(velocities.clone())).unwrap();
    assert_eq!(read_mesh(&path).unwrap().velocities, velocities);
    velocities[3][1] = f32::NAN;
    write_mesh(&path, &torus.with_velocities(velocities)).unwrap();
    assert!(read_mesh(&path).unwrap().velocities.is_empty());
}

/// A file as read by `stl_io`.
fn by_stl_io(path: &Path) -> Mesh {
    let read = stl_io::read_stl(&mut fs::File::open(path).unwrap()).unwrap();
    Mesh::new(
        read.vertices.iter().map(|v| v.0).collect(),
        read.faces.iter().map(|f| f.vertices.map(|index| index as u32)).collect(),
    )
}

fn ascii_stl(mesh: &Mesh) -> String {
    let facets = mesh.triangles.iter().map(|t| {
        let corner = |i: usize| {
            let [x, y, z] = mesh.vertices[t[i] as usize];
            format!("vertex {x} {y} {z:e}\n")
        };
        format!(
            "facet normal 0 0 0\n outer loop\n{}{}{} endloop\nendfacet\n",
            corner(0),
            corner(1),
            corner(2)
        )
    });
    format!("solid some name\n{}endsolid some name\n", facets.collect::<String>())
}

#[test]
fn stl_agrees_with_the_independent_crate() {
    let folder = folder();
    let torus = common::torus(0.5, 0.2, 12, 10);
    let (text, binary) = (folder.path().join("text.stl"), folder.path().join("binary.stl"));
    fs::write(&text, ascii_stl(&torus)).unwrap();
    write_mesh(&binary, &torus).unwrap();
    for path in [text, binary] {
        assert_eq!(triangle_positions(&read_mesh(&path).unwrap()), triangle_positions(&by_stl_io(&path)));
        assert_eq!(triangle_positions(&read_mesh(&path).unwrap()), triangle_positions(&torus));
    }
}

#[test]
fn the_normals_of_a_written_stl_point_outwards() {
    let folder = folder();
    let path = folder.path().join("cube.stl");
    write_mesh(&path, &common::cube([-1.0; 3], 2.0)).unwrap();
    for triangle in
        stl_io::create_stl_reader(&mut fs::File::open(&path).unwrap()).unwrap().map(Result::unwrap)
    {
        let centre: [f32; 3] = std::array::from_fn(|i| triangle.vertices.iter().map(|v| v.0[i]).sum::<f32>());
        let dot: f32 = (0..3).map(|i| centre[i] * triangle.normal.0[i]).sum();
        assert!((dot - 3.0).abs() < 1e-6, "{triangle:?}");
    }
}

#[test]
fn stl_files_that_other_readers_reject_are_read() {
    let folder = folder();
    let path = folder.path().join("odd.stl");
    let cube = common::cube([0.0; 3], 1.0);
    // A binary file whose header begins like a text file.
    write_mesh(&path, &cube).unwrap();
    let mut bytes = fs::read(&path).unwrap();
    bytes[..12].copy_from_slice(b"solid part 1");
    fs::write(&path, bytes).unwrap();
    assert_eq!(triangle_positions(&read_mesh(&path).unwrap()), triangle_positions(&cube));
    // No name, capitals, Windows line ends, two solids, a negative zero.
    let one = ascii_stl(&cube).replace(" some name", "").replace("vertex 0", "vertex -0");
    let two = ascii_stl(&common::cube([2.0; 3], 1.0));
    fs::write(&path, format!("{}{two}", one.to_uppercase()).replace('\n', "\r\n")).unwrap();
    let read = read_mesh(&path).unwrap();
    assert_eq!(read.len(), 24);
    assert_eq!(read.topology().unwrap().components, 2);
    assert!(read.topology().unwrap().is_watertight());
}

#[test]
fn obj_agrees_with_the_independent_crate() {
    for name in ["spot.obj", "penguin.obj", "BoxOpenedHole.obj", "spot_ugly.obj", "plane_holes.obj"] {
        let Some(path) = common::shared_data(&format!("meshes/{name}")) else { continue };
        let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
        let (models, _) = tobj::load_obj(&path, &options).unwrap();
        let by_tobj = models.iter().fold(Mesh::default(), |all, model| {
            let one = Mesh::new(
                model.mesh.positions.chunks_exact(3).map(|v| [v[0], v[1], v[2]]).collect(),
                model.mesh.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
            );
            common::joined(all, &one)
        });
        let read = read_mesh(&path).unwrap();
        assert_eq!(read.len(), by_tobj.len(), "{name}");
        assert!((read.area() - by_tobj.area()).abs() <= 1e-6 * by_tobj.area(), "{name}");
        assert!((read.volume() - by_tobj.volume()).abs() <= 1e-6 * by_tobj.volume().abs(), "{name}");
    }
}

#[test]
fn the_shared_meshes_have_the_documented_topology() {
    for (name, closed) in
        [("spot", true), ("penguin", true), ("cube_no_bottom", false), ("plane_holes", false)]
    {
        let Some(path) = common::shared_data(&format!("meshes/{name}.obj")) else { continue };
        let topology = read_mesh(&path).unwrap().topology().unwrap();
        assert_eq!(topology.is_closed(), closed, "{name}: {topology}");
        if closed {
            assert_eq!(topology.euler_characteristic, 2, "{name}: {topology}");
        }
    }
}

#[test]
fn obj_groups_share_vertices_and_unusual_lines_are_read() {
    let folder = folder();
    let path = folder.path().join("tetra.obj");
    let text = "# a tetrahedron of two groups\r\nmtllib none.mtl\r\no T\u{e4}st\r\nv 0 0 0 1.0\r\nv 1. 0 0\r\n\
        v 0 1e0 0 0.2 0.3 0.4\nvn 0 0 1\ng one\nf 1/1/1 3/2/1 2//1\nv 0 0 \\\n +1\nvt 0 0\ng two\nusemtl x\n\
        f -4 -3 -1\ns off\nf 2 3 4\nl 1 2\nf 1 4 3";
    fs::write(&path, text).unwrap();
    let mesh = read_mesh(&path).unwrap();
    assert_eq!(mesh.vertices.len(), 4);
    assert_eq!(mesh.triangles, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);
    assert!(mesh.topology().unwrap().is_watertight());
    assert!((mesh.volume() - 1.0 / 6.0).abs() < 1e-12);
    // A polygon becomes a fan; a face may precede its vertices.
    fs::write(&path, "f 1 2 3 4 5\nv 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 2 0\nv 0 1 0\n").unwrap();
    assert_eq!(read_mesh(&path).unwrap().triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
}

#[test]
fn gltf_is_read_with_embedded_external_and_binary_buffers() {
    let folder = folder();
    let cube = common::cube([0.0; 3], 1.0);
    let files = common::gltf_files::Cube::new(CUBE_AT_ORIGIN);
    for name in ["cube.gltf", "beside.gltf", "cube.glb"] {
        let path = folder.path().join(name);
        match name {
            "cube.gltf" => fs::write(&path, gltf_inside(&files)).unwrap(),
            "beside.gltf" => fs::write(&path, gltf_beside(&files, folder.path(), "the cube.bin")).unwrap(),
            _ => fs::write(&path, glb(&files)).unwrap(),
        }
        let read = read_mesh(&path).unwrap();
        assert_eq!(triangle_positions(&read), triangle_positions(&cube), "{name}");
        assert_eq!(read.vertices.len(), 8, "{name}: the 24 vertices of the file have 8 positions");
        assert!(read.topology().unwrap().is_watertight(), "{name}");
    }
}

#[test]
fn gltf_nodes_translate_rotate_and_mirror() {
    let folder = folder();
    let path = folder.path().join("tree.glb");
    // A parent that translates with a child that scales; a node that mirrors; a node without a mesh.
    let nodes = r#"[
        {"translation": [10, 0, 0], "children": [1]},
        {"mesh": 0, "scale": [1, 2, 3], "rotation": [0, 0.70710678, 0, 0.70710678]},
        {"mesh": 0, "matrix": [-1,0,0,0, 0,1,0,0, 0,0,1,0, -5,0,0,1]},
        {"name": "camera"}, {"mesh": 0, "translation": [99, 99, 99]}
    ]"#;
    fs::write(&path, glb(&common::gltf_files::Cube::new(nodes).scene("[0, 2, 3]"))).unwrap();
    let mesh = read_mesh(&path).unwrap();
    let topology = mesh.topology().unwrap();
    assert_eq!(topology.components, 2, "the node that is in no scene is skipped");
    assert!(topology.is_watertight(), "{topology}");
    // 1 x 2 x 3 and 1: the volume of the mirrored cube is positive only if its triangles were flipped.
    assert!((mesh.volume() - 7.0).abs() < 1e-5, "{}", mesh.volume());
    let range = |axis: usize| {
        let values = mesh.vertices.iter().map(|v| v[axis]);
        (values.clone().fold(f32::MAX, f32::min), values.fold(f32::MIN, f32::max))
    };
    // A quarter turn about y maps z to x: the scaled cube spans 10..13 in x and -1..0 in z.
    let (near, far) = range(0);
    assert!((near + 6.0).abs() < 1e-5 && (far - 13.0).abs() < 1e-5, "{near} {far}");
    let (low, high) = range(2);
    assert!((low + 1.0).abs() < 1e-5 && (high - 1.0).abs() < 1e-5, "{low} {high}");
}

#[test]
fn gltf_strips_and_fans_become_triangles() {
    let folder = folder();
    let path = folder.path().join("strip.glb");
    for (mode, corners) in [(5, "0 1 2 3"), (6, "0 1 3 2")] {
        let corners: Vec<u16> = corners.split(' ').map(|c| c.parse().unwrap()).collect();
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        fs::write(&path, glb(&common::gltf_files::Cube::of(CUBE_AT_ORIGIN, &square, &corners).mode(mode)))
            .unwrap();
        let mesh = read_mesh(&path).unwrap();
        assert_eq!(mesh.len(), 2);
        // Both triangles have the same orientation, so the square has area 1 and no flipped edge.
        assert_eq!(mesh.topology().unwrap().flipped_edges, 0, "mode {mode}");
        assert!((mesh.area() - 1.0).abs() < 1e-6);
    }
}

#[test]
fn vtk_files_of_other_programs_are_read() {
    let folder = folder();
    let path = folder.path().join("given.vtk");
    let read = |version: &str, kind: &str, cells: &str| {
        let points = "POINTS 5 double\n0 0 0 1 0 0 1 1 0 0 1 0 0.5 0.5 1";
        let text = format!(
            "# vtk DataFile Version {version}\n\nASCII\nDATASET {kind}\nFIELD FieldData 1\nTimeValue 1 1 double\n0.5\n\
             {points}\nMETADATA\nINFORMATION 0\n\n{cells}\nCELL_DATA 2\nSCALARS a float 1\nLOOKUP_TABLE default\n1 2\n"
        );
        fs::write(&path, text).unwrap();
        read_mesh(&path).unwrap_or_else(|error| panic!("{error}")).triangles
    };
    let both = [[0, 1, 2], [0, 2, 3], [0, 1, 4]];
    assert_eq!(read("3.0", "POLYDATA", "VERTICES 1 2\n1 4\nPOLYGONS 2 9\n4 0 1 2 3\n3 0 1 4"), both);
    let new = "POLYGONS 3 7\nOFFSETS vtktypeint64\n0 4 7\nCONNECTIVITY vtktypeint64\n0 1 2 3 0 1 4";
    assert_eq!(read("5.1", "POLYDATA", new), both);
    // Cells that are not polygons are skipped.
    let grid = "CELLS 3 11\n4 0 1 2 3\n1 4\n3 0 1 4\nCELL_TYPES 3\n9\n1\n5";
    assert_eq!(read("3.0", "UNSTRUCTURED_GRID", grid), both);
    let changed = grid.replace("\n9\n", "\n10\n");
    assert_eq!(read("3.0", "UNSTRUCTURED_GRID", &changed), both[2..], "negative control: a tetrahedron");

    // The pieces of a file have vertex numbers of their own.
    let piece = "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points><DataArray type=\"Float32\" \
                 NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points><Polys><DataArray \
                 type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray><DataArray type=\"Int64\" \
                 Name=\"offsets\" format=\"ascii\">3</DataArray></Polys></Piece>";
    let path = folder.path().join("given.vtp");
    let text = format!("<VTKFile type=\"PolyData\"><PolyData>{piece}{piece}</PolyData></VTKFile>");
    fs::write(&path, text).unwrap();
    assert_eq!(read_mesh(&path).unwrap().triangles, [[0, 1, 2], [3, 4, 5]]);
}
