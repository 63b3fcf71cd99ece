//! Sharing work out: an output cut into the pieces that tasks write in parallel, workgroups spread over two
//! dimensions.

/// Cuts `whole` at `starts`: piece `i` is `starts[i]..starts[i + 1]`. Pieces past the end of `whole` are cut
/// short, so an overflow of a capacity writes nothing outside.
pub(crate) fn by_starts<'a, T>(whole: &'a mut [T], starts: &[u32]) -> Vec<&'a mut [T]> {
    let mut rest = whole;
    let mut pieces = Vec::with_capacity(starts.len());
    for range in starts.windows(2) {
        let length = (range[1] - range[0]) as usize;
        let (piece, after) = rest.split_at_mut(length.min(rest.len()));
        pieces.push(piece);
        rest = after;
    }
    pieces
}

/// A number of workgroups in two dimensions, neither past the 65,535 that every device grants.
pub(crate) fn spread(groups: u32) -> [u32; 3] {
    [groups.min(65_535), groups.div_ceil(65_535), 1]
}

#[cfg(test)]
mod tests {
    use super::{by_starts, spread};

    #[test]
    fn pieces_follow_one_another_and_stop_at_the_end() {
        let mut whole = [0, 1, 2, 3, 4];
        let pieces: Vec<Vec<i32>> =
            by_starts(&mut whole, &[0, 2, 2, 7, 9]).iter().map(|p| p.to_vec()).collect();
        assert_eq!(pieces, [vec![0, 1], vec![], vec![2, 3, 4], vec![]]);
    }

    #[test]
    fn enough_workgroups_and_not_too_many_in_a_row() {
        for groups in [0, 1, 65_535, 65_536, 1 << 20] {
            let [x, y, z] = spread(groups);
            assert!(x <= 65_535 && y <= 65_535 && x * y * z >= groups, "{groups}");
            assert_eq!(x * y * z == 0, groups == 0);
        }
    }
}
