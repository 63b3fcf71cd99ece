// Lists of neighbours; see passes/neighbours. Needs `params`, `neighbours`, `sorted_positions`, and sph/images.
#import sph/neighbour_entries

// A visit of the neighbours of a particle, four at a time.
struct Visit {
    left: u32, // 0 at the end
    at: u32, // of the next four entries
    // Where the list contains rows of candidates:
    is_by_rows: bool,
    images: u32,
    row: u32,
    j: u32,
    end: u32,
}

fn visit_of(i: u32, x: vec3<f32>) -> Visit {
    let count = neighbours[i].x;
    var visit = Visit(count / 4u + 1u, i, false, 0u, 0u, 0u, 0u);
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

fn word_of_list(i: u32, word: u32) -> u32 {
    return neighbours[word / 4u * params.particle_count + i][word % 4u];
}

fn next_four_of_rows(visit: ptr<function, Visit>, i: u32, x: vec3<f32>) -> vec4<u32> {
    let reach = params.support_radius * params.support_radius;
    var four = vec4(no_neighbour(i));
    var found = 0u;
    while (found < 4u && (*visit).left != 0u) {
        if ((*visit).j < (*visit).end) {
            let image = firstTrailingBit((*visit).images);
            let d = reflected_point(reflection(image), x) - sorted_positions[(*visit).j].xyz;
            if (dot(d, d) < reach) {
                four = vec4(four.yzw, entry_of((*visit).j, image));
                found += 1u;
            }
            (*visit).j += 1u;
        } else if ((*visit).row < 9u) {
            (*visit).j = word_of_list(i, 2u * (*visit).row + 1u);
            (*visit).end = word_of_list(i, 2u * (*visit).row + 2u);
            (*visit).row += 1u;
        } else {
            (*visit).images &= (*visit).images - 1u;
            (*visit).row = 0u;
            (*visit).left = select(0u, 1u, (*visit).images != 0u);
        }
    }
    return four;
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
