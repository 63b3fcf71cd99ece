"""Makes the objects that show a run."""

import bpy

from . import materials, motion, playback, points
from .core.run_folder import DIFFUSE

# Radius of foam, spray and bubbles, and overlap of the surface with the walls, in particle spacings.
DIFFUSE_RADIUS = 0.08
WALL_OVERLAP = 0.05


def find(scene, run, series):
    """The object that shows a series of a run; `None` if there is none."""
    for obj in playback.shown_objects(scene):
        cache = obj.splashdown_cache
        if cache.series == series and playback.same_folder(cache.run, run):
            return obj
    return None


def _find_empty(scene, run, body):
    for obj in scene.objects:
        cache = obj.splashdown_cache
        if obj.type == "EMPTY" and cache.body == body and playback.same_folder(cache.run, run):
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
        obj = find(scene, run, part)
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
            _give_material(obj.data.materials, materials.liquid(liquid, metres_per_unit))
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


def move_bodies(run, obstacles, start_frame, frame_interval, metres_per_unit):
    """Moves obstacles, a dictionary of objects and names in the run, as the bodies of a run. Returns problems as texts."""
    places, problems = playback.run_folder(bpy.path.abspath(run)).bodies()
    for obj, name in obstacles.items():
        if name in places:
            motion.apply(obj, places[name], start_frame, frame_interval, metres_per_unit)
    return problems


def show_bodies(scene, run, name, start_frame, frame_interval, metres_per_unit):
    """Moves the obstacles of the scene that belong to a run, and makes an empty for each of its other bodies.

    `run`: path as it is saved. `name`: of the run, for new objects. Returns problems as texts.
    """
    places, problems = playback.run_folder(bpy.path.abspath(run)).bodies()
    obstacles = {}
    for obj in scene.objects:
        own = obj.splashdown
        if own.role == "OBSTACLE" and own.body_name in places and playback.same_folder(own.body_run, run):
            obstacles[own.body_name] = obj
    for body, rows in places.items():
        obj = obstacles.get(body)
        if obj is not None and obj.splashdown.motion != "DYNAMIC":
            continue
        if obj is None:
            obj = _find_empty(scene, run, body)
        if obj is None:
            obj = bpy.data.objects.new(f"{name} {body}", None)
            obj.empty_display_type = "ARROWS"
            obj.splashdown_cache.run, obj.splashdown_cache.body = run, body
            _collection(scene, name).objects.link(obj)
        motion.apply(obj, rows, start_frame, frame_interval, metres_per_unit)
    return problems
