"""What the user sets: the simulation on the scene, roles on objects, and the run that an object shows."""

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

from .core.axes import SIDES, TURNS
from .core.liquids import LIQUIDS
from .core.run_folder import SERIES

ROLES = (
    ("NONE", "None", "No part in the simulation"),
    ("DOMAIN", "Domain", "The box that contains the fluid; one per scene"),
    ("FLUID", "Fluid", "A closed mesh that is filled with fluid at the start"),
    ("OBSTACLE", "Obstacle", "A solid that the fluid meets"),
    ("EMITTER", "Emitter", "A flat mesh from which fluid flows along the normal of its faces"),
    ("OUTFLOW", "Outflow", "A closed mesh that removes fluid"),
)
MATERIALS = tuple(
    (name, liquid.label, f"{liquid.density:g} kg/m³, {liquid.viscosity:.3g} m²/s, {liquid.surface_tension:g} N/m")
    for name, liquid in LIQUIDS.items()
) + (("custom", "Custom", "Density, viscosity and surface tension of your own"),)
MOTIONS = (
    ("ANIMATED", "Animated or static", "The object moves as its animation in Blender, or rests"),
    ("DYNAMIC", "Moved by the fluid", "The fluid, gravity and collisions move the object"),
)
# Blender 4.5 and newer warn of paths that start with `//` unless a property says that it takes them.
RELATIVE = {"options": {"PATH_SUPPORTS_BLEND_RELATIVE"}} if bpy.app.version >= (4, 5, 0) else {}
# Roles whose objects are replaced by the result.
OUTLINES = {"DOMAIN", "FLUID", "EMITTER", "OUTFLOW"}


def _role_changed(self, _context):
    """Shows domain, fluid, emitters and outflows as outlines, and hides them from renders. Other roles bring the user's
    own settings back."""
    obj, outline = self.id_data, self.role in OUTLINES
    if outline and not self.is_outlined:
        self.own_display_type, self.own_hide_render = obj.display_type, obj.hide_render
        obj.display_type, obj.hide_render = "WIRE", True
    elif self.is_outlined and not outline:
        # What the user has changed since remains.
        if obj.display_type == "WIRE":
            obj.display_type = self.own_display_type
        if obj.hide_render:
            obj.hide_render = self.own_hide_render
    self.is_outlined = outline


def _start_changed(self, context):
    """Moves all series of a run together."""
    for obj in context.scene.objects:
        cache = obj.splashdown_cache
        if cache.series != "NONE" and cache.run == self.run and cache.start_frame != self.start_frame:
            cache.start_frame = self.start_frame


class SplashdownScene(bpy.types.PropertyGroup):
    """The settings of a simulation."""

    cache_folder: StringProperty(
        name="Cache",
        description="Folder for the scene file and the frames. `//` is the folder of the .blend file",
        default="//splashdown",
        subtype="DIR_PATH",
        **RELATIVE,
    )
    particle_spacing: FloatProperty(
        name="Particle spacing (m)",
        description="Distance of neighbouring particles: the resolution. Half of it means eight times the particles",
        default=0.02,
        min=1e-5,
        soft_min=0.001,
        max=10,
        precision=4,
        step=0.1,
    )
    material: EnumProperty(name="Liquid", description="Properties at 20 °C", items=MATERIALS, default="water")
    density: FloatProperty(name="Density (kg/m³)", default=998.2, min=1, max=30000, precision=1)
    viscosity: FloatProperty(
        name="Viscosity (m²/s)",
        description="Kinematic viscosity: the dynamic one divided by the density. Water has 0.000001",
        default=1e-6,
        min=0,
        max=100,
        precision=6,
    )
    surface_tension: FloatProperty(name="Surface tension (N/m)", default=0.0727, min=0, max=10, precision=4)
    use_surface_tension: BoolProperty(
        name="Surface tension",
        description="Simulate surface tension. It matters for drops and jets of a few centimetres, and takes time",
    )
    wall_friction: FloatProperty(
        name="Wall friction", description="0: the fluid slips along the walls; 1: it sticks", min=0, max=1
    )
    open_sides: EnumProperty(
        name="Open sides",
        description="Sides of the domain without a wall; fluid that leaves there is removed",
        items=[(name, label, f"The side at {label} is open") for name, _, label in SIDES],
        options={"ENUM_FLAG"},
    )
    time_scale: FloatProperty(
        name="Time scale",
        description="Simulated seconds per second of the film: 0.5 is slow motion at half the speed",
        default=1,
        min=0.001,
        soft_max=2,
        max=100,
    )
    use_foam: BoolProperty(name="Foam, spray and bubbles", description="Create them where the fluid breaks", default=True)
    smoothing: IntProperty(
        name="Smoothing", description="Iterations of smoothing of the surface", default=10, min=0, max=100, soft_max=25
    )
    use_anisotropic: BoolProperty(
        name="Smooth films and jets", description="Anisotropic kernels. The surface takes two to four times as long"
    )
    cell_ratio: FloatProperty(
        name="Cell size",
        description="Edge of the surface's cells divided by the particle spacing. Smaller cells mean larger files",
        default=0.5,
        min=0.2,
        max=1,
    )
    device: StringProperty(
        name="Device", description="auto, gpu, cpu, or a part of a name that `splashdown doctor` lists", default="auto"
    )
    checkpoint_every: IntProperty(
        name="Checkpoint every (frames)",
        description="How many frames may have to be computed again when the program is ended by force",
        default=10,
        min=1,
        max=100000,
    )
    max_particles: FloatProperty(
        name="Limit (million particles)",
        description="A bake with more particles is refused before it starts",
        default=5,
        min=0.001,
        max=1000,
    )


class SplashdownObject(bpy.types.PropertyGroup):
    """The role of an object."""

    role: EnumProperty(name="Role", items=ROLES, default="NONE", update=_role_changed)
    motion: EnumProperty(name="Motion", items=MOTIONS, default="ANIMATED")
    density: FloatProperty(name="Density (kg/m³)", default=500, min=1, soft_min=50, max=30000, precision=1)
    velocity: FloatVectorProperty(name="Velocity (m/s)", description="At the start, in the axes of the scene", size=3)
    friction: FloatProperty(name="Friction", description="0: the fluid slips along it; 1: it sticks", min=0, max=1)
    speed: FloatProperty(name="Speed (m/s)", description="Of the outflow", default=1, min=0.001, max=1000)
    start: FloatProperty(name="Start (s)", description="Simulated time", default=0, min=0, max=3600)
    use_end: BoolProperty(name="Ends", description="The emitter stops before the end of the simulation")
    end: FloatProperty(name="End (s)", description="Simulated time", default=1, min=0, max=3600)
    is_outlined: BoolProperty(options={"HIDDEN"})
    own_display_type: StringProperty(default="TEXTURED", options={"HIDDEN"})
    own_hide_render: BoolProperty(options={"HIDDEN"})
    body_name: StringProperty(name="Name in the run", options={"HIDDEN"})
    body_run: StringProperty(name="Run", subtype="DIR_PATH", options={"HIDDEN"} | RELATIVE.get("options", set()))
    has_rest: BoolProperty(name="Has keyframes of a bake", options={"HIDDEN"})
    rest_location: FloatVectorProperty(name="Location before the bake", size=3, options={"HIDDEN"})
    rest_mode: StringProperty(name="Rotation mode before the bake", default="XYZ", options={"HIDDEN"})
    rest_rotation: FloatVectorProperty(name="Rotation before the bake, in that mode", size=4, options={"HIDDEN"})


class SplashdownCache(bpy.types.PropertyGroup):
    """The series of files that an object shows. It is saved with the .blend file."""

    series: EnumProperty(
        name="Series", items=[("NONE", "None", "")] + [(series, series.capitalize(), "") for series in SERIES]
    )
    body: StringProperty(name="Body of the run that the object shows", options={"HIDDEN"})
    run: StringProperty(name="Run", description="Folder with `run.json`", subtype="DIR_PATH", **RELATIVE)
    start_frame: IntProperty(
        name="Start frame", description="The frame of Blender that shows frame 0 of the run", update=_start_changed
    )
    frame_interval: FloatProperty(name="Frame interval (s)", description="Simulated time between frames", min=0, precision=5)
    metres_per_unit: FloatProperty(name="Metres per unit", default=1, min=1e-6)
    up: EnumProperty(
        name="Up", description="The axis of the run that is up", items=[(up, up, "") for up in TURNS], options={"HIDDEN"}
    )
    radius: FloatProperty(name="Radius (m)", description="Of points whose files contain no width", min=0, precision=5)
    wall_low: FloatVectorProperty(size=3, description="Lower corner of the domain in m, y up")
    wall_high: FloatVectorProperty(size=3, description="Upper corner of the domain in m, y up")
    wall_overlap: FloatProperty(
        name="Wall overlap (m)",
        description="How far vertices on the sides of the domain are moved outwards, so that glass and floor that stand "
        "on these sides do not coincide with the surface",
        min=0,
        precision=5,
    )
    note: StringProperty(name="Problems", options={"HIDDEN"})


CLASSES = (SplashdownScene, SplashdownObject, SplashdownCache)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.splashdown = PointerProperty(type=SplashdownScene)
    bpy.types.Object.splashdown = PointerProperty(type=SplashdownObject)
    bpy.types.Object.splashdown_cache = PointerProperty(type=SplashdownCache)


def unregister():
    del bpy.types.Object.splashdown_cache
    del bpy.types.Object.splashdown
    del bpy.types.Scene.splashdown
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
