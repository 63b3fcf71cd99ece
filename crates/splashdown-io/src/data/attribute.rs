//! Attributes of particles or vertices that have no field of their own.

use crate::error::IoError;

/// One number or vector per particle or vertex, with its name in a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Attribute {
    /// Its name.
    pub name: String,
    /// Numbers per particle or vertex: 1 (a scalar) or 3 (a vector).
    pub components: usize,
    /// The numbers; those of one particle or vertex are adjacent.
    pub values: Vec<f32>,
}

impl Attribute {
    /// Whether it is the velocity, for which particles and meshes have a field.
    #[must_use]
    pub fn is_velocity(&self) -> bool {
        super::columns::Column::named(&self.name, self.components) == Some(super::columns::Column::Velocity)
    }

    /// Whether it is the id of the particles.
    #[must_use]
    pub fn is_id(&self) -> bool {
        super::columns::Column::named(&self.name, self.components) == Some(super::columns::Column::Id)
    }

    /// Checks that there are 1 or 3 numbers for each of `expected` owners.
    pub(crate) fn check(&self, expected: usize, owner: &'static str) -> Result<(), IoError> {
        let given = self.values.len() / self.components.max(1);
        if matches!(self.components, 1 | 3) && self.values.len() == expected * self.components {
            return Ok(());
        }
        Err(IoError::Length { attribute: self.name.clone(), given, expected, owner })
    }

    /// Its name as one word, as required in file headers.
    pub(crate) fn word(&self) -> String {
        let clean = |c: char| if c.is_whitespace() || c.is_control() { '_' } else { c };
        match self.name.trim() {
            "" => "attribute".to_owned(),
            name => name.chars().map(clean).collect(),
        }
    }
}
