//! NumPy arrays: views of Rust memory, and checked input.

mod input;
mod views;

pub use input::{Inputs, memory_of, vectors};
pub use views::{Owner, attributes_of, scalars_of, vectors_of};

use crate::errors::{ArrayError, Failure};

fn fail(message: String) -> Failure {
    ArrayError::new_err(message).into()
}
