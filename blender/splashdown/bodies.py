"""Shows the bodies of a run: their meshes move as their tables say."""

import bpy
import numpy as np

from . import materials, motion, playback, show
from .core import axes, ply


def move_obstacles(run, obstacles, start_frame, frame_interval, metres_per_unit):
    """Moves obstacles, a dictionary of objects and names in the run, as the bodies of a run. Returns problems as texts."""
    places, problems = playback.run_folder(bpy.path.abspath(run)).bodies(obstacles.values())
    for obj, name in obstacles.items():
        if name in places:
            motion.apply(obj, places[name], start_frame, frame_interval, metres_per_unit)
    return problems


def show_bodies(scene, run, *, name, start_frame, frame_interval, metres_per_unit, up="Y", colours=None):
    """Moves the obstacles of the scene that belong to a run, and makes an object with the mesh of each of its other bodies.

    `run`: path as it is saved. `name`: of the run, for new objects. `colours`: of the bodies that the scene file names,
    linear RGB in [0, 1] or `None`. Returns problems as texts.
    """
    colours = colours or {}
    folder = playback.run_folder(bpy.path.abspath(run))
    # The scene file may have changed since the run.
    places, problems = folder.bodies(colours if folder.body_names() is None else ())
    obstacles = _obstacles(scene, run, places)
    for body, rows in places.items():
        obj = obstacles.get(body)
        if obj is not None and obj.splashdown.motion != "DYNAMIC":
            continue
        if obj is None:
            obj, problem = _body_object(scene, folder, run, name, body, metres_per_unit, up)
            problems += problem
            if obj.type == "MESH" and not obj.data.materials:
                obj.data.materials.append(materials.body(colours.get(body)))
        motion.apply(obj, _changes(rows), start_frame, frame_interval, metres_per_unit, up)
    return problems


def _obstacles(scene, run, names):
    """The obstacles of the scene that are bodies of this run, by their names in it."""
    found = {}
    for obj in scene.objects:
        own = obj.splashdown
        if own.role == "OBSTACLE" and own.body_name in names and playback.same_folder(own.body_run, run):
            found[own.body_name] = obj
    return found


def _changes(rows):
    """The rows without those of a body at rest between two equal rows."""
    same = [one[1:] == other[1:] for one, other in zip(rows, rows[1:])]
    inner = [not (before and after) for before, after in zip(same, same[1:])]
    kept = [True, *inner, True][: len(rows)]
    return [row for row, keep in zip(rows, kept) if keep]


def _body_object(scene, folder, run, name, body, metres_per_unit, up):
    """The object that shows a body, with its mesh, and problems as texts. Without a mesh it is an empty."""
    problems = []
    try:
        frame = ply.read(folder.body_mesh(body))
    except ply.FrameError as error:
        frame = None
        problems.append(f"{body}.ply in bodies cannot be read ({error}): the body is shown as an empty")
    obj = _find(scene, run, body)
    if obj is not None and obj.type == "EMPTY" and frame is not None:
        # Of a run that had no meshes.
        bpy.data.objects.remove(obj)
        obj = None
    if obj is None:
        full = f"{name} {body}"
        obj = bpy.data.objects.new(full, bpy.data.meshes.new(full) if frame is not None else None)
        if frame is None:
            obj.empty_display_type = "ARROWS"
        show.collection(scene, name).objects.link(obj)
    cache = obj.splashdown_cache
    cache.run, cache.body, cache.up, cache.metres_per_unit = run, body, up, metres_per_unit
    if frame is not None and obj.type == "MESH" and not obj.data.is_editmode:
        vertices = axes.to_blender(frame.positions, up) / np.float32(metres_per_unit)
        playback.fill_triangles(obj.data, vertices, frame.triangles, is_smooth=False)
        obj.data.update(calc_edges=True)
    return obj, problems


def _find(scene, run, body):
    for obj in scene.objects:
        cache = obj.splashdown_cache
        is_ours = obj.type in ("EMPTY", "MESH") and cache.series == "NONE" and cache.body == body
        if is_ours and playback.same_folder(cache.run, run):
            return obj
    return None
