//! The data file: the arrays of all frames, each with a header.
//!
//! An array is preceded by its number of elements, as USD stores it, and begins at a multiple of 8 bytes, as both formats
//! require at most. A block without elements ends each frame.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

use crate::atomic::{Temporary, sync_file};

/// What an array contains.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub(crate) enum Channel {
    /// The objects and the frame rate as text, by which data of the same scene is recognised. The first block.
    Signature = 0,
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
    /// The angle of view in degrees and the distance of sharp things in m of a camera, two f32.
    Lens = 10,
    /// The end of a frame.
    End = 11,
}

impl Channel {
    const ALL: [Self; 12] = [
        Self::Signature,
        Self::Positions,
        Self::Normals,
        Self::Velocities,
        Self::Corners,
        Self::Ids,
        Self::Densities,
        Self::Pressures,
        Self::Extent,
        Self::Pose,
        Self::Lens,
        Self::End,
    ];

    /// Bytes of an element.
    fn size(self) -> u64 {
        match self {
            Self::Signature => 1,
            Self::Positions | Self::Normals | Self::Velocities | Self::Extent => 12,
            Self::Corners | Self::Densities | Self::Pressures | Self::Pose | Self::Lens => 4,
            Self::Ids => 8,
            Self::End => 0,
        }
    }

    /// Whether an array can have this number of elements.
    fn can_have(self, count: u64) -> bool {
        match self {
            Self::Extent | Self::Lens => count == 2,
            Self::Pose => count == 7,
            Self::Corners => count.is_multiple_of(3),
            Self::End => count == 0,
            _ => true,
        }
    }
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

    /// Whether its numbers agree with each other and with a scene of this many objects.
    fn is_consistent(&self, objects: usize) -> bool {
        self.count.checked_mul(self.channel.size()) == Some(self.bytes)
            && self.channel.can_have(self.count)
            && usize::from(self.object) < objects.max(1)
            && self.frame < u32::MAX
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

    /// Continues a kept file after the frame `last`. Later frames are removed. `None` if it is not of this scene, or
    /// without that frame: the file is then unchanged.
    pub(crate) fn continued(path: &Path, scene: Signature<'_>, last: u32) -> io::Result<Option<Self>> {
        let mut file = File::options().read(true).write(true).open(path)?;
        let Some(data) = Found::scan(&mut file, 0, scene, last)? else { return Ok(None) };
        file.set_len(data.end)?;
        file.seek(SeekFrom::Start(data.end))?;
        Ok(Some(Self { file: BufWriter::new(file), _temporary: None, blocks: data.blocks, end: data.end }))
    }

    /// Copies what was found in another file.
    pub(crate) fn copy_from(&mut self, from: &mut File, found: Found) -> io::Result<()> {
        from.seek(SeekFrom::Start(found.start))?;
        io::copy(&mut from.take(found.end), &mut self.file)?;
        (self.blocks, self.end) = (found.blocks, found.end);
        Ok(())
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

    /// The complete frames, whose data has been flushed.
    pub(crate) fn blocks(&self) -> io::Result<Blocks> {
        let ended = self.blocks.iter().rposition(|block| block.channel == Channel::End);
        let list = self.blocks[..ended.map_or(0, |last| last + 1)].to_vec();
        let end = list.last().and_then(Block::end).unwrap_or(0);
        Ok(Blocks::new(list, self.file.get_ref().try_clone()?, end))
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

/// What data must agree with to be continued: the text of its first block, and the number of objects.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Signature<'a> {
    pub(crate) text: &'a str,
    pub(crate) objects: usize,
}

/// Data in a file, up to the end of a frame.
#[derive(Debug)]
pub(crate) struct Found {
    blocks: Vec<Block>,
    /// Where it begins in the file.
    start: u64,
    /// Its size in bytes.
    end: u64,
}

impl Found {
    /// The data that begins at `start`, up to the end of the frame `last`. `None` unless it is of this scene, has all frames
    /// up to that one without gaps, and its sizes agree with each other and with the file.
    pub(crate) fn scan(
        file: &mut File,
        start: u64,
        scene: Signature<'_>,
        last: u32,
    ) -> io::Result<Option<Self>> {
        let size = file.metadata()?.len().saturating_sub(start);
        let (mut blocks, mut at, mut next, mut open): (Vec<Block>, _, _, _) = (Vec::new(), 0, None, 0);
        while at + HEADER + 8 <= size {
            file.seek(SeekFrom::Start(start + at))?;
            let mut header = [0; 32];
            file.read_exact(&mut header)?;
            let Some(block) = Block::of(&header, at).filter(|block| block.is_consistent(scene.objects))
            else {
                break;
            };
            let Some(end) = block.end().filter(|&end| end <= size) else { break };
            let is_first = blocks.is_empty();
            if is_first != (block.channel == Channel::Signature)
                || (is_first && !block.is_text(file, scene.text)?)
            {
                break;
            }
            blocks.push(block);
            at = end;
            if is_first {
                open = 1;
            } else if block.channel == Channel::End {
                let is_whole = blocks[open..].iter().all(|own| own.frame == block.frame);
                if !is_whole || next.is_some_and(|next| next != block.frame) {
                    break;
                }
                (next, open) = (Some(block.frame + 1), blocks.len());
                if block.frame == last {
                    return Ok(Some(Self { blocks, start, end: at }));
                }
            }
        }
        Ok(None)
    }
}

impl Block {
    /// Whether the elements, which follow in the file, are this text.
    fn is_text(&self, file: &mut File, text: &str) -> io::Result<bool> {
        if self.bytes != text.len() as u64 {
            return Ok(false);
        }
        let mut found = vec![0; text.len()];
        file.read_exact(&mut found)?;
        Ok(found == text.as_bytes())
    }
}

/// The arrays of a series, for the writer of a format.
#[derive(Debug)]
pub(crate) struct Blocks {
    /// By object and channel, in the order of the frames.
    arrays: HashMap<(u16, Channel), Vec<Block>>,
    file: File,
    /// Bytes of the data.
    end: u64,
}

impl Blocks {
    fn new(list: Vec<Block>, file: File, end: u64) -> Self {
        let mut arrays: HashMap<(u16, Channel), Vec<Block>> = HashMap::new();
        for block in list {
            arrays.entry((block.object, block.channel)).or_default().push(block);
        }
        Self { arrays, file, end }
    }

    /// The number of the first and of the last frame.
    pub(crate) fn frames(&self) -> Option<[u32; 2]> {
        frames(self.of(0, Channel::End))
    }

    /// Bytes of the data.
    pub(crate) fn bytes(&self) -> u64 {
        self.end
    }

    /// Keeps only the frames whose data ends before `limit` bytes.
    pub(crate) fn truncate(&mut self, limit: u64) {
        let ends = self.of(0, Channel::End);
        let kept = ends.iter().filter(|block| block.end().is_some_and(|end| end <= limit)).count();
        let end = kept.checked_sub(1).and_then(|last| ends[last].end()).unwrap_or(0);
        for list in self.arrays.values_mut() {
            list.retain(|block| block.offset < end);
        }
        self.end = end;
    }

    /// The arrays of an object, in the order of the frames.
    pub(crate) fn of(&self, object: usize, channel: Channel) -> &[Block] {
        self.arrays.get(&(object as u16, channel)).map_or(&[], Vec::as_slice)
    }

    /// The array of an object in a frame.
    pub(crate) fn at(&self, object: usize, channel: Channel, frame: u32) -> Option<&Block> {
        let list = self.of(object, channel);
        list.binary_search_by_key(&frame, |block| block.frame).ok().map(|number| &list[number])
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

    const SCENE: Signature<'_> = Signature { text: "a\nb\nc", objects: 3 };

    fn spool(path: &Path) -> io::Result<Spool> {
        let mut spool = Spool::kept(path)?;
        spool.append((0, Channel::Signature), 0, 5, SCENE.text.as_bytes())?;
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
        let before = std::fs::read(&path)?;
        for (text, last, expected) in
            [("a\nb\nd", 4, None), (SCENE.text, 6, None), (SCENE.text, 4, Some([3, 4]))]
        {
            let continued = Spool::continued(&path, Signature { text, ..SCENE }, last)?;
            assert_eq!(continued.as_ref().and_then(Spool::frames), expected, "{text:?} {last}");
            assert_eq!(std::fs::read(&path)? == before, expected.is_none(), "refused data is unchanged");
        }
        let continued = Spool::continued(&path, SCENE, 4)?.unwrap();
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
        assert!(Found::scan(&mut whole, 3, SCENE, 5)?.is_none());
        let found = Found::scan(&mut whole, 4, SCENE, 5)?.unwrap();
        copy.copy_from(&mut whole, found)?;
        copy.flush()?;
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

    /// Numbers that disagree with the data must not be used: they are lengths of memory and of loops.
    #[test]
    fn hostile_headers_are_refused() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("data");
        spool(&path)?;
        let good = std::fs::read(&path)?;
        // The second block: after the first header with its five bytes, which fill eight.
        let second = 40;
        for (at, value) in [(4, 9_u8), (6, 9), (6, 99), (8, 1), (16, 13), (24, 4), (31, 0x40), (23, 0x80)] {
            let mut bytes = good.clone();
            bytes[second + at] = value;
            std::fs::write(&path, bytes)?;
            assert!(Spool::continued(&path, SCENE, 5)?.is_none(), "byte {at} is {value}");
        }
        std::fs::write(&path, good)?;
        assert!(Spool::continued(&path, SCENE, 5)?.is_some(), "the control");
        Ok(())
    }
}
