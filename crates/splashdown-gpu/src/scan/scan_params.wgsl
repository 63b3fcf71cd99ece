// Mirrors ScanParams in mod.rs. A scan of no counts only writes the zero before the first.
struct ScanParams {
    len: u32,
    blocks: u32,
}
