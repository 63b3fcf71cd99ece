// An entry of a list of neighbours: the index of the particle, and above it the number of its reflection.
const INDEX_BITS: u32 = 27u;
const INDEX: u32 = 0x7ffffffu;
const NO_NEIGHBOUR: u32 = 31u; // instead of a reflection

// Instead of the number of neighbours: there is no list, and a visit searches the candidates.
const BY_ROWS: u32 = 0x80000000u;

fn entry_of(j: u32, image: u32) -> u32 {
    return (image << INDEX_BITS) | j;
}

// Fills a list of particle i. Its index may be used like that of a neighbour.
fn no_neighbour(i: u32) -> u32 {
    return entry_of(i, NO_NEIGHBOUR);
}
