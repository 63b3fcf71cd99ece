// Mirrors Suspension in suspension.rs.
struct Suspension {
    cell_particles: u32,
    all_particles: u32,
    scan_len: u32,
    scan_blocks: u32,
    count: u32,
}
