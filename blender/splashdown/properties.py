"""Settings of objects and of the scene, in SI units."""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

# Newer versions of Blender warn about paths that start with // without this option.
RELATIVE = {"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (4, 5, 0) else set()

ROLES = [
    ("NONE", "None", "Not part of the simulation"),
    ("DOMAIN", "Domain", "Its bounding box is the tank"),
    ("FLUID", "Fluid", "A closed mesh that is filled with liquid at the start"),
    ("OBSTACLE", "Obstacle", "A solid. An animated one moves the liquid"),
]
LIQUIDS = [
    ("water", "Water", "Pure water at 20 °C"),
    ("oil", "Oil", "Olive oil at 20 °C"),
    ("glycerin", "Glycerin", "Pure glycerin at 20 °C"),
    ("honey", "Honey", "Clover honey at 20 °C"),
    ("custom", "Custom", "Density and viscosity as given here"),
]


class SplashdownObject(bpy.types.PropertyGroup):
    role: EnumProperty(name="Role", items=ROLES, default="NONE")
    velocity: FloatVectorProperty(
        name="Velocity", description="Velocity of the liquid at the start", subtype="VELOCITY", unit="VELOCITY"
    )
    friction: FloatProperty(
        name="Friction", description="0: the liquid slips along the obstacle; 1: it sticks", min=0, max=1
    )
    # Of objects that show a run.
    kind: StringProperty(options={"HIDDEN"})
    folder: StringProperty(options={"HIDDEN"} | RELATIVE, subtype="DIR_PATH")
    first_frame: IntProperty(
        name="First Frame", description="Frame of the timeline that shows frame 0 of the run", default=1
    )
    point_radius: FloatProperty(name="Point Radius", default=0.005, min=1e-6, unit="LENGTH")


class SplashdownScene(bpy.types.PropertyGroup):
    spacing: FloatProperty(
        name="Spacing",
        description="Distance between particles. Half of it takes eight times the particles",
        default=0.05, min=1e-5, max=10, precision=4, unit="LENGTH",
    )  # fmt: skip
    liquid: EnumProperty(name="Liquid", items=LIQUIDS, default="water")
    density: FloatProperty(name="Density", description="In kg/m^3", default=998, min=1, max=30000)
    viscosity: FloatProperty(
        name="Viscosity", description="Kinematic viscosity in m^2/s", default=1e-6, min=0, max=100, precision=7
    )
    has_foam: BoolProperty(name="Foam", description="Create foam, spray and bubbles", default=True)
    device: EnumProperty(
        name="Device",
        items=[
            ("auto", "Best", "The best GPU, else the CPU"),
            ("gpu", "GPU", "A GPU"),
            ("cpu", "CPU", "The CPU"),
        ],
    )
    cache: StringProperty(
        name="Cache", description="Folder of the scene and the frames", default="//splashdown", subtype="DIR_PATH",
        options={"ANIMATABLE"} | RELATIVE,
    )  # fmt: skip
    report: StringProperty(options={"HIDDEN", "SKIP_SAVE"})
    is_error: BoolProperty(options={"HIDDEN", "SKIP_SAVE"})
    progress: FloatProperty(options={"HIDDEN", "SKIP_SAVE"})


CLASSES = (SplashdownObject, SplashdownScene)


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)
    bpy.types.Object.splashdown = PointerProperty(type=SplashdownObject)
    bpy.types.Scene.splashdown = PointerProperty(type=SplashdownScene)


def unregister():
    del bpy.types.Scene.splashdown
    del bpy.types.Object.splashdown
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)
