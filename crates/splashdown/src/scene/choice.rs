//! Enums that are words in a scene file. One declaration defines the enum, its words, their descriptions and
//! the conversions.

/// A value that is written as one of a few words in a scene file.
pub trait Choice: Copy + 'static {
    /// Every variant with its word and its description, in the order in which messages list them.
    const ALL: &'static [(Self, &'static str, &'static str)];

    /// The word in the scene file.
    fn name(self) -> &'static str;

    /// The variant with this word; `None` if there is none.
    fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, word, _)| *word == name).map(|(value, ..)| *value)
    }
}

/// Declares enums whose variants are words of the scene file. The doc comment of a variant is also its
/// description in the schema.
macro_rules! choices {
    ($(
        $(#[doc = $doc:literal])+
        $name:ident { $( $(#[doc = $about:literal])+ $variant:ident = $word:literal, )+ }
    )+) => {$(
        $(#[doc = $doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum $name { $( $(#[doc = $about])+ $variant, )+ }

        impl $crate::scene::Choice for $name {
            const ALL: &'static [(Self, &'static str, &'static str)] =
                &[ $( (Self::$variant, $word, concat!($($about),+)), )+ ];

            fn name(self) -> &'static str {
                match self { $( Self::$variant => $word, )+ }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str($crate::scene::Choice::name(*self))
            }
        }

        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str($crate::scene::Choice::name(*self))
            }
        }
    )+};
}
pub(crate) use choices;
