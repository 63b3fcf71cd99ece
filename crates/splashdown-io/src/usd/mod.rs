//! USD, the scene format of film and animation, in its binary form (`.usdc`): all frames of a run in one file.
//!
//! Blender, Houdini, Maya, `usdview` and Omniverse open it. [`StageFile`](crate::StageFile) writes it. Velocities are
//! the attribute `velocities`, which these programs use for motion blur.
//!
//! A file begins with a header, followed by the arrays of all frames (`stage::spool`) and by six tables: words (`TOKENS`,
//! `STRINGS`), values by name (`FIELDS`), the values of each object (`FIELDSETS`), and the objects and attributes
//! themselves (`PATHS`, `SPECS`). Values that do not fit into their field stand before the tables.
//!
//! *Why own code:* `openusd` 0.8 holds a file in memory before it is written, which a run of many frames exceeds, and needs
//! a newer compiler; the C++ library takes an hour to build. `tests/foreign` opens the files with Pixar's library and with
//! Blender. *Why version 0.8:* all programs since 2019 read it. Format: the source of OpenUSD, `pxr/usd/usd/crateFile.cpp`
//! and `integerCoding.cpp`.

mod coding;
mod layer;
mod materials;
mod prims;
mod value;

use std::io::{self, Write};

use self::layer::Layer;
use crate::stage::{Blocks, Stage};

/// Bytes of the header, after which the arrays of all frames begin.
pub(crate) const DATA: u64 = 88;
/// Version of the format.
const VERSION: [u8; 8] = [0, 8, 0, 0, 0, 0, 0, 0];

/// Writes a scene with its frames.
pub(crate) fn write_stage(out: &mut dyn Write, stage: &Stage, blocks: &Blocks) -> io::Result<()> {
    let mut layer = Layer::new(DATA + blocks.bytes());
    prims::add(&mut layer, stage, blocks)?;
    let tail = layer.finish();
    out.write_all(b"PXR-USDC")?;
    out.write_all(&VERSION)?;
    out.write_all(&tail.contents.to_le_bytes())?;
    out.write_all(&[0; 64])?;
    blocks.copy_to(out)?;
    out.write_all(&tail.bytes)
}
