//! The bytes of one array: after a length, in base64 or raw, uncompressed or in blocks compressed by zlib.

use std::io::Read as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;

use crate::number::Number;

/// Layout of a file's binary arrays.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    pub(super) big_endian: bool,
    /// The type of the lengths before arrays.
    pub(super) header: Number,
    /// Whether arrays are compressed by zlib.
    pub(super) is_compressed: bool,
}

/// How bytes are stored.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    Raw,
    Base64,
}

/// The section after the XML that contains arrays.
pub(super) enum Appended<'a> {
    Raw(&'a [u8]),
    Base64(&'a [u8]),
}

impl<'a> Appended<'a> {
    /// From the section's text, which begins with an underscore.
    pub(super) fn base64(text: &'a str) -> Result<Self, String> {
        let text = text.trim_ascii().strip_prefix('_').ok_or("its appended data does not begin with `_`")?;
        Ok(Self::Base64(text.as_bytes()))
    }

    pub(super) fn from(&self, offset: usize) -> Result<(&'a [u8], Encoding), String> {
        let (all, encoding) = match *self {
            Self::Raw(all) => (all, Encoding::Raw),
            Self::Base64(all) => (all, Encoding::Base64),
        };
        let left = all.get(offset..).ok_or_else(|| {
            format!("it begins at {offset}, but {} bytes are appended: it was cut short", all.len())
        })?;
        Ok((left, encoding))
    }
}

impl Layout {
    /// Decodes the array at the start of `from`, which must have `wanted` bytes.
    pub(super) fn array(self, from: &[u8], encoding: Encoding, wanted: usize) -> Result<Vec<u8>, String> {
        let mut source = Source { left: from.trim_ascii_start(), encoding };
        if encoding == Encoding::Raw {
            source.left = from;
        }
        if self.is_compressed { self.blocks(&mut source, wanted) } else { self.plain(&mut source, wanted) }
    }

    /// Decodes a length and as many bytes; base64 encodes both in one run.
    fn plain(self, source: &mut Source<'_>, wanted: usize) -> Result<Vec<u8>, String> {
        let header = self.header.size();
        let mut bytes = source.take(header.checked_add(wanted).ok_or("it is too large")?)?;
        let given = self.word(&bytes);
        if given != wanted as u64 {
            return Err(format!("it has {given} bytes, its points need {wanted}"));
        }
        bytes.drain(..header);
        Ok(bytes)
    }

    /// Decodes the number of blocks, their size, the size of the last block (0 if complete), the compressed size of each,
    /// then all blocks. Base64 has one run for the sizes and one for the blocks.
    fn blocks(self, source: &mut Source<'_>, wanted: usize) -> Result<Vec<u8>, String> {
        let size = self.header.size();
        // The first three numbers give the length of their run, so they are decoded first and then again with the rest.
        // Their 12 or 24 bytes are complete groups of base64.
        let first = Source { ..*source }.take(3 * size)?;
        let [blocks, block, last] = [0, 1, 2].map(|n| self.word(&first[n * size..]));
        let total = match (blocks, last) {
            (0, _) => Some(0),
            (_, 0) => blocks.checked_mul(block),
            _ => (blocks - 1).checked_mul(block).and_then(|bytes| bytes.checked_add(last)),
        };
        if total != Some(wanted as u64) {
            return Err(format!("it has {blocks} blocks of {block} bytes, its points need {wanted}"));
        }
        // If there are more blocks than bytes, some of them are empty.
        let blocks =
            usize::try_from(blocks).ok().filter(|&blocks| blocks <= wanted).ok_or("it has empty blocks")?;
        let sizes = source.take((3 + blocks) * size)?;
        let compressed: Option<usize> = (0..blocks)
            .map(|n| usize::try_from(self.word(&sizes[(3 + n) * size..])).ok())
            .try_fold(0_usize, |sum, size| sum.checked_add(size?));
        let data = source.take(compressed.ok_or("its blocks are too large")?)?;
        let (mut bytes, mut at) = (Vec::new(), 0);
        for number in 0..blocks {
            let length = self.word(&sizes[(3 + number) * size..]) as usize;
            let expected = if number + 1 == blocks && last != 0 { last } else { block };
            let before = bytes.len() as u64;
            // One byte more than expected is read, so that excess bytes are detected.
            ZlibDecoder::new(&data[at..at + length])
                .take(expected.saturating_add(1))
                .read_to_end(&mut bytes)
                .map_err(|error| format!("block {number}: {error}"))?;
            if bytes.len() as u64 - before != expected {
                return Err(format!("block {number} does not decompress to {expected} bytes"));
            }
            at += length;
        }
        Ok(bytes)
    }

    /// The length at the start of `bytes`.
    fn word(self, bytes: &[u8]) -> u64 {
        let mut word = [0; 8];
        let size = self.header.size();
        word[..size].copy_from_slice(&bytes[..size]);
        if self.big_endian {
            word[..size].reverse();
        }
        u64::from_le_bytes(word)
    }
}

/// Bytes that are decoded run by run.
struct Source<'a> {
    left: &'a [u8],
    encoding: Encoding,
}

impl Source<'_> {
    /// Decodes the next run, which has `count` bytes.
    fn take(&mut self, count: usize) -> Result<Vec<u8>, String> {
        let cut = "it was cut short";
        let length = match self.encoding {
            Encoding::Raw => count,
            Encoding::Base64 => count.div_ceil(3).checked_mul(4).ok_or(cut)?,
        };
        let (run, left) = self.left.split_at_checked(length).ok_or(cut)?;
        self.left = left;
        match self.encoding {
            Encoding::Raw => Ok(run.to_vec()),
            Encoding::Base64 => match STANDARD.decode(run) {
                Ok(bytes) if bytes.len() == count => Ok(bytes),
                Ok(bytes) => Err(format!("a run of base64 has {} bytes for {count}", bytes.len())),
                Err(error) => Err(format!("not base64: {error}")),
            },
        }
    }
}
