//! Properties of liquids, measured at 20 °C and one atmosphere.

use super::types::Material;

/// A liquid that a scene file can name.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct KnownMaterial {
    /// Its name in the scene file.
    pub name: &'static str,
    /// A description for the schema.
    pub about: &'static str,
    /// Density in kg/m^3.
    pub rest_density: f32,
    /// Kinematic viscosity (dynamic viscosity over density) in m^2/s.
    pub viscosity: f32,
    /// Surface tension against air in N/m.
    pub surface_tension: f32,
}

impl KnownMaterial {
    /// The material of a scene with these properties.
    pub fn material(&self) -> Material {
        Material {
            name: self.name.to_owned(),
            rest_density: self.rest_density,
            viscosity: self.viscosity,
            surface_tension: self.surface_tension,
        }
    }
}

/// The liquids that a scene file can name. Sources:
///
/// | liquid | density | dynamic viscosity | surface tension |
/// |---|---|---|---|
/// | water | 998.2, IAPWS-95 | 1.0016 mPa s, IAPWS R12-08 | 72.74 mN/m, IAPWS R1-76(2014) |
/// | oil (olive) | 913.7, oil mill's table | 84.0 mPa s, CRC Handbook of Chemistry and Physics, "Viscosity of liquids" | 32 mN/m, Sahasrabudhe et al. 2017, rounded |
/// | glycerin (pure) | 1261 | 1.412 Pa s, Segur and Oberstar 1951 | 63.4 mN/m, Glycerine Producers' Association 1963 |
/// | honey (clover, 16 % water) | 1423 | 19.0 Pa s, Crane, *Honey* 1975, 20.6 °C | 60 mN/m, rounded: honeys differ by a fifth |
pub const MATERIALS: [KnownMaterial; 4] = [
    KnownMaterial {
        name: "water",
        about: "pure water",
        rest_density: 998.2,
        viscosity: 1.0034e-6,
        surface_tension: 0.07274,
    },
    KnownMaterial {
        name: "oil",
        about: "olive oil",
        rest_density: 913.7,
        viscosity: 9.19e-5,
        surface_tension: 0.032,
    },
    KnownMaterial {
        name: "glycerin",
        about: "pure glycerin",
        rest_density: 1261.0,
        viscosity: 1.1197e-3,
        surface_tension: 0.0634,
    },
    KnownMaterial {
        name: "honey",
        about: "clover honey with 16 % water",
        rest_density: 1423.0,
        viscosity: 1.335e-2,
        surface_tension: 0.06,
    },
];

impl Material {
    /// The liquid of this name from [`MATERIALS`].
    pub fn named(name: &str) -> Option<Self> {
        MATERIALS.iter().find(|known| known.name == name).map(Self::from)
    }

    /// Water at 20 °C, the default material of a scene.
    pub fn water() -> Self {
        Self::from(&MATERIALS[0])
    }
}

impl From<&KnownMaterial> for Material {
    fn from(known: &KnownMaterial) -> Self {
        Self {
            name: known.name.to_owned(),
            rest_density: known.rest_density,
            viscosity: known.viscosity,
            surface_tension: known.surface_tension,
        }
    }
}
