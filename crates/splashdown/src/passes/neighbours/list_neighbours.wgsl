#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/images
#import sph/candidates
#import sph/neighbour_entries

#bindings

// A list while words are appended. Every four of them are stored.
struct List {
    words: u32,
    last: vec4<u32>,
}

// Values instead of pointers keep the list in registers.
fn append(list: List, i: u32, layers: u32, word: u32) -> List {
    let last = vec4(list.last.yzw, word);
    let words = list.words + 1u;
    if (words % 4u == 0u && words <= 4u * layers) {
        neighbours[(words / 4u - 1u) * params.particle_count + i] = last;
    }
    return List(words, last);
}

@compute @workgroup_size(64)
fn list_neighbours(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    let layers = arrayLength(&neighbours) / params.particle_count;
    if (i >= active_count() || layers == 0u) {
        return;
    }
    let x = sorted_positions[i].xyz;
    // The first word is the header.
    var list = List(1u, vec4(0u));
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let image = firstTrailingBit(left);
        let own = reflected_point(reflection(image), x);
        let rows = rows_of_image(x, own);
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(rows, row);
            for (var first = range.x; first < range.y; first += CANDIDATES) {
                for (var bits = neighbour_bits(own, first, range.y); bits != 0u; bits &= bits - 1u) {
                    list = append(list, i, layers, entry_of(first + firstTrailingBit(bits), image));
                }
            }
        }
    }
    if (list.words > 4u * layers) {
        neighbours[i].x = BY_ROWS;
        return;
    }
    let count = list.words - 1u;
    while (list.words % 4u != 0u) {
        list = append(list, i, layers, no_neighbour(i));
    }
    neighbours[i].x = count;
}
