//! The parts of a glTF file's JSON that the reader needs, and the chunks of the binary form.

use serde::Deserialize;

/// The fields of a document that define triangles and their positions. Others are ignored.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    asset: Asset,
    pub(super) scene: Option<usize>,
    #[serde(default)]
    pub(super) scenes: Vec<SceneNodes>,
    #[serde(default)]
    pub(super) nodes: Vec<Node>,
    #[serde(default)]
    pub(super) meshes: Vec<Primitives>,
    #[serde(default)]
    pub(super) accessors: Vec<Accessor>,
    #[serde(default)]
    pub(super) buffer_views: Vec<View>,
    #[serde(default)]
    pub(super) buffers: Vec<Buffer>,
    #[serde(default)]
    extensions_required: Vec<String>,
}

#[derive(Deserialize)]
struct Asset {
    version: String,
}

#[derive(Deserialize)]
pub(super) struct SceneNodes {
    #[serde(default)]
    pub(super) nodes: Vec<usize>,
}

#[derive(Deserialize)]
pub(super) struct Node {
    pub(super) mesh: Option<usize>,
    #[serde(default)]
    pub(super) children: Vec<usize>,
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
}

#[derive(Deserialize)]
pub(super) struct Primitives {
    pub(super) primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
pub(super) struct Primitive {
    pub(super) attributes: Attributes,
    pub(super) indices: Option<usize>,
    pub(super) mode: Option<u32>,
}

#[derive(Deserialize)]
pub(super) struct Attributes {
    #[serde(rename = "POSITION")]
    pub(super) position: Option<usize>,
}

/// An array in a part of a buffer.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<usize>,
    #[serde(default)]
    pub(super) byte_offset: usize,
    pub(super) component_type: u32,
    pub(super) count: usize,
    #[serde(rename = "type")]
    pub(super) shape: String,
    pub(super) sparse: Option<serde::de::IgnoredAny>,
}

/// A part of a buffer.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct View {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: usize,
    pub(super) byte_length: usize,
    pub(super) byte_stride: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
    pub(super) byte_length: usize,
}

impl Document {
    /// Reads a text or binary file; returns the document and the buffer of a binary file.
    pub(super) fn parse(bytes: &[u8]) -> Result<(Self, Option<&[u8]>), String> {
        let (json, blob) = if bytes.starts_with(b"glTF") { chunks(bytes)? } else { (bytes, None) };
        let document: Self = serde_json::from_slice(json).map_err(|error| error.to_string())?;
        let version = &document.asset.version;
        if !version.starts_with("2.") {
            return Err(format!("its version is `{version:.80}`, only version 2 is read"));
        }
        // Only these extensions change how the triangles are stored.
        let changes = |name: &&String| name.contains("compression") || name.contains("quantization");
        if let Some(name) = document.extensions_required.iter().find(changes) {
            return Err(format!(
                "its geometry is compressed by `{name:.80}`, which is not supported; export it without compression"
            ));
        }
        Ok((document, blob))
    }

    /// The declared size of the buffers in other files. Their content is compared with it when they are read.
    pub(super) fn external_bytes(&self) -> u64 {
        let external = |buffer: &&Buffer| buffer.uri.as_ref().is_some_and(|uri| !uri.starts_with("data:"));
        self.buffers
            .iter()
            .filter(external)
            .map(|buffer| buffer.byte_length as u64)
            .fold(0, u64::saturating_add)
    }
}

/// The JSON and the buffer of a binary file: a header of 12 bytes, then chunks of length, kind and data.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    let cut = || format!("it was cut short: its chunks need more than its {} bytes", bytes.len());
    let word = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..at.checked_add(4)?)?.first_chunk()?));
    let (version, total) = (word(4).ok_or_else(cut)?, word(8).ok_or_else(cut)? as usize);
    if version != 2 {
        return Err(format!("the version of its container is {version}, only version 2 is read"));
    }
    if total > bytes.len() {
        return Err(cut());
    }
    let (mut json, mut blob, mut at) = (None, None, 12);
    while at < total {
        let length = word(at).ok_or_else(cut)? as usize;
        let kind = bytes.get(at + 4..at + 8).ok_or_else(cut)?;
        let end = (at + 8).checked_add(length).filter(|&end| end <= total).ok_or_else(cut)?;
        let data = &bytes[at + 8..end];
        match kind {
            b"JSON" => json = json.or(Some(data)),
            b"BIN\0" => blob = blob.or(Some(data)),
            // Unknown kinds must be skipped.
            _ => {}
        }
        at = end;
    }
    Ok((json.ok_or("it has no JSON chunk")?, blob))
}
