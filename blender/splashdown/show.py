"""Makes the objects that show a run."""

import bpy

from . import materials, motion, playback, points
from .core.run_folder import DIFFUSE

# Radius of foam, spray and bubbles, and overlap of the surface with the walls, in particle spacings.
DIFFUSE_RADIUS = 0.08
WALL_OVERLAP = 0.05


def _find(scene, run, series):
    absolute = bpy.path.abspath(run)
    for obj in playback.shown_objects(scene):
        if obj.splashdown_cache.series == series and playback.folder_of(obj) == absolute:
            return obj
    return None


def _collection(scene, name):
    full = f"Splashdown {name}"
    made = bpy.data.collections.get(full) or bpy.data.collections.new(full)
    if made.name not in scene.collection.children:
        scene.collection.children.link(made)
    return made


def show(scene, run, series, *, name, start_frame, frame_interval, spacing, metres_per_unit, liquid, domain=None):
    """Makes or updates the objects that show the `series` of a run, and returns them.

    `run`: path as it is saved. `frame_interval`: s. `spacing`: particle spacing, m. `domain`: lower and upper corner in m
    in the axes of the program. The objects of an earlier call keep their materials.
    """
    shown = []
    for part in series:
        obj = _find(scene, run, part)
        if obj is None:
            obj = bpy.data.objects.new(f"{name} {part}", bpy.data.meshes.new(f"{name} {part}"))
            _collection(scene, name).objects.link(obj)
        cache = obj.splashdown_cache
        cache.run, cache.series, cache.note = run, part, ""
        cache.start_frame, cache.frame_interval = start_frame, frame_interval
        cache.metres_per_unit = metres_per_unit
        cache.radius = spacing * (DIFFUSE_RADIUS if part in DIFFUSE else 0.5)
        if domain is not None:
            cache.wall_low, cache.wall_high = domain
        cache.wall_overlap = WALL_OVERLAP * spacing if domain is not None and part == "surface" else 0.0
        if part == "surface":
            if not obj.data.materials:
                obj.data.materials.append(materials.liquid(liquid, metres_per_unit))
        elif part in DIFFUSE:
            points.add_to(obj, materials.foam())
        else:
            points.add_to(obj, materials.liquid(liquid, metres_per_unit, with_volume=False))
        shown.append(obj)
    # Without this, drawing the viewport during a render could read a mesh that is being replaced.
    scene.render.use_lock_interface = True
    if playback.run_folder(bpy.path.abspath(run)).main_series() is None:
        # A bake starts: nothing of the earlier one is left.
        for obj in shown:
            obj.data.clear_geometry()
            obj.data["splashdown_frame"] = ""
    playback.load_all(scene, force=True)
    return shown


def move_bodies(scene, run_path, start_frame, frame_interval, metres_per_unit, empties=None):
    """Moves objects as the bodies of a run.

    An obstacle that the fluid moves takes the body that its name in the run gives. With `empties`, a name, a body
    without such an obstacle gets an empty in the collection of that name. Returns problems as texts.
    """
    run = playback.run_folder(run_path)
    places, problems = run.bodies()
    for name, rows in places.items():
        matching = [
            obj
            for obj in scene.objects
            if obj.splashdown.role == "OBSTACLE" and obj.splashdown.body_name == name
        ]
        if matching and matching[0].splashdown.motion == "DYNAMIC":
            motion.remember(matching[0])
            motion.apply(matching[0], rows, start_frame, frame_interval, metres_per_unit)
        elif not matching and empties is not None:
            label = f"{empties} {name}"
            obj = bpy.data.objects.get(label) or bpy.data.objects.new(label, None)
            obj.empty_display_type = "ARROWS"
            if obj.name not in scene.objects:
                _collection(scene, empties).objects.link(obj)
            motion.apply(obj, rows, start_frame, frame_interval, metres_per_unit)
    return problems
