//! Splitting of an output into pieces that tasks write in parallel.

/// Splits `whole` at `starts`: piece `i` is `starts[i]..starts[i + 1]`. Pieces beyond the end of
/// `whole` are truncated, so that no write is out of range if a capacity is exceeded.
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

#[cfg(test)]
mod tests {
    use super::by_starts;

    #[test]
    fn pieces_are_consecutive_and_truncated_at_the_end() {
        let mut whole = [0, 1, 2, 3, 4];
        let pieces: Vec<Vec<i32>> =
            by_starts(&mut whole, &[0, 2, 2, 7, 9]).iter().map(|p| p.to_vec()).collect();
        assert_eq!(pieces, [vec![0, 1], vec![], vec![2, 3, 4], vec![]]);
    }
}
