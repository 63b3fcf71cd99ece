// By key, then by value: equal pairs are identical, so the order is total and the result is unique.
fn comes_after(a: vec2<u32>, b: vec2<u32>) -> bool {
    return a.x > b.x || (a.x == b.x && a.y > b.y);
}
