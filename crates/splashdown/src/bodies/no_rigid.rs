//! What stands in for `rigid` in a build without it. No value of [`Rigid`] exists, because a scene with a dynamic
//! body is an error there.

use serde::{Deserialize, Serialize};

use super::load::LoadedBody;
use super::types::Body;
use crate::scene::Domain;

/// Collisions, which this build leaves out.
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
    pub fn place(&mut self, _: &[Body]) {
        match *self {}
    }
}
