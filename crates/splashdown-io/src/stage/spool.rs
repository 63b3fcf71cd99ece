//! The data file: the arrays of all frames, each with a header.
//!
//! An array is preceded by its number of elements, as USD stores it, and begins at a multiple of 8 bytes, as both formats
//! require at most. A block without elements ends each frame.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

use crate::atomic::{Temporary, sync_file};

/// What an array contains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Channel {
    /// The names of the objects, as bytes. The first block.
    Names = 0,
    /// Positions of vertices or points, three f32 each.
    Positions = 1,
    /// Unit normals, three f32 each.
    Normals = 2,
    /// Velocities in m/s, three f32 each.
    Velocities = 3,
    /// Vertex numbers of triangles, u32.
    Corners = 4,
    /// Ids of particles, i64.
    Ids = 5,
    /// Densities in kg/m^3, f32.
    Densities = 6,
    /// Pressures in Pa, f32.
    Pressures = 7,
    /// Lower and upper corner of the bounding box, three f32 each.
    Extent = 8,
    /// A [`Pose`](super::Pose): position and orientation, seven f32.
    Pose = 9,
    /// The end of a frame.
    End = 10,
}

impl Channel {
    const ALL: [Self; 11] = [
        Self::Names,
        Self::Positions,
        Self::Normals,
        Self::Velocities,
        Self::Corners,
        Self::Ids,
        Self::Densities,
        Self::Pressures,
        Self::Extent,
        Self::Pose,
        Self::End,
    ];
}

/// An array in the data file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Block {
    pub(crate) object: u16,
    pub(crate) channel: Channel,
    pub(crate) frame: u32,
    /// Number of elements.
    pub(crate) count: u64,
    /// Where the number of elements is stored, from the beginning of the data; the elements follow.
    pub(crate) offset: u64,
    /// Bytes of the elements.
    pub(crate) bytes: u64,
}

/// Bytes of a header, without the number of elements.
const HEADER: u64 = 24;
const MAGIC: &[u8; 4] = b"SPLD";

impl Block {
    fn header(&self) -> [u8; 32] {
        let mut header = [0; 32];
        header[..4].copy_from_slice(MAGIC);
        header[4..6].copy_from_slice(&self.object.to_le_bytes());
        header[6] = self.channel as u8;
        header[8..12].copy_from_slice(&self.frame.to_le_bytes());
        header[16..24].copy_from_slice(&self.bytes.to_le_bytes());
        header[24..].copy_from_slice(&self.count.to_le_bytes());
        header
    }

    /// The block whose header begins at `start`; `None` if there is none.
    fn of(header: &[u8; 32], start: u64) -> Option<Self> {
        let word = |at: usize| u64::from_le_bytes(header[at..at + 8].try_into().unwrap_or_default());
        (&header[..4] == MAGIC).then_some(())?;
        Some(Self {
            object: u16::from_le_bytes([header[4], header[5]]),
            channel: *Channel::ALL.get(usize::from(header[6]))?,
            frame: (word(8) & 0xffff_ffff) as u32,
            count: word(24),
            offset: start + HEADER,
            bytes: word(16),
        })
    }

    /// The offset of the elements.
    pub(crate) fn elements(&self) -> u64 {
        self.offset + 8
    }

    /// Where the next block begins.
    fn end(&self) -> Option<u64> {
        self.elements().checked_add(self.bytes)?.checked_next_multiple_of(8)
    }
}

/// The data file, open for appending.
#[derive(Debug)]
pub(crate) struct Spool {
    file: BufWriter<File>,
    /// Removes the file on drop, if it is temporary.
    _temporary: Option<Temporary>,
    blocks: Vec<Block>,
    end: u64,
}

impl Spool {
    /// Starts a file that disappears with the process, in the folder of `path`.
    pub(crate) fn temporary(path: &Path) -> io::Result<Self> {
        let temporary = Temporary::create(path)?;
        let file = temporary.file().try_clone()?;
        Ok(Self { file: BufWriter::new(file), _temporary: Some(temporary), blocks: Vec::new(), end: 0 })
    }

    /// Starts a file that remains until it is removed. An existing one is replaced.
    pub(crate) fn kept(path: &Path) -> io::Result<Self> {
        let file = File::options().read(true).write(true).create(true).truncate(true).open(path)?;
        Ok(Self { file: BufWriter::new(file), _temporary: None, blocks: Vec::new(), end: 0 })
    }

    /// Continues a kept file after the frame `last`. Later frames are removed. `None` without that frame.
    pub(crate) fn continued(path: &Path, names: &str, last: u32) -> io::Result<Option<Self>> {
        let mut file = File::options().read(true).write(true).open(path)?;
        let Some((blocks, end)) = scan(&mut file, 0, names, last)? else { return Ok(None) };
        file.set_len(end)?;
        file.seek(SeekFrom::Start(end))?;
        Ok(Some(Self { file: BufWriter::new(file), _temporary: None, blocks, end }))
    }

    /// Copies the data of a complete file, which begins at `start`, up to the frame `last`; `false` without that frame.
    pub(crate) fn copy_from(
        &mut self,
        from: &mut File,
        start: u64,
        names: &str,
        last: u32,
    ) -> io::Result<bool> {
        let Some((blocks, end)) = scan(from, start, names, last)? else { return Ok(false) };
        from.seek(SeekFrom::Start(start))?;
        io::copy(&mut from.take(end), &mut self.file)?;
        (self.blocks, self.end) = (blocks, end);
        Ok(true)
    }

    /// Appends an array with this number of elements.
    pub(crate) fn append(
        &mut self,
        (object, channel): (usize, Channel),
        frame: u32,
        count: usize,
        elements: &[u8],
    ) -> io::Result<()> {
        let bytes = elements.len() as u64;
        let offset = self.end + HEADER;
        let block = Block { object: object as u16, channel, frame, count: count as u64, offset, bytes };
        self.file.write_all(&block.header())?;
        self.file.write_all(elements)?;
        let end = block.elements() + bytes;
        self.end = end.next_multiple_of(8);
        self.file.write_all(&[0; 8][..(self.end - end) as usize])?;
        self.blocks.push(block);
        Ok(())
    }

    /// Passes the data to the system, so that it survives the process.
    pub(crate) fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }

    /// Flushes the data to the disk.
    pub(crate) fn sync(&mut self) -> io::Result<()> {
        self.flush()?;
        sync_file(self.file.get_ref())
    }

    /// The complete frames. The data is flushed first.
    pub(crate) fn blocks(&mut self) -> io::Result<Blocks> {
        self.flush()?;
        Ok(Blocks { list: self.blocks.clone(), file: self.file.get_ref().try_clone()?, end: self.end })
    }

    /// The number of the first and of the last frame.
    pub(crate) fn frames(&self) -> Option<[u32; 2]> {
        frames(&self.blocks)
    }
}

/// The number of the first and of the last complete frame.
fn frames(blocks: &[Block]) -> Option<[u32; 2]> {
    let mut ends = blocks.iter().filter(|block| block.channel == Channel::End).map(|block| block.frame);
    let first = ends.next()?;
    Some([first, ends.next_back().unwrap_or(first)])
}

/// The blocks of the data that begins at `start`, up to the end of the frame `last`, and their size. `None` unless they have
/// these names and all frames up to that one without gaps.
fn scan(file: &mut File, start: u64, names: &str, last: u32) -> io::Result<Option<(Vec<Block>, u64)>> {
    let size = file.metadata()?.len().saturating_sub(start);
    let mut from = BufReader::new(file);
    let (mut blocks, mut at, mut next) = (Vec::new(), 0, None);
    while at + HEADER + 8 <= size {
        from.seek(SeekFrom::Start(start + at))?;
        let mut header = [0; 32];
        from.read_exact(&mut header)?;
        let Some(block) = Block::of(&header, at) else { break };
        let Some(end) = block.end().filter(|&end| end <= size) else { break };
        if block.channel == Channel::Names {
            let mut found = vec![0; block.bytes.min(1 << 16) as usize];
            from.read_exact(&mut found)?;
            if found != names.as_bytes() {
                return Ok(None);
            }
        }
        if blocks.is_empty() && block.channel != Channel::Names {
            return Ok(None);
        }
        blocks.push(block);
        at = end;
        if block.channel == Channel::End {
            if next.is_some_and(|next| next != block.frame) {
                return Ok(None);
            }
            next = block.frame.checked_add(1);
            if block.frame == last {
                return Ok(Some((blocks, at)));
            }
        }
    }
    Ok(None)
}

/// The arrays of a series, for the writer of a format.
#[derive(Debug)]
pub(crate) struct Blocks {
    list: Vec<Block>,
    file: File,
    /// Bytes of the data.
    end: u64,
}

impl Blocks {
    /// The number of the first and of the last frame.
    pub(crate) fn frames(&self) -> Option<[u32; 2]> {
        frames(&self.list)
    }

    /// Bytes of the data.
    pub(crate) fn bytes(&self) -> u64 {
        self.end
    }

    /// Keeps only the frames whose data ends before `limit` bytes.
    pub(crate) fn truncate(&mut self, limit: u64) {
        let is_within =
            |block: &Block| block.channel == Channel::End && block.end().is_some_and(|end| end <= limit);
        let keep = self.list.iter().rposition(is_within).map_or(0, |last| last + 1);
        self.list.truncate(keep);
        self.end = self.list.last().and_then(Block::end).unwrap_or(0);
    }

    /// The arrays of an object, in the order of the frames.
    pub(crate) fn of(&self, object: usize, channel: Channel) -> impl Iterator<Item = &Block> {
        self.list.iter().filter(move |block| usize::from(block.object) == object && block.channel == channel)
    }

    /// The array of an object in a frame.
    pub(crate) fn at(&self, object: usize, channel: Channel, frame: u32) -> Option<&Block> {
        self.of(object, channel).find(|block| block.frame == frame)
    }

    /// Reads a short array of f32.
    pub(crate) fn floats<const N: usize>(&self, block: &Block) -> io::Result<[f32; N]> {
        let mut file = &self.file;
        file.seek(SeekFrom::Start(block.elements()))?;
        let mut values = [0.0; N];
        file.read_exact(bytemuck::cast_slice_mut(&mut values))?;
        Ok(values)
    }

    /// Copies the data.
    pub(crate) fn copy_to(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut file = &self.file;
        file.rewind()?;
        let copied = io::copy(&mut file.take(self.end), out)?;
        if copied == self.end { Ok(()) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spool(path: &Path) -> io::Result<Spool> {
        let mut spool = Spool::kept(path)?;
        spool.append((0, Channel::Names), 0, 5, b"a\nb\nc")?;
        for frame in 3..6 {
            spool.append((1, Channel::Pressures), frame, 3, bytemuck::cast_slice(&[frame as f32; 3]))?;
            spool.append((0, Channel::End), frame, 0, &[])?;
        }
        spool.flush()?;
        Ok(spool)
    }

    #[test]
    fn a_data_file_is_continued_after_a_frame() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("data");
        assert_eq!(spool(&path)?.frames(), Some([3, 5]));
        // A kill in the middle of a block.
        let mut file = File::options().append(true).open(&path)?;
        file.write_all(b"SPLD\0\0\x01")?;
        for (names, last, expected) in
            [("a\nb\nd", 4, None), ("a\nb\nc", 6, None), ("a\nb\nc", 4, Some([3, 4]))]
        {
            let continued = Spool::continued(&path, names, last)?;
            assert_eq!(continued.as_ref().and_then(Spool::frames), expected, "{names:?} {last}");
        }
        let mut continued = Spool::continued(&path, "a\nb\nc", 4)?.unwrap();
        let blocks = continued.blocks()?;
        let block = blocks.at(1, Channel::Pressures, 4).unwrap();
        assert_eq!(blocks.floats::<3>(block)?, [4.0; 3]);
        assert_eq!(blocks.at(1, Channel::Pressures, 5), None, "later frames are removed");
        assert_eq!(blocks.bytes(), std::fs::metadata(&path)?.len());
        Ok(())
    }

    #[test]
    fn the_data_of_a_complete_file_is_copied() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let mut bytes = b"head".to_vec();
        spool(&folder.path().join("data"))?.blocks()?.copy_to(&mut bytes)?;
        bytes.extend_from_slice(b"the description, which is not a block");
        std::fs::write(folder.path().join("whole"), &bytes)?;
        let mut whole = File::open(folder.path().join("whole"))?;
        let mut copy = Spool::kept(&folder.path().join("copy"))?;
        assert!(copy.copy_from(&mut whole, 4, "a\nb\nc", 5)?);
        assert!(!Spool::kept(&folder.path().join("other"))?.copy_from(&mut whole, 3, "a\nb\nc", 5)?);
        assert_eq!(copy.blocks()?.bytes(), std::fs::metadata(folder.path().join("data"))?.len());
        Ok(())
    }

    #[test]
    fn truncated_data_ends_with_a_frame() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let mut blocks = spool(&folder.path().join("data"))?.blocks()?;
        let whole = blocks.bytes();
        blocks.truncate(whole - 1);
        assert_eq!(blocks.frames(), Some([3, 4]));
        blocks.truncate(10);
        assert_eq!((blocks.frames(), blocks.bytes()), (None, 0));
        Ok(())
    }
}
