//! Checks VTU files with a small independent reader of their XML and offsets.

mod common;

use std::collections::BTreeMap;

use splashdown_io::{Particles, pvd, vtu, write_particles};

/// A data array as declared in the file, with its bytes.
#[derive(Debug, PartialEq)]
struct Found {
    section: String,
    kind: String,
    components: usize,
    bytes: Vec<u8>,
}

impl Found {
    fn values<const N: usize, T>(&self, from: fn([u8; N]) -> T) -> Vec<T> {
        self.bytes.chunks_exact(N).map(|chunk| from(chunk.try_into().expect("N bytes"))).collect()
    }
}

/// The number of points and the arrays by name. Every byte of the appended part must belong to exactly one array.
fn take_apart(file: &[u8]) -> Result<(usize, BTreeMap<String, Found>), String> {
    let marker = b"<AppendedData encoding=\"raw\">\n_";
    let start =
        file.windows(marker.len()).position(|w| w == marker).ok_or("no appended data")? + marker.len();
    let xml = std::str::from_utf8(&file[..start]).map_err(|e| e.to_string())?;
    for needed in ["type=\"UnstructuredGrid\"", "byte_order=\"LittleEndian\"", "header_type=\"UInt64\""] {
        xml.contains(needed).then_some(()).ok_or_else(|| format!("{needed} is missing"))?;
    }
    let attribute = |line: &str, name: &str| -> Result<String, String> {
        let after = line.split_once(&format!(" {name}=\"")).ok_or_else(|| format!("no {name} in {line}"))?.1;
        Ok(after.split('"').next().unwrap_or_default().to_owned())
    };
    let number = |text: String| text.parse::<usize>().map_err(|e| format!("{text}: {e}"));

    let (mut points, mut section, mut arrays, mut end) = (0, String::new(), BTreeMap::new(), 0);
    for line in xml.lines() {
        match line.trim_start_matches('<').split([' ', '>']).next().unwrap_or_default() {
            "Piece" => points = number(attribute(line, "NumberOfPoints")?)?,
            name @ ("PointData" | "Points" | "Cells") => section = name.to_owned(),
            "DataArray" => {
                let offset = number(attribute(line, "offset")?)?;
                (offset == end).then_some(()).ok_or_else(|| format!("a gap before {line}"))?;
                let data = &file[start + offset..];
                let length = u64::from_le_bytes(data[..8].try_into().map_err(|_| "no length")?) as usize;
                let found = Found {
                    section: section.clone(),
                    kind: attribute(line, "type")?,
                    components: attribute(line, "NumberOfComponents").map_or(Ok(1), number)?,
                    bytes: data.get(8..8 + length).ok_or("an array reaches past the end")?.to_vec(),
                };
                arrays.insert(attribute(line, "Name")?, found);
                end = offset + 8 + length;
            }
            _ => {}
        }
    }
    let rest = &file[start + end..];
    (rest == b"\n</AppendedData>\n</VTKFile>\n").then_some(()).ok_or("bytes that belong to no array")?;
    Ok((points, arrays))
}

fn written(particles: &Particles) -> Vec<u8> {
    let mut file = Vec::new();
    vtu::write_particles_to(&mut file, particles).expect("memory takes everything");
    file
}

#[test]
fn every_array_is_at_its_declared_offset() {
    // Around the writer's chunk size, so that generated arrays have several chunks.
    for count in [0, 1, 4095, 4096, 4097, 9000] {
        let given = common::particles(count);
        let (points, arrays) = take_apart(&written(&given)).unwrap();
        assert_eq!(points, count);

        let f32s = |name: &str| arrays[name].values(f32::from_le_bytes);
        let i32s = |name: &str| arrays[name].values(i32::from_le_bytes);
        let count = count as i32;
        assert_eq!(f32s("Points"), given.positions.concat());
        assert_eq!(i32s("connectivity"), (0..count).collect::<Vec<_>>());
        assert_eq!(i32s("offsets"), (1..=count).collect::<Vec<_>>());
        assert_eq!(arrays["types"].bytes, vec![1; count as usize]);
        assert_eq!((arrays["types"].kind.as_str(), arrays["types"].section.as_str()), ("UInt8", "Cells"));
        if count > 0 {
            assert_eq!(f32s("velocity"), given.velocities.concat());
            assert_eq!(
                (arrays["velocity"].components, arrays["velocity"].section.as_str()),
                (3, "PointData")
            );
            assert_eq!(f32s("density"), given.densities);
            assert_eq!(f32s("pressure"), given.pressures);
            assert_eq!(arrays["id"].values(u32::from_le_bytes), given.ids);
            assert_eq!(arrays["id"].kind, "UInt32");
        }
    }
}

#[test]
fn absent_attributes_are_absent() {
    let given = common::particles(5).with_velocities(Vec::new()).with_pressures(Vec::new());
    let (_, arrays) = take_apart(&written(&given)).unwrap();
    assert_eq!(
        arrays.keys().collect::<Vec<_>>(),
        ["Points", "connectivity", "density", "id", "offsets", "types"]
    );
}

#[test]
fn the_reader_of_this_test_detects_a_wrong_offset_length_or_value() {
    let good = written(&common::particles(50));
    let text = String::from_utf8_lossy(&good).into_owned();
    let line = text.lines().find(|line| line.contains("Name=\"density\"")).unwrap();
    let offset = line.split("offset=\"").nth(1).unwrap().split('"').next().unwrap();
    let replace = |from: &str, to: &str| {
        let at = good.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
        [&good[..at], to.as_bytes(), &good[at + from.len()..]].concat()
    };
    let shifted = (offset.parse::<usize>().unwrap() + 4).to_string();
    assert!(take_apart(&replace(&format!("offset=\"{offset}\""), &format!("offset=\"{shifted}\""))).is_err());
    assert!(take_apart(&good[..good.len() - 40]).is_err());
    assert!(take_apart(&replace("\n</AppendedData>", "!\n</AppendedData>")).is_err());
    let mut other = common::particles(50);
    other.densities[30] += 1.0;
    assert_ne!(take_apart(&written(&other)), take_apart(&good));
}

#[test]
fn files_and_their_index_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let given = common::particles(20);
    let path = folder.path().join("particles_0001.vtu");
    let bytes = write_particles(&path, &given).unwrap();
    let file = std::fs::read(&path).unwrap();
    assert_eq!((file.len() as u64, &file), (bytes, &written(&given)));

    let index = folder.path().join("particles.pvd");
    let frames = [(0.0, "particles_0000.vtu".to_owned()), (0.02, "a<b>&\"c\".vtu".to_owned())];
    pvd::write_index(&index, &frames).unwrap();
    let text = std::fs::read_to_string(&index).unwrap();
    assert!(text.contains(
        "<DataSet timestep=\"0.02\" group=\"\" part=\"0\" file=\"a&lt;b&gt;&amp;&quot;c&quot;.vtu\"/>"
    ));
    assert_eq!(text.matches("<DataSet ").count(), 2);
}
