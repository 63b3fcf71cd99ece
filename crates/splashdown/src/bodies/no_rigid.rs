//! Replaces `rigid` in a build without the Cargo feature `rigid`. No value of [`Rigid`] exists, because a scene with
//! a dynamic body is an error in such a build.

use serde::{Deserialize, Serialize};

use super::load::LoadedBody;
use super::types::{Body, Support};
use crate::scene::Domain;

/// Collisions, which this build does not support.
#[derive(Serialize, Deserialize)]
pub(crate) enum Rigid {}

impl Rigid {
    /// Always `None`.
    pub fn new(_: &[LoadedBody], _: &[Body], _: &Domain) -> Option<Self> {
        None
    }

    /// Never called: there is no value.
    pub fn resolve(&mut self, _: &mut [Body], _: f32) -> bool {
        match *self {}
    }

    /// Never called: there is no value.
    pub fn supports(&self, _: &[Body]) -> Vec<Support> {
        match *self {}
    }

    /// Never called: there is no value.
    pub fn place(&mut self, _: &[Body]) {
        match *self {}
    }
}
