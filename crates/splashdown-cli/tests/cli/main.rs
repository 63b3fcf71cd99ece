//! The command line as a user sees it.

mod bad_input;
mod place;
mod runs;
mod words;
