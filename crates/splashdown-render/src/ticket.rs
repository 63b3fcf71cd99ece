//! The ticket of a submitted picture.

/// Identifies a submitted picture, which is collected with it.
#[derive(Debug, PartialEq, Eq)]
#[must_use = "a picture that is not collected continues to count as in flight"]
pub struct Ticket {
    pub(crate) target: u64,
    pub(crate) number: u64,
}
