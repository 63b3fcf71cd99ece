//! Reading particles of every format, including files of other programs and malformed files.

mod common;

use std::fs;
use std::io::{Cursor, Write as _};
use std::path::PathBuf;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use proptest::prelude::*;
use splashdown_io::{Format, IoError, Particles, read_particles, write_particles};
use tempfile::TempDir;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

fn file(name: &str, contents: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, contents).unwrap();
    (folder, path)
}

fn read(name: &str, contents: &[u8]) -> Result<Particles, String> {
    let (_keep, path) = file(name, contents);
    read_particles(&path).map_err(|error| error.to_string())
}

#[track_caller]
fn refused(name: &str, contents: &[u8], reason: &str) {
    let message = read(name, contents).unwrap_err();
    assert!(message.contains(reason), "wanted `{reason}`, got: {message}");
    assert!(message.contains(name) && !message.contains('\n'), "{message}");
}

/// Particles with all attributes, whose values are exact in text.
fn plain(count: usize) -> Particles {
    let value = |n: usize| n as f32 * 0.25 - 3.0;
    Particles::from_positions((0..count).map(|n| [value(n), value(2 * n), -0.5]).collect())
        .with_ids((0..count as u32).map(|n| n + 4_000_000_000).collect())
        .with_velocities((0..count).map(|n| [value(3 * n), 0.0, value(n + 1)]).collect())
        .with_densities((0..count).map(|n| 1000.0 + value(n)).collect())
        .with_pressures((0..count).map(|n| value(n) * 100.0).collect())
}

fn list<T: std::fmt::Display>(values: impl IntoIterator<Item = T>) -> String {
    values.into_iter().map(|value| format!("{value} ")).collect()
}

fn big(values: impl IntoIterator<Item = f32>) -> Vec<u8> {
    values.into_iter().flat_map(f32::to_be_bytes).collect()
}

/// A BGEO file as written by SPlisHSPlasH, with an attribute of strings.
fn bgeo(given: &Particles) -> Vec<u8> {
    let mut bytes = b"BgeoV".to_vec();
    let count = given.len() as i32;
    for word in [5, count, 0, 0, 0, 4, 0, 0, 0] {
        bytes.extend(i32::to_be_bytes(word));
    }
    for (name, size, kind) in [("name", 1_u16, 4_i32), ("velocity", 3, 5), ("id", 1, 1), ("density", 1, 0)] {
        bytes.extend((name.len() as u16).to_be_bytes());
        bytes.extend(name.bytes());
        bytes.extend(size.to_be_bytes());
        bytes.extend(kind.to_be_bytes());
        if kind == 4 {
            bytes.extend(2_i32.to_be_bytes());
            ["water", "oil"].iter().for_each(|word| {
                bytes.extend((word.len() as u16).to_be_bytes());
                bytes.extend(word.bytes());
            });
        } else {
            bytes.extend(vec![0; 4 * usize::from(size)]);
        }
    }
    for n in 0..given.len() {
        bytes.extend(big(given.positions[n]));
        bytes.extend(big([1.0]));
        bytes.extend(1_i32.to_be_bytes());
        bytes.extend(big(given.velocities[n]));
        bytes.extend((given.ids[n] as i32).to_be_bytes());
        bytes.extend(big([given.densities[n]]));
    }
    bytes.extend([0, 0xff]);
    bytes
}

/// Like [`plain`], within the limits of `bgeo`: ids are positive i32, without pressures.
fn for_bgeo(count: usize) -> Particles {
    plain(count).with_ids((0..count as u32).rev().collect()).with_pressures(Vec::new())
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn bgeo_is_read_with_and_without_compression() {
    // More than one block of rows.
    let given = for_bgeo(2500);
    let bytes = bgeo(&given);
    for (name, bytes) in [("a.bgeo", bytes.clone()), ("b.bgeo", gzip(&bytes)), ("c.BGEO.gz", gzip(&bytes))] {
        assert_eq!(read(name, &bytes).unwrap(), given, "{name}");
    }
    let mut changed = bytes;
    let at = changed.len() - 10;
    changed[at] ^= 1;
    assert_ne!(read("a.bgeo", &changed).unwrap(), given);
}

/// Two points as written by `splashsurf_lib` 0.14.1, uncompressed and compressed. (The crate has fifty dependencies.)
const BY_SPLASHSURF: [&[u8]; 2] = [
    b"BgeoV\0\0\0\x05\0\0\0\x02\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\
      \x3f\x80\0\0\xc0\x20\0\0\x3d\xcc\xcc\xcd\x3f\x80\0\0\x46\xea\x60\0\x40\xa0\0\0\xba\x83\x12\x6f\x3f\x80\0\0\0\xff",
    &[
        31, 139, 8, 0, 0, 0, 0, 0, 4, 255, 117, 135, 185, 9, 192, 32, 0, 0, 143, 64, 22, 200, 4, 89, 36, 68, 44, 28, 193,
        218, 70, 44, 93, 65, 112, 17, 231, 176, 114, 0, 93, 196, 37, 124, 6, 16, 238, 224, 78, 58, 235, 53, 112, 47, 175,
        229, 145, 63, 64, 121, 225, 171, 181, 237, 86, 221, 32, 18, 228, 248, 248, 253, 140, 9, 210, 187, 139, 82, 75, 0,
        0, 0,
    ],
];

#[test]
fn bgeo_of_splashsurf_is_read() {
    for bytes in BY_SPLASHSURF {
        let positions = vec![[1.0, -2.5, 0.1], [3.0e4, 5.0, -1.0e-3]];
        assert_eq!(read("theirs.bgeo", bytes).unwrap(), Particles::from_positions(positions));
    }
}

fn vtk_text(given: &Particles) -> String {
    let n = given.len();
    let cells = (0..n).map(|i| format!("1 {i}\n")).collect::<String>();
    format!(
        "# vtk DataFile Version 3.0\nwater\nASCII\nDATASET POLYDATA\nPOINTS {n} double\n{}\nVERTICES {n} {}\n{cells}\
         CELL_DATA {n}\nSCALARS density float\nLOOKUP_TABLE default\n{}\nPOINT_DATA {n}\nSCALARS id unsigned_int 1\n\
         LOOKUP_TABLE default\n{}\nVECTORS velocity float\n{}\nFIELD FieldData 3\npressure 1 {n} float\n{}\n\
         other 2 {n} float\n{}\nDensity 1 {n} double\n{}\nMETADATA\nINFORMATION 0\n\n",
        list(given.positions.iter().flatten()),
        2 * n,
        list((0..n).map(|_| -1)),
        list(&given.ids),
        list(given.velocities.iter().flatten()),
        list(&given.pressures),
        list(0..2 * n),
        list(&given.densities),
    )
}

/// As written by SPlisHSPlasH, or with the cells of VTK 9.
fn vtk_binary(given: &Particles, new_cells: bool) -> Vec<u8> {
    let n = given.len() as i32;
    let mut bytes =
        format!("# vtk DataFile Version 4.1\n\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS {n} float\n")
            .into_bytes();
    bytes.extend(big(given.positions.iter().flatten().copied()));
    if new_cells {
        bytes.extend(format!("\nMETADATA\nINFORMATION 1\nNAME X LOCATION Y\nDATA 2 0 1\n\nCELLS {} {n}\nOFFSETS vtktypeint64\n", n + 1).bytes());
        bytes.extend((0..=i64::from(n)).flat_map(i64::to_be_bytes));
        bytes.extend(b"\nCONNECTIVITY vtktypeint64\n");
        bytes.extend((0..i64::from(n)).flat_map(i64::to_be_bytes));
    } else {
        bytes.extend(format!("\nCELLS {n} {}\n", 2 * n).bytes());
        bytes.extend((0..n).flat_map(|i| [1, i]).flat_map(i32::to_be_bytes));
    }
    bytes.extend(format!("\nCELL_TYPES {n}\n").bytes());
    bytes.extend((0..n).flat_map(|_| 1_i32.to_be_bytes()));
    bytes.extend(format!("\nPOINT_DATA {n}\nSCALARS id unsigned_int 1\nLOOKUP_TABLE id_table\n").bytes());
    bytes.extend(given.ids.iter().flat_map(|id| id.to_be_bytes()));
    bytes.extend(format!("\nFIELD FieldData 3\nvelocity 3 {n} float\n").bytes());
    bytes.extend(big(given.velocities.iter().flatten().copied()));
    bytes.extend(format!("\npressure 1 {n} float\n").bytes());
    bytes.extend(big(given.pressures.iter().copied()));
    bytes.extend(format!("\ndensity 1 {n} double\n").bytes());
    bytes.extend(given.densities.iter().flat_map(|&value| f64::from(value).to_be_bytes()));
    bytes.extend(b"\n");
    bytes
}

#[test]
fn legacy_vtk_is_read_as_text_and_binary() {
    let given = plain(300);
    assert_eq!(read("text.vtk", vtk_text(&given).as_bytes()).unwrap(), given);
    assert_eq!(read("windows.vtk", vtk_text(&given).replace('\n', "\r\n").as_bytes()).unwrap(), given);
    for new_cells in [false, true] {
        let mut bytes = vtk_binary(&given, new_cells);
        assert_eq!(read("binary.vtk", &bytes).unwrap(), given, "{new_cells}");
        let at = bytes.len() - 1000;
        bytes[at] ^= 1;
        assert_ne!(read("binary.vtk", &bytes).unwrap(), given);
    }
}

/// Encodes the bytes of an array of a VTU file as text.
type Encode = fn(&[u8]) -> String;

fn with_length<const N: usize>(bytes: &[u8]) -> String {
    STANDARD.encode([&(bytes.len() as u64).to_le_bytes()[..N], bytes].concat())
}

/// An array compressed as by VTK, in blocks of 100 bytes.
fn packed(bytes: &[u8]) -> String {
    let blocks: Vec<Vec<u8>> = bytes
        .chunks(100)
        .map(|block| {
            let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
            encoder.write_all(block).unwrap();
            encoder.finish().unwrap()
        })
        .collect();
    let words = [blocks.len(), 100, bytes.len() % 100].into_iter().chain(blocks.iter().map(Vec::len));
    let header: Vec<u8> = words.flat_map(|word| (word as u32).to_le_bytes()).collect();
    STANDARD.encode(header) + &STANDARD.encode(blocks.concat())
}

fn vtu(given: &Particles, root: &str, encode: Encode, appended: bool) -> String {
    let mut data = String::new();
    let mut array = |kind: &str, name: &str, components: u32, bytes: &[u8]| {
        let text = encode(bytes);
        let open = format!("<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\"");
        if appended {
            let offset = data.len();
            data += &text;
            format!("{open} format=\"appended\" offset=\"{offset}\"/>\n")
        } else {
            format!("{open} format=\"binary\">\n  {text}\n</DataArray>\n")
        }
    };
    let n = given.len();
    let doubles: Vec<u8> = given.densities.iter().flat_map(|&v| f64::from(v).to_le_bytes()).collect();
    let point_data = array("Float32", "velocity", 3, bytemuck::cast_slice(&given.velocities))
        + &array("Float64", "density", 1, &doubles)
        + &array("Float32", "pressure", 1, bytemuck::cast_slice(&given.pressures))
        + &array("UInt32", "id", 1, bytemuck::cast_slice(&given.ids));
    let points = array("Float32", "Points", 3, bytemuck::cast_slice(&given.positions));
    let tail = if appended {
        format!("<AppendedData encoding=\"base64\">\n _{data}\n</AppendedData>")
    } else {
        String::new()
    };
    format!(
        "<?xml version=\"1.0\"?>\n<!-- made elsewhere -->\n<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" {root}>\
         <UnstructuredGrid><FieldData><DataArray type=\"Int8\" Name=\"velocity\" NumberOfTuples=\"1\" format=\"ascii\">7</DataArray></FieldData>\
         <Piece NumberOfPoints=\"{n}\" NumberOfCells=\"0\"><PointData>{point_data}</PointData><Points>{points}</Points></Piece>\
         </UnstructuredGrid>{tail}</VTKFile>"
    )
}

const ZLIB: &str = "compressor=\"vtkZLibDataCompressor\"";

#[test]
fn vtu_is_read_in_every_encoding() {
    let given = plain(77);
    for (root, encode) in
        [("", with_length::<4> as Encode), ("header_type=\"UInt64\"", with_length::<8>), (ZLIB, packed)]
    {
        for appended in [false, true] {
            let text = vtu(&given, root, encode, appended);
            assert_eq!(read("given.vtu", text.as_bytes()).unwrap(), given, "{root} {appended}");
        }
    }
    // Two pieces as text, with numbers on several lines.
    let piece = "<Piece NumberOfPoints=\"2\"><PointData><DataArray type=\"Float64\" Name=\"v\" NumberOfComponents=\"3\" format=\"ascii\">\
        1 2 3\n4 5 6</DataArray></PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0\n\n1e0 0 0\
        </DataArray></Points></Piece>";
    let text = format!("<VTKFile type=\"PolyData\"><PolyData>{piece}{piece}</PolyData></VTKFile>");
    let particles = read("given.vtp", text.as_bytes()).unwrap();
    assert_eq!(particles.positions, [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0]]);
    assert_eq!(particles.velocities[3], [4.0, 5.0, 6.0]);
}

#[test]
fn particles_round_trip_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    for (name, given) in [
        ("all.vtu", common::particles(5000)),
        ("all.ply", common::particles(5000)),
        ("bare.vtu", Particles::from_positions(vec![[1.0, 2.0, 3.0]; 9])),
    ] {
        let path = folder.path().join(name);
        write_particles(&path, &given).unwrap();
        assert_eq!(read_particles(&path).unwrap(), given, "{name}");
    }
}

#[test]
fn the_shared_particles_are_read() {
    let Some(path) = common::shared_data("particles/mid64k.npy") else { return };
    let particles = read_particles(&path).unwrap();
    assert_eq!(particles.len(), 64_000);
    assert!(particles.velocities.is_empty());
}

#[test]
fn files_of_other_formats_are_refused() {
    let message = read_particles("points.abc".as_ref()).unwrap_err().to_string();
    let endings = Format::endings(Format::reads_particles);
    assert!(endings.len() == 8 && endings.iter().all(|ending| message.contains(ending)), "{message}");
    assert!(matches!(read_particles("points.xyz.gz".as_ref()), Err(IoError::UnknownFormat { .. })));
    assert!(matches!(read_particles("absent.bgeo".as_ref()), Err(IoError::Read { .. })));
    for ending in endings {
        let name = format!("given{ending}");
        for garbage in
            [&b""[..], b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", &[0xff; 300], b"just\nsome words\n", &[b'<'; 5000]]
        {
            let message = read(&name, garbage).unwrap_err();
            assert!(message.contains(&name) && !message.contains('\n'), "{message}");
        }
    }
}

#[test]
fn malformed_particle_files_are_refused_with_the_reason() {
    let given = plain(20);
    let text = vtk_text(&given);
    for (from, to, reason) in [
        ("POLYDATA", "STRUCTURED_POINTS", "`STRUCTURED_POINTS`; POLYDATA"),
        (
            "POINTS 20",
            "POINTS 9999999999",
            "an array of 29999999997 numbers needs at least 59999999994 bytes",
        ),
        ("POINTS 20", "POINTS 99999999999999999999", "is not a count"),
        ("POINTS 20", "POINTS 0", "is not a known keyword"),
        ("POINTS 20 double", "POINTS 20 complex", "`complex` is not a known number type"),
        ("ASCII", "TEXT", "neither `ASCII` nor `BINARY`"),
        ("-0.5", "nan", "1 of its 20 positions are not finite, the first is number 0"),
        ("-0.5", "wet", "`wet` is not a number (near byte"),
        ("4000000019", "-1", "the id -1 is not an integer"),
        ("4000000019", "1.5", "the id 1.5 is not an integer"),
        ("POINT_DATA 20", "POINT_DATA 19", "near byte"),
    ] {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text, "{from}");
        refused("given.vtk", changed.as_bytes(), reason);
    }
    let xml = vtu(&given, ZLIB, packed, false);
    for (from, to, reason) in [
        ("vtkZLib", "vtkLZ4", "compressed by `vtkLZ4DataCompressor`"),
        ("NumberOfPoints=\"20\"", "NumberOfPoints=\"21\"", "array `Points`"),
        ("NumberOfPoints=\"20\"", "NumberOfPoints=\"9999999999\"", "at most"),
        ("NumberOfPoints=\"20\"", "NumberOfPoints=\"0\"", "array `velocity`"),
        ("\"UnstructuredGrid\"", "\"ImageData\"", "of type UnstructuredGrid or PolyData"),
        ("LittleEndian", "MiddleEndian", "`MiddleEndian`"),
        ("LittleEndian", "BigEndian", "its points need"),
        ("format=\"binary\"", "format=\"appended\" offset=\"0\"", "no appended data"),
        ("type=\"Float32\"", "type=\"Float16\"", "`Float16`"),
        ("</Points>", "", "expected"),
        (ZLIB, "", "array `Points`"),
    ] {
        let changed = xml.replacen(from, to, 1);
        assert_ne!(changed, xml, "{from}");
        refused("given.vtu", changed.as_bytes(), reason);
    }
    let bytes = bgeo(&for_bgeo(20));
    let with = |at: usize, word: i32| {
        let mut bytes = bytes.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_be_bytes());
        bytes
    };
    refused("given.bgeo", &with(5, 6), "its version is 6");
    refused("given.bgeo", &with(9, -1), "a count of -1");
    refused("given.bgeo", &with(9, 21), "declares 21 points");
    refused("given.bgeo", &with(9, 0), "no particles");
    refused("given.bgeo", &with(25, i32::MAX), "list of attributes");
    refused("given.bgeo", &with(0, 0), "does not begin with `Bgeo`");
    let (_keep, path) = file("huge.bgeo", &with(9, i32::MAX));
    assert!(matches!(read_particles(&path), Err(IoError::TooMany { what: "particles", .. })));
    refused("given.bgeo", &gzip(&bytes)[..200], "declares 20 points");
}

/// As written by `numpy.savez_compressed`.
fn packed_npz(given: &Particles) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    let n = given.len();
    let positions: Vec<u8> =
        given.positions.iter().flatten().flat_map(|&v| f64::from(v).to_le_bytes()).collect();
    let ids: Vec<u8> = given.ids.iter().flat_map(|&id| i64::from(id).to_le_bytes()).collect();
    let (unrelated, m) = (vec![0; 2 * 5], given.ids.len());
    for (name, kind, shape, data) in [
        ("pos", "<f8", format!("({n}, 3)"), positions),
        ("ID", "<i8", format!("({m},)"), ids),
        ("colour", "|u1", "(2, 5)".to_owned(), unrelated),
    ] {
        let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}\n");
        archive.start_file(format!("{name}.npy"), options).unwrap();
        archive.write_all(b"\x93NUMPY\x01\x00").unwrap();
        archive.write_all(&(header.len() as u16).to_le_bytes()).unwrap();
        archive.write_all(header.as_bytes()).unwrap();
        archive.write_all(&data).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

#[test]
fn archives_of_numpy_are_read() {
    let given = plain(2500);
    let bytes = packed_npz(&given);
    let wanted = Particles::from_positions(given.positions.clone()).with_ids(given.ids.clone());
    assert_eq!(read("packed.npz", &bytes).unwrap(), wanted);
    refused("none.npz", &packed_npz(&Particles::default()), "no particles");
    let shorter = given.clone().with_ids(given.ids[..10].to_vec());
    refused("rows.npz", &packed_npz(&shorter), "array `ID.npy` has 10 rows, but there are 2500 positions");
    let mut bytes = bytes;
    while let Some(at) = bytes.windows(7).position(|name| name == b"pos.npy") {
        bytes[at..at + 3].copy_from_slice(b"sop");
    }
    refused("other.npz", &bytes, "none of its arrays (");
}

#[test]
fn points_of_raw_floats_are_read() {
    let given = plain(30);
    let raw: Vec<u8> = given.positions.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    assert_eq!(read("raw.xyz", &raw).unwrap().positions, given.positions);
    refused("raw.xyz", &raw[1..], "are not a multiple of 12");
}

/// A small file of each format and encoding.
fn whole_files() -> Vec<(&'static str, Vec<u8>)> {
    let given = plain(12);
    let written = |name: &'static str| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        write_particles(&path, &given).unwrap();
        (name, fs::read(path).unwrap())
    };
    let mut npy =
        b"\x93NUMPY\x01\x00\x3e\x00{'descr': '<f4', 'fortran_order': False, 'shape': (4, 3), }   \n".to_vec();
    npy.extend([0; 48]);
    vec![
        written("own.ply"),
        written("own.vtu"),
        written("own.vtk"),
        written("own.bgeo"),
        written("own.npz"),
        ("packed.npz", packed_npz(&given)),
        ("text.xyz", b"# x y z\n1 2 3\n4 5 6\n".into()),
        ("whole.npy", npy),
        ("inline.vtu", vtu(&given, "", with_length::<4>, false).into()),
        ("packed.vtu", vtu(&given, ZLIB, packed, true).into()),
        ("text.vtk", vtk_text(&given).into()),
        ("old.vtk", vtk_binary(&given, false)),
        ("new.vtk", vtk_binary(&given, true)),
        ("whole.bgeo", bgeo(&for_bgeo(12))),
        ("packed.bgeo", gzip(&bgeo(&for_bgeo(12)))),
    ]
}

#[test]
fn a_file_cut_at_any_byte_is_refused_or_has_only_complete_particles() {
    for (name, whole) in whole_files() {
        let (_keep, path) = file(name, &whole);
        let complete = read_particles(&path).unwrap_or_else(|error| panic!("{error}"));
        // Truncated in place, which is hundreds of times as fast as writing each length.
        let cut = fs::File::options().write(true).open(&path).unwrap();
        for length in (0..whole.len()).rev() {
            cut.set_len(length as u64).unwrap();
            match read_particles(&path) {
                // Later attributes or data after the points may be missing.
                // A list of points without a count may end at any line.
                Ok(particles) => {
                    assert!(particles.check().is_ok());
                    if name.ends_with("xyz") {
                        continue;
                    }
                    assert_eq!(particles.len(), complete.len(), "{name} at {length}");
                }
                Err(error) => assert!(error.to_string().contains(name), "{error}"),
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn a_file_with_changed_bytes_does_not_cause_a_panic(
        which in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut files = whole_files();
        let (name, mut bytes) = files.swap_remove(which.index(files.len()));
        for (at, to) in changes {
            let at = at.index(bytes.len());
            bytes[at] = to;
        }
        let (_keep, path) = file(name, &bytes);
        if let Ok(particles) = read_particles(&path) {
            prop_assert!(particles.check().is_ok() && !particles.is_empty());
            prop_assert!(particles.positions.iter().flatten().all(|v| v.is_finite()));
        }
    }
}

/// Compressed files whose content is far larger than they are, refused before it is decompressed.
#[test]
fn small_files_of_large_content_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        let begun = std::time::Instant::now();
        let message = read_particles(&path).unwrap_err().to_string();
        assert!(message.contains("may take 256.0 MiB"), "{name}: {message}");
        assert!(begun.elapsed() < std::time::Duration::from_secs(5), "{name}: {:?}", begun.elapsed());
    };
    // A gzip file that declares a hundred million points of 16 bytes. No content is needed to refuse it.
    let mut header = b"BgeoV\0\0\0\x05".to_vec();
    for count in [100_000_000_i32, 0, 0, 0, 0, 0, 0, 0] {
        header.extend(count.to_be_bytes());
    }
    let mut gzip = GzEncoder::new(Vec::new(), Compression::fast());
    gzip.write_all(&header).unwrap();
    refused("a.bgeo.gz", &gzip.finish().unwrap());
    // A VTU file with an array of one block of zlib.
    let text = |points: usize, data: &str| {
        format!(
            "<VTKFile type=\"PolyData\" compressor=\"vtkZLibDataCompressor\"><PolyData><Piece NumberOfPoints=\"{points}\">\
             <Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"binary\">{data}</DataArray></Points>\
             </Piece></PolyData></VTKFile>"
        )
    };
    refused("a.vtu", text(100_000_000, "").as_bytes());
}

/// Scripts that read the arrays of all frames need those of frames without particles too.
#[test]
fn an_archive_without_particles_has_all_arrays() {
    let folder = tempfile::tempdir().unwrap();
    let names = |particles: &Particles| {
        let path = folder.path().join("frame.npz");
        write_particles(&path, particles).unwrap();
        let archive = zip::ZipArchive::new(fs::File::open(&path).unwrap()).unwrap();
        let mut names: Vec<String> = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
        names.sort();
        names
    };
    let all = ["densities.npy", "ids.npy", "positions.npy", "pressures.npy", "velocities.npy"];
    assert_eq!(names(&Particles::default()), all);
    let unknown = Particles::from_positions(vec![[0.0; 3]]);
    assert_eq!(names(&unknown), ["positions.npy"], "negative control: unknown quantities have no array");
}
