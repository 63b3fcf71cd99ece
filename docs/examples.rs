//! The Rust examples of the documents are tests of this crate. It is no part of the library: a published crate
//! cannot include files from outside of its folder.

#[cfg(doctest)]
mod examples {
    #[doc = include_str!("../README.md")]
    struct Readme;

    #[doc = include_str!("guide/src/library.md")]
    struct Library;
}
