//! The number types of binary and text files, and how they are decoded.

/// The type of a number in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// A type that every [`Number`] can be decoded to.
pub(crate) trait FromNumber {
    /// From any type but `F32`. An f64 represents all of these exactly, except integers beyond 2^53.
    fn from_f64(value: f64) -> Self;

    /// From `F32`.
    fn from_f32(value: f32) -> Self;
}

impl FromNumber for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }

    fn from_f32(value: f32) -> Self {
        value.into()
    }
}

impl FromNumber for f32 {
    fn from_f64(value: f64) -> Self {
        value as Self
    }

    /// Preserves all bits, including those of a NaN.
    fn from_f32(value: f32) -> Self {
        value
    }
}

/// Numbers of one type inside the rows of a binary table.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cells {
    /// Byte of a row at which the first number begins.
    pub(crate) at: usize,
    /// Numbers per row, one directly after the other.
    pub(crate) components: usize,
    /// Bytes of a row, at least one.
    pub(crate) stride: usize,
    pub(crate) big_endian: bool,
}

impl Number {
    /// Bytes of one number.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Decodes an array without gaps.
    pub(crate) fn decode<T: FromNumber>(self, bytes: &[u8], big_endian: bool) -> Vec<T> {
        let mut values = Vec::with_capacity(bytes.len() / self.size());
        self.decode_cells(
            bytes,
            Cells { at: 0, components: 1, stride: self.size(), big_endian },
            &mut values,
        );
        values
    }

    /// Appends the numbers of all complete rows to `values`.
    pub(crate) fn decode_cells<T: FromNumber>(self, rows: &[u8], cells: Cells, values: &mut Vec<T>) {
        // One loop per type, so that the type is not tested for each number.
        match self {
            Self::I8 => each(rows, cells, values, |b| T::from_f64(i8::from_le_bytes(b).into())),
            Self::U8 => each(rows, cells, values, |b| T::from_f64(u8::from_le_bytes(b).into())),
            Self::I16 => each(rows, cells, values, |b| T::from_f64(i16::from_le_bytes(b).into())),
            Self::U16 => each(rows, cells, values, |b| T::from_f64(u16::from_le_bytes(b).into())),
            Self::I32 => each(rows, cells, values, |b| T::from_f64(i32::from_le_bytes(b).into())),
            Self::U32 => each(rows, cells, values, |b| T::from_f64(u32::from_le_bytes(b).into())),
            Self::I64 => each(rows, cells, values, |b| T::from_f64(i64::from_le_bytes(b) as f64)),
            Self::U64 => each(rows, cells, values, |b| T::from_f64(u64::from_le_bytes(b) as f64)),
            Self::F32 => each(rows, cells, values, |b| T::from_f32(f32::from_le_bytes(b))),
            Self::F64 => each(rows, cells, values, |b| T::from_f64(f64::from_le_bytes(b))),
        }
    }

    /// Parses a word of a text file; `None` if it is not a number, or out of the range of this type.
    pub(crate) fn parse<T: FromNumber>(self, word: &str) -> Option<T> {
        let range = match self {
            Self::F32 => return word.parse().ok().map(T::from_f32),
            Self::F64 => return word.parse().ok().map(T::from_f64),
            Self::I8 => i8::MIN.into()..=i8::MAX.into(),
            Self::U8 => 0.0..=u8::MAX.into(),
            Self::I16 => i16::MIN.into()..=i16::MAX.into(),
            Self::U16 => 0.0..=u16::MAX.into(),
            Self::I32 => i32::MIN.into()..=i32::MAX.into(),
            Self::U32 => 0.0..=u32::MAX.into(),
            Self::I64 => i64::MIN as f64..=i64::MAX as f64,
            Self::U64 => 0.0..=u64::MAX as f64,
        };
        // `2.0` is an integer too: numpy writes integers like this.
        let value: f64 = word.parse().ok()?;
        (value.fract() == 0.0 && range.contains(&value)).then(|| T::from_f64(value))
    }
}

/// `value` as an integer, if it is one; some programs store ids as floats.
pub(crate) fn whole(value: f64) -> Option<u32> {
    (value >= 0.0 && value <= f64::from(u32::MAX) && value.fract() == 0.0).then_some(value as u32)
}

/// All values as integers.
///
/// # Errors
/// A message that names the first that is not one.
pub(crate) fn wholes(values: &[f64], what: &str) -> Result<Vec<u32>, String> {
    let whole = |&value: &f64| whole(value).ok_or_else(|| format!("{value} is not a {what}"));
    values.iter().map(whole).collect()
}

/// Appends the numbers of all rows; `from` decodes one from its bytes, lowest first.
fn each<const N: usize, T>(rows: &[u8], cells: Cells, values: &mut Vec<T>, from: impl Fn([u8; N]) -> T) {
    let Cells { at, components, stride, big_endian } = cells;
    let number = |bytes: &[u8; N]| {
        let mut bytes = *bytes;
        if big_endian {
            bytes.reverse();
        }
        from(bytes)
    };
    if stride == components * N {
        values.extend(rows.as_chunks().0.iter().map(number));
    } else if components == 1 {
        values.extend(rows.chunks_exact(stride).filter_map(|row| row[at..].first_chunk()).map(number));
    } else {
        let cells = rows.chunks_exact(stride).flat_map(|row| row[at..at + components * N].as_chunks().0);
        values.extend(cells.map(number));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_type_is_decoded_in_both_byte_orders() {
        fn check<const N: usize>(number: Number, bytes: [u8; N], value: f64) {
            let mut reversed = bytes;
            reversed.reverse();
            assert_eq!(number.decode::<f64>(&bytes, false), [value], "{number:?}");
            assert_eq!(number.decode::<f64>(&reversed, true), [value], "{number:?}");
            assert_eq!(number.decode::<f32>(&bytes, false), [value as f32], "{number:?}");
            assert_eq!(number.size(), N);
        }
        check(Number::I8, (-3_i8).to_le_bytes(), -3.0);
        check(Number::U8, 253_u8.to_le_bytes(), 253.0);
        check(Number::I16, (-300_i16).to_le_bytes(), -300.0);
        check(Number::U16, 65_000_u16.to_le_bytes(), 65_000.0);
        check(Number::I32, (-70_000_i32).to_le_bytes(), -70_000.0);
        check(Number::U32, 4_000_000_000_u32.to_le_bytes(), 4e9);
        check(Number::I64, (-5_000_000_000_i64).to_le_bytes(), -5e9);
        check(Number::U64, (1_u64 << 63).to_le_bytes(), (1_u64 << 63) as f64);
        check(Number::F32, 0.1_f32.to_le_bytes(), 0.1_f32.into());
        check(Number::F64, 0.1_f64.to_le_bytes(), 0.1);
    }

    #[test]
    fn cells_are_extracted_from_their_rows() {
        let rows: Vec<u8> = (0..12).collect();
        let mut values = Vec::<f32>::new();
        let cells = Cells { at: 1, components: 1, stride: 4, big_endian: false };
        Number::U8.decode_cells(&rows, cells, &mut values);
        Number::U8.decode_cells(&rows, Cells { components: 2, ..cells }, &mut values);
        Number::U16.decode_cells(&rows, Cells { at: 2, big_endian: true, ..cells }, &mut values);
        let expected =
            [1, 5, 9, 1, 2, 5, 6, 9, 10, 0x0203, 0x0607, 0x0a0b].map(|value: u16| f32::from(value));
        assert_eq!(values, expected);
        // An incomplete row at the end is ignored.
        assert_eq!(Number::U16.decode::<f64>(&rows[..3], false), [256.0]);
    }

    #[test]
    fn words_outside_the_range_of_a_type_are_refused() {
        assert_eq!(Number::U8.parse::<f64>("255"), Some(255.0));
        assert_eq!(Number::U8.parse::<f64>("256"), None);
        assert_eq!(Number::I32.parse::<f64>("-1e3"), Some(-1000.0));
        assert_eq!(Number::I32.parse::<f64>("0.5"), None);
        assert_eq!(Number::U32.parse::<f64>("4294967295"), Some(u32::MAX.into()));
        assert_eq!(Number::U32.parse::<f64>("-1"), None);
        // The word is parsed as f32 directly. Rounding to f64 first would give a neighbouring f32.
        let word = "1.00000017881393432617187499";
        assert_eq!(Number::F32.parse::<f32>(word), word.parse().ok());
        assert_eq!(Number::F32.parse::<f32>("nan").map(f32::is_nan), Some(true));
        assert_eq!(Number::F64.parse::<f64>("water"), None);
    }
}
