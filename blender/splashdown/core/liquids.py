"""Liquids: properties of flow for the program, and optical ones for Blender's materials.

The names are those of the key `material` of scene files. The optical properties are those with which the program
draws these liquids.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Liquid:
    """`density`: kg/m^3. `viscosity`: kinematic, m^2/s. `surface_tension`: N/m. `absorption`: of red, green and blue
    light, 1/m. All at 20 degrees Celsius."""

    label: str
    density: float
    viscosity: float
    surface_tension: float
    absorption: tuple
    refractive_index: float


LIQUIDS = {
    "water": Liquid("Water", 998.2, 1.0034e-6, 0.07274, (0.264, 0.0565, 0.0101), 1.333),
    "oil": Liquid("Olive oil", 913.7, 9.19e-5, 0.032, (0.6, 2.2, 18.0), 1.47),
    "glycerin": Liquid("Glycerin", 1261.0, 1.1197e-3, 0.0634, (0.30, 0.12, 0.10), 1.473),
    "honey": Liquid("Honey", 1423.0, 1.335e-2, 0.060, (2.5, 14.0, 80.0), 1.49),
}
