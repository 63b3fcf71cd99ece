//! Random inputs for everything that reads files of other people: the readers of particles, meshes, pictures and
//! checkpoints, the parser of scenes, and formulas.
//!
//! *How it works.* Each [`Target`] has seeds (valid files). [`search`] changes them at random ([`mutate`]) and passes them
//! to the target. A panic, a slow input, and more memory than an input may use are findings. `cargo xtask fuzz` searches
//! for as long as requested; the tests search for a few seconds and repeat all earlier findings (`corpus`).
//!
//! *Why not libFuzzer:* `cargo-fuzz` needs a nightly compiler, and bolero needs one for coverage. On stable Rust both
//! would try random inputs too, without a measure of memory. Changes of valid files that know about numbers in text and
//! binary reach the code behind the headers.

pub mod memory;
pub mod mutate;
mod search;
pub mod seeds;
mod targets;

pub use search::{Finding, Outcome, replay, search};
pub use targets::{INPUT_LIMIT, Target, targets};
