//! Attributes of any name, and meshes that are read as particles.

mod common;

use std::fs;

use splashdown_io::{
    Attribute, Particles, read_particles, read_particles_with_attributes, write_mesh, write_particles,
};

fn attribute<'a>(particles: &'a Particles, name: &str) -> &'a Attribute {
    let names: Vec<_> = particles.attributes.iter().map(|attribute| &attribute.name).collect();
    let found = particles.attributes.iter().find(|attribute| attribute.name == name);
    found.unwrap_or_else(|| panic!("there is no `{name}` among {names:?}"))
}

#[test]
fn every_format_returns_all_attributes() {
    let folder = tempfile::tempdir().unwrap();
    let given = common::particles(1500);
    for (ending, [velocity, density, pressure]) in [
        ("ply", ["velocity", "density", "pressure"]),
        ("vtk", ["velocity", "density", "pressure"]),
        ("vtu", ["velocity", "density", "pressure"]),
        ("bgeo", ["v", "density", "pressure"]),
        ("npz", ["velocities", "densities", "pressures"]),
    ] {
        let path = folder.path().join(format!("all.{ending}"));
        write_particles(&path, &given).unwrap();
        let read = read_particles_with_attributes(&path).unwrap();
        assert_eq!(attribute(&read, velocity).values, given.velocities.as_flattened(), "{ending}");
        assert!(attribute(&read, velocity).is_velocity());
        assert_eq!(attribute(&read, density).values, given.densities, "{ending}");
        assert_eq!(attribute(&read, pressure).values, given.pressures, "{ending}");
        assert_eq!(read.attributes.iter().filter(|attribute| attribute.is_id()).count(), 1, "{ending}");
        // The other data equals that of a file read without attributes.
        let (bare, read) = (read_particles(&path).unwrap(), read.with_attributes(Vec::new()));
        assert!(bare == read && bare == given, "{ending}");
    }
}

#[test]
fn attributes_without_a_field_are_written_and_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let bare = common::particles(1500);
    let scalar = |name: &str| Attribute {
        name: name.to_owned(),
        components: 1,
        values: (0..1500).map(|i| i as f32 - 0.25).collect(),
    };
    let vector = Attribute {
        name: "angular velocity".to_owned(),
        components: 3,
        values: (0..4500).map(|i| 0.5 * i as f32).collect(),
    };
    let odd = "a<b>\"/&'";
    // `rho` is the density, which has a field: files store the field and not the attribute.
    let given = bare.clone().with_attributes(vec![scalar("temperature"), vector, scalar("rho"), scalar(odd)]);
    for ending in ["ply", "vtk", "vtu", "bgeo", "npz"] {
        let path = folder.path().join(format!("more.{ending}"));
        write_particles(&path, &given).unwrap();
        let read = read_particles_with_attributes(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(attribute(&read, "temperature").values, given.attributes[0].values, "{ending}");
        let vector = attribute(&read, "angular_velocity");
        assert_eq!((vector.components, &vector.values), (3, &given.attributes[1].values), "{ending}");
        assert!(read.attributes.iter().all(|attribute| attribute.name != "rho"), "{ending}");
        assert_eq!(
            read.attributes.len(),
            4 + 3,
            "{ending}: velocity, density, pressure, id and three others"
        );
        assert!(read_particles(&path).unwrap() == bare, "{ending}");
    }
}

#[test]
fn attributes_of_any_name_and_type_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        read_particles_with_attributes(&path).unwrap_or_else(|error| panic!("{error}"))
    };
    let head =
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 0 0\nPOINT_DATA 2\n";
    let read = write(
        "a.vtk",
        &format!(
            "{head}SCALARS Temperature double 1\nLOOKUP_TABLE default\n1.5 2.5\nTENSORS stress float\n{}\n\
             FIELD data 2\nforce 3 2 float\n1 2 3 4 5 6\nphase 1 2 int\n7 8\n",
            "0 ".repeat(18)
        ),
    );
    assert_eq!(attribute(&read, "Temperature").values, [1.5, 2.5]);
    assert_eq!(attribute(&read, "force").components, 3);
    assert_eq!(attribute(&read, "phase").values, [7.0, 8.0]);
    assert_eq!(read.attributes.len(), 3);

    let vertex = "property double x\nproperty double y\nproperty double z\nproperty uchar phase\n\
                  property float f_x\nproperty float f_y\nproperty float f_z\nproperty list uchar int near\nproperty float h\n";
    let read = write(
        "a.ply",
        &format!(
            "ply\nformat ascii 1.0\nelement vertex 2\n{vertex}end_header\n0 0 0 7 1 2 3 2 9 9 0.5\n1 0 0 8 4 5 6 0 0.25\n"
        ),
    );
    assert_eq!(attribute(&read, "phase").values, [7.0, 8.0]);
    assert_eq!(attribute(&read, "f").values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(attribute(&read, "h").values, [0.5, 0.25]);

    // An attribute that is missing in a piece is dropped.
    let piece = |more: &str| {
        format!(
            "<Piece NumberOfPoints=\"1\"><PointData>{more}</PointData><Points><DataArray type=\"Float32\" \
             NumberOfComponents=\"3\" format=\"ascii\">0 0 0</DataArray></Points></Piece>"
        )
    };
    let array =
        |name: &str| format!("<DataArray type=\"Int8\" Name=\"{name}\" format=\"ascii\">5</DataArray>");
    let (first, second) = (piece(&(array("a") + &array("b"))), piece(&array("a")));
    let read =
        write("a.vtp", &format!("<VTKFile type=\"PolyData\"><PolyData>{first}{second}</PolyData></VTKFile>"));
    assert_eq!(attribute(&read, "a").values, [5.0, 5.0]);
    assert_eq!(read.attributes.len(), 1);
}

#[test]
fn meshes_have_attributes_and_are_refused_as_particles() {
    let folder = tempfile::tempdir().unwrap();
    let mut torus = common::torus(0.4, 0.15, 24, 12);
    let heights: Vec<f32> = torus.vertices.iter().map(|vertex| vertex[1]).collect();
    let attribute = |name: &str, components, values| Attribute { name: name.to_owned(), components, values };
    torus.attributes.push(attribute("two words", 1, heights.clone()));
    torus.attributes.push(attribute("place", 3, torus.vertices.as_flattened().to_vec()));
    let path = |name: &str| folder.path().join(name);

    // In PLY the attributes are the last columns of a row.
    write_mesh(&path("mesh.ply"), &torus).unwrap();
    let bytes = fs::read(path("mesh.ply")).unwrap();
    let end = b"end_header\n";
    let start = bytes.windows(end.len()).position(|window| window == end).unwrap() + end.len();
    let header = String::from_utf8_lossy(&bytes[..start]);
    assert!(header.contains("float two_words\nproperty float place_x\n"), "{header}");
    let numbers: Vec<f32> = bytes[start..].chunks_exact(4).map(bytemuck::pod_read_unaligned).collect();
    let row = 6 + 1 + 3;
    for (vertex, height) in heights.iter().enumerate() {
        assert_eq!(numbers[vertex * row + 6], *height);
        assert_eq!(numbers[vertex * row + 7..vertex * row + 10], torus.vertices[vertex]);
    }
    // In VTK they follow their names, in big-endian order.
    write_mesh(&path("mesh.vtk"), &torus).unwrap();
    let bytes = fs::read(path("mesh.vtk")).unwrap();
    let after = |words: &str| {
        let at = bytes.windows(words.len()).position(|window| window == words.as_bytes());
        let rest = &bytes[at.unwrap_or_else(|| panic!("no {words}")) + words.len()..];
        rest.chunks_exact(4).map(|word| f32::from_be_bytes([word[0], word[1], word[2], word[3]]))
    };
    assert!(after("SCALARS two_words float 1\nLOOKUP_TABLE default\n").take(heights.len()).eq(heights));
    let places = torus.vertices.as_flattened();
    assert!(after("VECTORS place float\n").take(places.len()).eq(places.iter().copied()));

    for name in ["mesh.ply", "mesh.vtk"] {
        let message = read_particles(&path(name)).unwrap_err().to_string();
        assert!(message.contains("it is a mesh of 576 faces"), "{message}");
    }
    let text = "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"/></PolyData></VTKFile>";
    fs::write(path("mesh.vtp"), text).unwrap();
    assert!(read_particles(&path("mesh.vtp")).unwrap_err().to_string().contains("mesh of 1 face,"));

    // Attributes of the wrong length, or that are neither scalars nor vectors.
    for (components, values) in [(1, vec![0.0; 5]), (2, vec![0.0; 2 * torus.vertices.len()])] {
        let wrong = torus.clone().with_attributes(vec![attribute("odd", components, values)]);
        let message = write_mesh(&path("wrong.ply"), &wrong).unwrap_err().to_string();
        assert!(message.contains("`odd`"), "{message}");
    }
}
