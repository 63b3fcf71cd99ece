//! Named texts, bytes and arrays in one file: a ZIP archive whose arrays are NPY files, so that `numpy.load` opens it.
//!
//! *Why ZIP:* every entry has a checksum. The list of entries is at the end, so that a truncated file is detected. Common
//! tools open it. Entries are not compressed, because positions compress badly and compression takes longer than writing.

use std::collections::BTreeMap;
use std::io::{self, Cursor, Read, Write};
use std::path::Path;

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::atomic;
use crate::error::IoError;
use crate::input::content;
use crate::npy::{self, Layout};

/// The number types of arrays in an [`Archive`].
pub trait NpyElement: bytemuck::AnyBitPattern + bytemuck::NoUninit {
    /// The name of the type in numpy.
    const DESCR: &'static str;
}

impl NpyElement for f32 {
    const DESCR: &'static str = "<f4";
}

impl NpyElement for u32 {
    const DESCR: &'static str = "<u4";
}

/// The entries of an archive by name.
///
/// ```
/// # fn main() -> Result<(), String> {
/// use splashdown_io::Archive;
///
/// let mut archive = Archive::default();
/// archive.set_text("about.txt", "three points");
/// archive.set_array("points", &[0.0_f32; 9], 3);
/// let read = Archive::from_bytes(&archive.to_bytes()?)?;
/// assert_eq!(read.text("about.txt")?, "three points");
/// assert_eq!(read.array::<f32>("points")?.len(), 9);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Archive(BTreeMap<String, Vec<u8>>);

impl Archive {
    /// Adds or replaces a text.
    pub fn set_text(&mut self, name: &str, text: &str) {
        self.set_bytes(name, text.as_bytes().to_vec());
    }

    /// Adds or replaces bytes.
    pub fn set_bytes(&mut self, name: &str, bytes: Vec<u8>) {
        self.0.insert(name.to_owned(), bytes);
    }

    /// Adds or replaces an array with rows of `columns` numbers, as `name.npy`.
    pub fn set_array<T: NpyElement>(&mut self, name: &str, data: &[T], columns: usize) {
        let mut bytes = npy::header(T::DESCR, &npy::shape(data.len() / columns.max(1), columns));
        bytes.extend_from_slice(bytemuck::cast_slice(data));
        self.set_bytes(&format!("{name}.npy"), bytes);
    }

    /// The bytes of an entry.
    ///
    /// # Errors
    /// A message if there is no entry of that name.
    pub fn bytes(&self, name: &str) -> Result<&[u8], String> {
        self.0.get(name).map(Vec::as_slice).ok_or_else(|| format!("it has no entry `{name}`"))
    }

    /// The text of an entry.
    ///
    /// # Errors
    /// A message if there is no entry of that name or it is not text.
    pub fn text(&self, name: &str) -> Result<&str, String> {
        std::str::from_utf8(self.bytes(name)?)
            .map_err(|error| format!("its entry `{name}` is not text: {error}"))
    }

    /// All numbers of an array, row by row.
    ///
    /// # Errors
    /// A message if there is no array of that name, or one of another type.
    pub fn array<T: NpyElement>(&self, name: &str) -> Result<Vec<T>, String> {
        let name = format!("{name}.npy");
        numbers(self.bytes(&name)?).map_err(|reason| format!("its entry `{name}`: {reason}"))
    }

    /// The bytes of the file.
    ///
    /// # Errors
    /// A message if it is larger than the format allows.
    pub fn to_bytes(&self) -> Result<Vec<u8>, String> {
        let mut bytes = Cursor::new(Vec::new());
        self.fill(&mut bytes).map_err(|error| error.to_string())?;
        Ok(bytes.into_inner())
    }

    fn fill(&self, out: &mut (impl Write + io::Seek)) -> io::Result<()> {
        let mut zip = ZipWriter::new(out);
        for (name, bytes) in &self.0 {
            let options = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Stored)
                .large_file(bytes.len() as u64 >= u64::from(u32::MAX));
            zip.start_file(name.as_str(), options)?;
            zip.write_all(bytes)?;
        }
        zip.finish()?;
        Ok(())
    }

    /// Writes the file, which is complete or absent; returns its size in bytes.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn write(&self, path: &Path) -> Result<u64, IoError> {
        let bytes = self.to_bytes().map_err(|detail| IoError::write(path, &io::Error::other(detail)))?;
        atomic::write(path, |out| out.write_all(&bytes))
    }

    /// Reads a file written by [`write`](Self::write).
    ///
    /// # Errors
    /// [`IoError::Read`]; [`IoError::Malformed`] if it is of another format, damaged or cut short.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        let bytes = content(path)?;
        Self::from_bytes(&bytes).map_err(|reason| IoError::malformed(path, "ZIP", reason))
    }

    /// Reads the bytes of a file.
    ///
    /// # Errors
    /// A message if it is not an archive, damaged or cut short.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        if !bytes.starts_with(b"PK\x03\x04") {
            return Err("it does not begin with the signature of a ZIP archive".to_owned());
        }
        let mut zip = ZipArchive::new(Cursor::new(bytes))
            .map_err(|error| format!("it was cut short or damaged ({error})"))?;
        let mut entries = BTreeMap::new();
        let too_large = || "its entries are compressed, or larger than the file".to_owned();
        let mut total = 0_u64;
        for index in 0..zip.len() {
            let mut entry = zip.by_index(index).map_err(|error| format!("an entry is damaged ({error})"))?;
            let name = entry.name().map_err(|error| format!("an entry has no name ({error})"))?.into_owned();
            // Compressed entries, and entries that overlap, could be far larger than the file.
            total = entry
                .size()
                .checked_add(total)
                .filter(|&total| total <= bytes.len() as u64)
                .ok_or_else(too_large)?;
            if entry.compression() != CompressionMethod::Stored {
                return Err(too_large());
            }
            let mut content = Vec::with_capacity(entry.size() as usize);
            entry
                .read_to_end(&mut content)
                .map_err(|error| format!("its entry `{name}` is damaged ({error})"))?;
            entries.insert(name, content);
        }
        Ok(Self(entries))
    }
}

/// All numbers of an NPY file of any shape.
fn numbers<T: NpyElement>(bytes: &[u8]) -> Result<Vec<T>, String> {
    let (header, data) = npy::split(bytes)?;
    let layout = Layout::of(&header)?;
    let (given, wanted) = (layout.kind(), T::DESCR);
    if given != wanted {
        return Err(format!("it is of type '{given}', not '{wanted}'"));
    }
    Ok(layout.data(data)?.chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect())
}

#[cfg(test)]
mod tests {
    use super::{Archive, CompressionMethod, SimpleFileOptions};
    use std::io::Write;

    fn sample() -> Archive {
        let mut archive = Archive::default();
        archive.set_text("scene.toml", "[fluid]\n");
        archive.set_array("positions", &[1.5_f32, f32::NAN, -0.0, f32::INFINITY, 1e-45, 7.0, 8.0, 9.0], 4);
        archive.set_array("ids", &[7_u32, u32::MAX], 1);
        archive.set_bytes("state.bin", vec![0, 255, 3]);
        archive
    }

    #[test]
    fn entries_round_trip_bit_by_bit() -> Result<(), String> {
        let read = Archive::from_bytes(&sample().to_bytes()?)?;
        assert_eq!(read, sample());
        let bits: Vec<u32> = read.array::<f32>("positions")?.iter().map(|x| x.to_bits()).collect();
        assert_eq!(bits[2], (-0.0_f32).to_bits());
        assert!(f32::from_bits(bits[1]).is_nan());
        assert_eq!(read.array::<u32>("ids")?, [7, u32::MAX]);
        assert!(read.array::<u32>("positions").is_err_and(|reason| reason.contains("<f4")));
        assert!(read.array::<u32>("velocities").is_err_and(|reason| reason.contains("no entry")));
        Ok(())
    }

    #[test]
    fn a_damaged_or_truncated_file_is_refused() -> Result<(), String> {
        let bytes = sample().to_bytes()?;
        for length in 0..bytes.len() {
            assert!(Archive::from_bytes(&bytes[..length]).is_err(), "{length} of {} bytes", bytes.len());
        }
        // A flipped bit in the data is found by the checksum.
        let data = bytes.windows(4).position(|four| four == 1.5_f32.to_le_bytes()).ok_or("no data")?;
        let mut changed = bytes.clone();
        changed[data] ^= 1;
        assert!(Archive::from_bytes(&changed).is_err_and(|reason| reason.contains("positions")));
        // A compressed entry is larger than the file.
        let mut packed = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
        let write = |zip: &mut zip::ZipWriter<_>| {
            zip.start_file("zeros", options)?;
            zip.write_all(&vec![0; 1 << 20])
        };
        write(&mut packed).map_err(|error| error.to_string())?;
        let packed = packed.finish().map_err(|error| error.to_string())?.into_inner();
        assert!(Archive::from_bytes(&packed).is_err_and(|reason| reason.contains("compressed")));
        assert!(Archive::from_bytes(b"ply\n").is_err_and(|reason| reason.contains("begin")));
        Ok(())
    }
}
