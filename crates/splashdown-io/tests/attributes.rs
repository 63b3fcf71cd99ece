//! Attributes of any name, and meshes that are read as particles.

mod common;

use std::fs;

use splashdown_io::{
    Attribute, Format, ParticleInfo, Particles, read_particles, read_particles_with_attributes, write_mesh,
    write_particles,
};

fn attribute<'a>(particles: &'a Particles, name: &str) -> &'a Attribute {
    let names: Vec<_> = particles.attributes.iter().map(|attribute| &attribute.name).collect();
    let found = particles.attributes.iter().find(|attribute| attribute.name == name);
    found.unwrap_or_else(|| panic!("there is no `{name}` among {names:?}"))
}

/// All formats of particles that are written.
const ENDINGS: [&str; 6] = ["ply", "vtk", "vtu", "vtp", "bgeo", "npz"];

#[test]
fn every_format_returns_all_attributes() {
    let folder = tempfile::tempdir().unwrap();
    let given = common::particles(1500);
    for (ending, [velocity, density, pressure]) in [
        ("ply", ["velocity", "density", "pressure"]),
        ("vtk", ["velocity", "density", "pressure"]),
        ("vtu", ["velocity", "density", "pressure"]),
        ("vtp", ["velocity", "density", "pressure"]),
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
    for ending in ENDINGS {
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

/// A series of foam begins with frames without particles.
#[test]
fn files_without_particles_have_the_attributes_of_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let attribute = |name: &str| Attribute { name: name.to_owned(), components: 1, values: Vec::new() };
    let with = Particles::default().with_attributes(vec![attribute("lifetime")]);
    for ending in ENDINGS {
        let contains_name = |particles: &Particles| {
            let path = folder.path().join(format!("empty.{ending}"));
            write_particles(&path, particles).unwrap();
            fs::read(path).unwrap().windows(8).any(|bytes| bytes == b"lifetime")
        };
        assert!(contains_name(&with), "{ending}");
        assert!(!contains_name(&Particles::default()), "{ending}");
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

    write_mesh(&path("mesh.vtp"), &torus).unwrap();
    for name in ["mesh.ply", "mesh.vtk", "mesh.vtp"] {
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

#[test]
fn every_format_contains_time_and_particle_spacing() {
    let folder = tempfile::tempdir().unwrap();
    let written = Format::endings(|format| format.writes_particles() && !format.is_series());
    assert_eq!(written, ENDINGS.map(|ending| format!(".{ending}")));
    for ending in ENDINGS {
        let path = folder.path().join(format!("frame.{ending}"));
        let read = |info: ParticleInfo, all: bool| {
            write_particles(&path, &common::particles(12).with_info(info)).unwrap();
            let read = if all { read_particles_with_attributes } else { read_particles };
            let particles = read(&path).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(particles.positions, common::particles(12).positions);
            assert_eq!(particles.attributes.len(), if all { 4 } else { 0 }, "{ending}");
            particles.info
        };
        // A tenth has no exact binary representation; BGEO has only single precision.
        let (time, spacing) = (12.1, 0.02);
        for all in [false, true] {
            let found = read(ParticleInfo::new(time, spacing), all);
            assert_eq!(found.particle_spacing, Some(spacing), "{ending}");
            let expected = if ending == "bgeo" { f64::from(time as f32) } else { time };
            assert_eq!(found.time, Some(expected), "{ending}");
        }
        // Negative controls: another value, one of the two, and neither.
        assert_ne!(read(ParticleInfo::new(time, 0.021), false).particle_spacing, Some(spacing), "{ending}");
        let mut only = ParticleInfo::default();
        only.particle_spacing = Some(spacing);
        assert_eq!(read(only, false), only, "{ending}");
        assert_eq!(read(ParticleInfo::default(), false), ParticleInfo::default(), "{ending}");
        // Values that are not credible are not written.
        for bad in [f32::NAN, f32::INFINITY, -1.0, 0.0, 1e30, f32::MIN_POSITIVE] {
            assert_eq!(
                read(ParticleInfo::new(f64::NAN, bad), false),
                ParticleInfo::default(),
                "{ending}: {bad}"
            );
        }
    }
}

/// The bytes with all occurrences of a run replaced by another run of the same length.
fn replaced(bytes: &[u8], from: &[u8], to: &[u8]) -> Vec<u8> {
    assert_eq!(from.len(), to.len());
    let (mut bytes, mut count) = (bytes.to_vec(), 0);
    for at in 0..=bytes.len() - from.len() {
        if bytes[at..].starts_with(from) {
            bytes[at..at + to.len()].copy_from_slice(to);
            count += 1;
        }
    }
    assert!(count > 0, "{from:?} is not in the file");
    bytes
}

#[test]
fn hostile_time_and_particle_spacing_are_ignored() {
    let folder = tempfile::tempdir().unwrap();
    let info = ParticleInfo::new(12.1, 0.0234);
    for ending in ENDINGS {
        let path = folder.path().join(format!("frame.{ending}"));
        write_particles(&path, &common::particles(12).with_info(info)).unwrap();
        let good = fs::read(&path).unwrap();
        let spacing = info.particle_spacing.unwrap();
        for bad in [f64::NAN, f64::INFINITY, -0.0234, 0.0, 1e300, 1e-300] {
            let (wide, narrow) = (0.0234_f64, bad as f32);
            let changed = match ending {
                "ply" => {
                    let text = format!("{:6}", format!("{bad:.0e}"));
                    replaced(&good, b"0.0234", &text.as_bytes()[..6])
                }
                "vtk" => replaced(&good, &wide.to_be_bytes(), &bad.to_be_bytes()),
                "vtu" | "vtp" => replaced(&good, &wide.to_le_bytes(), &bad.to_le_bytes()),
                "bgeo" => replaced(&good, &spacing.to_be_bytes(), &narrow.to_be_bytes()),
                _ => replaced_in_archive(&good, &spacing.to_le_bytes(), &narrow.to_le_bytes()),
            };
            fs::write(&path, changed).unwrap();
            let read = read_particles(&path).unwrap_or_else(|error| panic!("{ending}, {bad}: {error}"));
            assert_eq!(read.info.particle_spacing, None, "{ending}: {bad}");
            assert!(read.info.time.is_some() && read.len() == 12, "{ending}: {bad}");
        }
    }
}

/// Replaces bytes in the arrays of an archive, with valid checksums.
fn replaced_in_archive(bytes: &[u8], from: &[u8], to: &[u8]) -> Vec<u8> {
    use std::io::{Cursor, Read as _, Write as _};
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).unwrap();
        let name = entry.name().unwrap().into_owned();
        let mut content = Vec::new();
        entry.read_to_end(&mut content).unwrap();
        if name == "particle_spacing.npy" {
            content = replaced(&content, from, to);
        }
        writer.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
        writer.write_all(&content).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

#[test]
fn metadata_of_other_kinds_is_ignored() {
    let folder = tempfile::tempdir().unwrap();
    let read = |name: &str, content: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, content).unwrap();
        read_particles(&path).unwrap_or_else(|error| panic!("{error}")).info
    };
    let ply = |comments: &str| {
        format!(
            "ply\nformat ascii 1.0\n{comments}element vertex 1\nproperty float x\nproperty float y\nproperty float z\n\
             end_header\n0 0 0\n"
        )
    };
    let info = read("a.ply", ply("comment time 0.5\nobj_info particle_spacing 2e-2\n").as_bytes());
    assert_eq!(info, ParticleInfo::new(0.5, 0.02));
    let words =
        "comment time of day\ncomment time noon\ncomment particle_spacing\ncomment particle_spacing 1 m\n";
    assert_eq!(read("a.ply", ply(words).as_bytes()), ParticleInfo::default());

    // Field data with several numbers, and point data of the same name.
    let vtk = |field: &str| {
        format!(
            "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nFIELD FieldData 1\n{field}\nPOINTS 1 float\n\
             0 0 0\nPOINT_DATA 1\nSCALARS TimeValue float 1\nLOOKUP_TABLE default\n7\n"
        )
    };
    assert_eq!(read("a.vtk", vtk("TimeValue 1 1 double\n0.5").as_bytes()).time, Some(0.5));
    for other in ["TimeValue 1 2 double\n0.5 0.6", "TimeValue 2 1 double\n0.5 0.6", "Time 1 1 double\n0.5"] {
        assert_eq!(read("a.vtk", vtk(other).as_bytes()), ParticleInfo::default(), "{other}");
    }
    let vtp = |field: &str| {
        format!(
            "<VTKFile type=\"PolyData\"><PolyData><FieldData>{field}</FieldData><Piece NumberOfPoints=\"1\"><Points>\
             <DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0</DataArray></Points></Piece>\
             </PolyData></VTKFile>"
        )
    };
    let array = |text: &str, more: &str| {
        format!("<DataArray type=\"Float64\" Name=\"TimeValue\" {more}>{text}</DataArray>")
    };
    assert_eq!(read("a.vtp", vtp(&array("0.5", "format=\"ascii\"")).as_bytes()).time, Some(0.5));
    for (text, more) in [
        ("0.5 0.6", "format=\"ascii\""),
        ("noon", "format=\"ascii\""),
        ("", "format=\"appended\" offset=\"99999999999\""),
        ("AAAA", "format=\"binary\""),
    ] {
        assert_eq!(
            read("a.vtp", vtp(&array(text, more)).as_bytes()),
            ParticleInfo::default(),
            "{text} {more}"
        );
    }
    // A BGEO file that ends after its points.
    let path = folder.path().join("a.bgeo");
    write_particles(&path, &common::particles(3).with_info(ParticleInfo::new(0.5, 0.02))).unwrap();
    let bytes = fs::read(&path).unwrap();
    let cut = bytes.len() - 12;
    assert_eq!(read("a.bgeo", &bytes), ParticleInfo::new(0.5, 0.02));
    assert_eq!(read("a.bgeo", &bytes[..cut]), ParticleInfo::default());
    // An attribute of every particle has the name of a scalar: the archive contains only the attribute.
    let times = Attribute { name: "time".to_owned(), components: 1, values: vec![1.0, 2.0, 3.0] };
    let given = common::particles(3).with_attributes(vec![times]).with_info(ParticleInfo::new(0.5, 0.02));
    let path = folder.path().join("a.npz");
    write_particles(&path, &given).unwrap();
    let read = read_particles_with_attributes(&path).unwrap();
    assert_eq!(attribute(&read, "time").values, [1.0, 2.0, 3.0]);
    assert_eq!((read.info.time, read.info.particle_spacing), (None, Some(0.02)));
}
