//! Values and their 64-bit representations in the file.

/// A value.
#[derive(Debug, Clone)]
pub(super) enum Value {
    Bool(bool),
    Float(f32),
    Double(f64),
    Token(String),
    String(String),
    Float2([f32; 2]),
    Float3([f32; 3]),
    /// x, y, z, w.
    Quaternion([f32; 4]),
    /// A value of the enumeration with this type, such as [`Value::DEF`].
    Word(Type, u32),
    Floats(Vec<f32>),
    Vectors(Vec<[f32; 3]>),
    Integers(Vec<i32>),
    /// The number 3, this often.
    Threes(usize),
    /// An array of the type `token[]`.
    Tokens(Vec<String>),
    /// A list of names, in the fields of the format itself.
    Names(Vec<String>),
    /// Names that come before those of weaker files.
    Prepended(Vec<String>),
    /// The paths of the targets of a relationship or connection.
    Targets(Vec<String>),
    /// Times, and the representations of the values at these.
    Samples(Vec<(f64, Rep)>),
}

impl Value {
    /// A new object.
    pub(super) const DEF: Self = Self::Word(Type::Specifier, 0);
    /// An attribute that is constant in time.
    pub(super) const UNIFORM: Self = Self::Word(Type::Variability, 1);

    pub(super) fn token(word: &str) -> Self {
        Self::Token(word.to_owned())
    }
}

/// The types of values, with their numbers in the format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub(super) enum Type {
    Bool = 1,
    Int = 3,
    Int64 = 5,
    Float = 8,
    Double = 9,
    String = 10,
    Token = 11,
    Quatf = 17,
    Vec2f = 20,
    Vec3f = 24,
    TokenListOp = 32,
    PathListOp = 34,
    TokenVector = 41,
    Specifier = 42,
    Variability = 44,
    TimeSamples = 46,
    DoubleVector = 48,
}

/// The representation of a value: its type, how it is stored, and itself or its offset in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Rep(pub(super) u64);

impl Rep {
    const ARRAY: u64 = 1 << 63;
    const INLINED: u64 = 1 << 62;
    const COMPRESSED: u64 = 1 << 61;

    /// A value of at most 32 bits.
    pub(super) fn inlined(kind: Type, value: u32) -> Self {
        Self(Self::INLINED | u64::from(kind as u8) << 48 | u64::from(value))
    }

    /// A value at an offset.
    pub(super) fn at(kind: Type, offset: u64) -> Self {
        Self(u64::from(kind as u8) << 48 | offset)
    }

    /// An array at an offset; an empty one at offset zero.
    pub(super) fn array(kind: Type, offset: u64) -> Self {
        Self(Self::ARRAY | Self::at(kind, offset).0)
    }

    /// A compressed array of integers.
    pub(super) fn compressed(kind: Type, offset: u64) -> Self {
        Self(Self::COMPRESSED | Self::array(kind, offset).0)
    }
}
