// Mirrors ScanParams in mod.rs. A scan of no counts has no effect.
struct ScanParams {
    len: u32,
    blocks: u32,
}
