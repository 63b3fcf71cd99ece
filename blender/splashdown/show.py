"""Makes the objects that show a run."""

import bpy

from . import materials, playback, points

# Radii of foam in particle spacings, as in the program's pictures and USD files.
DIFFUSE_RADII = {"spray": 0.13, "foam": 0.25, "bubbles": 0.16}
# Radius of particles, and overlap of the surface with the walls, in particle spacings.
PARTICLE_RADIUS = 0.5
WALL_OVERLAP = 0.05


def find(scene, run, series):
    """The object that shows a series of a run; `None` if there is none."""
    for obj in playback.shown_objects(scene):
        cache = obj.splashdown_cache
        if cache.series == series and playback.same_folder(cache.run, run):
            return obj
    return None


def collection(scene, name):
    full = f"Splashdown {name}"
    made = bpy.data.collections.get(full) or bpy.data.collections.new(full)
    if made.name not in scene.collection.children:
        scene.collection.children.link(made)
    return made


def show(
    scene, run, series, *, name, start_frame, frame_interval, spacing, metres_per_unit, liquid, domain=None, up="Y"
):
    """Makes or updates the objects that show the `series` of a run, and returns them.

    `run`: path as it is saved. `frame_interval`: s. `spacing`: particle spacing, m. `domain`: lower and upper corner in m
    in the axes of the program. `up`: the axis of the program that is up. The objects of an earlier call keep their
    materials.
    """
    shown = []
    for part in series:
        obj = find(scene, run, part)
        if obj is None:
            obj = bpy.data.objects.new(f"{name} {part}", bpy.data.meshes.new(f"{name} {part}"))
            collection(scene, name).objects.link(obj)
        cache = obj.splashdown_cache
        cache.run, cache.series, cache.note = run, part, ""
        cache.start_frame, cache.frame_interval = start_frame, frame_interval
        cache.metres_per_unit, cache.up = metres_per_unit, up
        cache.radius = spacing * DIFFUSE_RADII.get(part, PARTICLE_RADIUS)
        if domain is not None:
            cache.wall_low, cache.wall_high = domain
        cache.wall_overlap = WALL_OVERLAP * spacing if domain is not None and part == "surface" else 0.0
        if part == "surface":
            _give_material(obj.data.materials, materials.liquid(liquid, metres_per_unit))
        elif part in DIFFUSE_RADII:
            points.add_to(obj, materials.foam())
        else:
            points.add_to(obj, materials.liquid(liquid, metres_per_unit, with_volume=False))
        shown.append(obj)
    # Without this, drawing the viewport during a render could read a mesh that is being replaced.
    scene.render.use_lock_interface = True
    if playback.run_folder(bpy.path.abspath(run)).main_series() is None:
        # A bake starts: nothing of the earlier one is left.
        for obj in shown:
            if obj.data.is_editmode:
                continue
            obj.data.clear_geometry()
            obj.data["splashdown_frame"] = ""
    playback.load_all(scene, force=True)
    return shown


def _give_material(slots, material):
    """Sets the material unless the user has chosen another one."""
    if not slots:
        slots.append(material)
    elif materials.is_ours(slots[0]):
        slots[0] = material
