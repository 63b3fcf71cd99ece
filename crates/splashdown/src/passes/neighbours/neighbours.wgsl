// Lists of neighbours; see passes/neighbours. Needs `params`, `grid`, `cell_start`, `sorted_positions`, `neighbours`, and
// sph/rows, sph/images and sph/candidates.
#import sph/neighbour_entries

// A visit of the neighbours of a particle, four at a time.
struct Visit {
    left: u32, // 0 at the end
    at: u32, // of the next four entries
    // Without a list, the candidates are searched:
    is_by_rows: bool,
    images: u32, // those to come, and the present one
    row: u32, // the next
    first: u32, // of the present candidates
    end: u32, // of their row
    bits: u32, // those of them that are neighbours, and not yet visited
}

fn visit_of(i: u32, x: vec3<f32>) -> Visit {
    let has_list = arrayLength(&neighbours) >= params.particle_count;
    let count = select(BY_ROWS, neighbours[i].x, has_list);
    var visit = Visit(count / 4u + 1u, i, false, 0u, 0u, 0u, 0u, 0u);
    if (count == BY_ROWS) {
        visit.is_by_rows = true;
        visit.images = reflections_near(x);
    }
    return visit;
}

fn next_four(visit: ptr<function, Visit>, i: u32, x: vec3<f32>) -> vec4<u32> {
    if ((*visit).is_by_rows) {
        return next_four_of_rows(visit, i, x);
    }
    var four = neighbours[(*visit).at];
    if ((*visit).at == i) {
        four.x = no_neighbour(i);
    }
    (*visit).left -= 1u;
    (*visit).at += params.particle_count;
    return four;
}

fn next_four_of_rows(visit: ptr<function, Visit>, i: u32, x: vec3<f32>) -> vec4<u32> {
    var four = vec4(no_neighbour(i));
    var found = 0u;
    while (found < 4u && (*visit).left != 0u) {
        if ((*visit).bits != 0u) {
            let j = (*visit).first + firstTrailingBit((*visit).bits);
            four = vec4(four.yzw, entry_of(j, firstTrailingBit((*visit).images)));
            (*visit).bits &= (*visit).bits - 1u;
            found += 1u;
        } else {
            find_candidates(visit, x);
        }
    }
    return four;
}

// The next candidates: of the same row, of the next row, or of the next image.
fn find_candidates(visit: ptr<function, Visit>, x: vec3<f32>) {
    let own = reflected_point(reflection(firstTrailingBit((*visit).images)), x);
    if ((*visit).first + CANDIDATES < (*visit).end) {
        (*visit).first += CANDIDATES;
    } else if ((*visit).row < 9u) {
        let range = row_range(rows_of_image(x, own), (*visit).row);
        (*visit).first = range.x;
        (*visit).end = range.y;
        (*visit).row += 1u;
    } else {
        (*visit).images &= (*visit).images - 1u;
        (*visit).left = select(0u, 1u, (*visit).images != 0u);
        (*visit).row = 0u;
        (*visit).first = 0u;
        (*visit).end = 0u;
    }
    if ((*visit).first < (*visit).end) {
        (*visit).bits = neighbour_bits(own, (*visit).first, (*visit).end);
    }
}

// A neighbour, or its image.
struct Neighbour {
    d: vec3<f32>, // x minus its position; zero without a neighbour
    sign: vec3<f32>, // of its vectors
}

// For an entry and the position of its particle.
fn neighbour_of(entry: u32, x: vec3<f32>, position: vec3<f32>) -> Neighbour {
    let image = entry >> INDEX_BITS;
    if (image == 0u || image == NO_NEIGHBOUR) {
        return Neighbour(x - position, vec3(1.0));
    }
    let by = reflection(image);
    return Neighbour(x - reflected_point(by, position), by.sign);
}
