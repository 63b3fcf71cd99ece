//! Reads the particles of a frame from a binary PLY file. This reader shares no code with the program under test.

use std::path::Path;

use anyhow::{Context, Result, bail};

/// Positions in m and velocities in m/s.
#[derive(Debug, Default)]
pub struct Cloud {
    pub positions: Vec<[f64; 3]>,
    pub velocities: Vec<[f64; 3]>,
}

/// Reads a file.
pub fn read(path: &Path) -> Result<Cloud> {
    let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    parse(&bytes).with_context(|| format!("{} is not a PLY file of particles", path.display()))
}

fn parse(bytes: &[u8]) -> Result<Cloud> {
    const END: &[u8] = b"end_header\n";
    let end =
        bytes.windows(END.len()).position(|window| window == END).context("there is no header")? + END.len();
    let header = std::str::from_utf8(&bytes[..end])?;
    let (mut count, mut width, mut places) = (0, 0, Vec::new());
    for line in header.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["format", kind, _] if kind != "binary_little_endian" => bail!("its format is {kind}"),
            ["element", "vertex", number] => count = number.parse()?,
            ["element", "face", number] if number != "0" => bail!("it has faces"),
            ["property", kind, name] => {
                places.push((name.to_owned(), kind.to_owned(), width));
                width += match kind {
                    "char" | "uchar" | "int8" | "uint8" => 1,
                    "short" | "ushort" | "int16" | "uint16" => 2,
                    "double" | "float64" => 8,
                    _ => 4,
                };
            }
            _ => {}
        }
    }
    // A frame without particles has no velocities.
    if count == 0 {
        return Ok(Cloud::default());
    }
    let place = |name: &str| -> Result<usize> {
        let found = places.iter().find(|(own, kind, _)| own == name && kind.starts_with("float"));
        Ok(found.with_context(|| format!("it has no property {name}"))?.2)
    };
    let read = |names: [&str; 3]| -> Result<Vec<[f64; 3]>> {
        let columns = [place(names[0])?, place(names[1])?, place(names[2])?];
        let rows = bytes[end..].chunks_exact(width.max(1)).take(count);
        let number = |row: &[u8], at: usize| {
            f64::from(f32::from_le_bytes([row[at], row[at + 1], row[at + 2], row[at + 3]]))
        };
        Ok(rows.map(|row| columns.map(|at| number(row, at))).collect())
    };
    let positions = read(["x", "y", "z"])?;
    let velocities = read(["vx", "vy", "vz"])?;
    if positions.len() != count {
        bail!("it has {} of {count} particles", positions.len());
    }
    Ok(Cloud { positions, velocities })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_and_velocities_are_read_by_name() {
        let mut bytes = b"ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uint id\nproperty float x\n\
            property float y\nproperty float z\nproperty float vx\nproperty float vy\nproperty float vz\nend_header\n"
            .to_vec();
        bytes.extend(7u32.to_le_bytes());
        (1..7).for_each(|k: u8| bytes.extend(f32::from(k).to_le_bytes()));
        let cloud = parse(&bytes).unwrap();
        assert_eq!((cloud.positions[0], cloud.velocities[0]), ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]));
        // Control: a file that is cut off is an error.
        assert!(parse(&bytes[..bytes.len() - 4]).is_err());
    }
}
