//! Reads the arrays of a glTF file, with every offset and count checked.

use std::borrow::Cow;
use std::path::{Component, Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::document::{Accessor, Document};
use crate::error::IoError;
use crate::input::content;

/// Number types of the format.
const U8: u32 = 5121;
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;

/// The buffers of a file, each read on first use; those of pictures and animations are not used.
pub(super) struct Buffers<'a> {
    path: &'a Path,
    document: &'a Document,
    blob: Option<&'a [u8]>,
    loaded: Vec<Option<Cow<'a, [u8]>>>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(path: &'a Path, document: &'a Document, blob: Option<&'a [u8]>) -> Self {
        Self { path, document, blob, loaded: vec![None; document.buffers.len()] }
    }

    /// Reads positions.
    pub(super) fn positions(&mut self, index: usize) -> Result<Vec<[f32; 3]>, IoError> {
        let accessor = self.accessor(index)?;
        if (accessor.component_type, accessor.shape.as_str()) != (F32, "VEC3") {
            return Err(self.unsupported(index, "positions", "VEC3 of type 5126 (float)"));
        }
        self.rows(index, 12, bytemuck::pod_read_unaligned)
    }

    /// Reads vertex numbers of 1, 2 or 4 bytes.
    pub(super) fn indices(&mut self, index: usize) -> Result<Vec<u32>, IoError> {
        let accessor = self.accessor(index)?;
        match (accessor.component_type, accessor.shape.as_str()) {
            (U8, "SCALAR") => self.rows(index, 1, |row| row[0].into()),
            (U16, "SCALAR") => self.rows(index, 2, |row| bytemuck::pod_read_unaligned::<u16>(row).into()),
            (U32, "SCALAR") => self.rows(index, 4, bytemuck::pod_read_unaligned),
            _ => {
                Err(self.unsupported(index, "vertex numbers", "SCALAR of type 5121, 5123 or 5125 (unsigned)"))
            }
        }
    }

    fn accessor(&self, index: usize) -> Result<&'a Accessor, IoError> {
        let accessors = &self.document.accessors;
        accessors.get(index).ok_or_else(|| {
            self.malformed(format!("it uses array {index}, but has {} (numbered from 0)", accessors.len()))
        })
    }

    fn unsupported(&self, index: usize, what: &str, read: &str) -> IoError {
        let (kind, shape) =
            self.document.accessors.get(index).map_or((0, ""), |a| (a.component_type, &a.shape));
        self.malformed(format!(
            "the {what} in array {index} are {shape:.80} of type {kind}, but only {read} are read"
        ))
    }

    /// Reads the rows of an array, each with `size` bytes, by `read`. Offsets and counts come from the file, so the
    /// arithmetic is checked.
    fn rows<T>(&mut self, index: usize, size: usize, read: impl Fn(&[u8]) -> T) -> Result<Vec<T>, IoError> {
        let accessor = self.accessor(index)?;
        let (count, offset) = (accessor.count, accessor.byte_offset);
        if accessor.sparse.is_some() {
            return Err(self.malformed(format!(
                "array {index} is sparse, which is not supported; export it without sparse arrays"
            )));
        }
        let view = accessor.buffer_view.and_then(|view| self.document.buffer_views.get(view));
        let Some(view) = view else {
            return Err(self.malformed(format!("array {index} has no data")));
        };
        if count == 0 {
            return Ok(Vec::new());
        }
        let stride = view.byte_stride.unwrap_or(size);
        let needed = (count - 1)
            .checked_mul(stride)
            .and_then(|bytes| bytes.checked_add(size)?.checked_add(offset))
            .filter(|&needed| stride >= size && needed <= view.byte_length);
        let bytes = self.bytes(view.buffer)?;
        let part = view.byte_offset.checked_add(view.byte_length);
        let part = part.and_then(|end| bytes.get(view.byte_offset..end));
        let (Some(part), Some(_)) = (part, needed) else {
            let available = bytes.len();
            return Err(self.malformed(format!(
                "array {index} ({count} rows of {size} bytes) does not fit into its part of buffer {}, which has {available} bytes",
                view.buffer
            )));
        };
        Ok((0..count).map(|row| offset + row * stride).map(|at| read(&part[at..at + size])).collect())
    }

    fn bytes(&mut self, index: usize) -> Result<&[u8], IoError> {
        let Some(buffer) = self.document.buffers.get(index) else {
            return Err(self.malformed(format!(
                "it uses buffer {index}, but has {} (numbered from 0)",
                self.loaded.len()
            )));
        };
        if self.loaded[index].is_none() {
            let bytes = match &buffer.uri {
                Some(uri) => Cow::Owned(self.fetch(index, uri)?),
                // In a binary file the chunk is the first buffer.
                None => Cow::Borrowed(
                    self.blob
                        .filter(|_| index == 0)
                        .ok_or_else(|| self.malformed(format!("buffer {index} is missing from the file")))?,
                ),
            };
            if bytes.len() < buffer.byte_length {
                return Err(self.malformed(format!(
                    "buffer {index} has {} of its {} bytes: it was cut short",
                    bytes.len(),
                    buffer.byte_length
                )));
            }
            self.loaded[index] = Some(bytes);
        }
        Ok(self.loaded[index].as_deref().unwrap_or_default())
    }

    /// Reads a buffer in the JSON, or in another file in the same folder.
    fn fetch(&self, index: usize, uri: &str) -> Result<Vec<u8>, IoError> {
        if let Some(data) = uri.strip_prefix("data:") {
            let encoded = data.split_once(";base64,").map(|(_, encoded)| encoded);
            let encoded =
                encoded.ok_or_else(|| self.malformed(format!("buffer {index} is not encoded in base64")))?;
            return STANDARD.decode(encoded).map_err(|e| self.malformed(format!("in buffer {index}: {e}")));
        }
        if uri.contains("://") {
            return Err(self.malformed(format!(
                "buffer {index} is at `{uri:.80}`; save it to the same folder and refer to it by its file name"
            )));
        }
        content(&self.beside(&unescaped(uri)).ok_or_else(|| {
            self.malformed(format!(
                "buffer {index} is at `{uri:.80}`, outside of the folder of this file; save it to the same folder and refer \
                 to it by its file name"
            ))
        })?)
    }

    /// The path of a file in the folder of this file, or in a folder below it. `None` if the name leads elsewhere,
    /// directly or by a link.
    fn beside(&self, name: &str) -> Option<PathBuf> {
        let is_inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        // A backslash separates folders on Windows, and a colon follows the name of a drive or stream.
        if !Path::new(name).components().all(is_inside) || name.contains(['\\', ':', '\0']) {
            return None;
        }
        let path = self.path.with_file_name("").join(name);
        let folder = self.path.canonicalize().ok()?.parent()?.to_owned();
        match path.canonicalize() {
            Ok(target) => target.starts_with(folder).then_some(path),
            // The error of a missing file names it.
            Err(_) => Some(path),
        }
    }

    /// An error of the file.
    pub(super) fn malformed(&self, reason: String) -> IoError {
        IoError::malformed(self.path, "glTF", reason)
    }
}

/// Decodes a file name in which bytes may be written like `%20`.
fn unescaped(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        let digits = tail.get(..2).filter(|_| *first == b'%').and_then(|two| std::str::from_utf8(two).ok());
        match digits.and_then(|two| u8::from_str_radix(two, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &tail[2..];
            }
            None => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
