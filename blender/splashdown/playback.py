"""Shows the frames of runs: before Blender evaluates a frame, objects with a series get its mesh or points.

Frames are read in `frame_change_pre`, so that playback, animation renders and motion blur see the mesh of the frame. The
times within a frame at which Cycles samples motion blur keep that mesh: its vertices have velocities. Outside renders a
time within a frame shows the frame before it. The datablocks are
saved with the .blend file, which therefore shows its last frame even without the extension.
"""

import contextlib
import os

import bpy
import numpy as np
from bpy.app.handlers import persistent

from .core import axes, ply
from .core.run_folder import RunFolder, unreadable

_suspended = 0
_rendering = False
# The index of a folder is read again when a subfolder has changed.
_folders = {}
_reported = set()
# The absolute path of the run that is being baked: it may have no frames yet.
baked = None


@contextlib.contextmanager
def suspended():
    """No frame is loaded within this context."""
    global _suspended
    _suspended += 1
    try:
        yield
    finally:
        _suspended -= 1


def folder_of(obj):
    """The absolute path of the run that an object shows."""
    return bpy.path.abspath(obj.splashdown_cache.run)


def identity(block):
    """A value that identifies a scene or an object also after undo, which replaces it."""
    return getattr(block, "session_uid", block.name)


def same_folder(one, other):
    """Whether two paths, which may be relative to the .blend file, name the same folder."""
    return os.path.normpath(bpy.path.abspath(str(one))) == os.path.normpath(bpy.path.abspath(str(other)))


def run_folder(path):
    """The [`RunFolder`] of a path, read again if files were added or removed."""
    names = ("", "mesh", "particles", "droplets")
    stamp = []
    for name in names:
        try:
            stamp.append(os.stat(os.path.join(path, name)).st_mtime_ns)
        except OSError:
            stamp.append(None)
    known = _folders.get(path)
    if known is None or known[0] != stamp:
        known = (stamp, RunFolder(path))
        _folders[path] = known
    return known[1]


def shown_objects(scene):
    return [obj for obj in scene.objects if obj.splashdown_cache.series != "NONE" and obj.type == "MESH"]


def note(obj, text):
    """Adds a problem to those that the panel shows. Returns whether it is new in this session."""
    cache = obj.splashdown_cache
    if text not in cache.note:
        cache.note = (cache.note + "\n" + text).strip()
    key = (folder_of(obj), text)
    is_new = key not in _reported
    _reported.add(key)
    return is_new


def report_once(obj, text):
    """Adds a problem to those that the panel shows, and prints it the first time."""
    if note(obj, text):
        print(f"Splashdown: {folder_of(obj)}: {text}")


def pace(obj, scene):
    """Simulated time over the time of the film."""
    return obj.splashdown_cache.frame_interval * scene.render.fps / scene.render.fps_base


def pace_text(obj, scene):
    """Compares the frame rates of a run and the scene."""
    run, film = 1 / obj.splashdown_cache.frame_interval, scene.render.fps / scene.render.fps_base
    speed = f"it plays at {pace(obj, scene):.3g} times its speed"
    return f"The run has {run:.4g} frames per second and the scene {film:.4g}: {speed}"


def holder(scene, obj):
    """The object with the surface or the particles of the run that an object shows. It holds the notes about its files."""
    for one in shown_objects(scene):
        cache = one.splashdown_cache
        if cache.series in ("surface", "particles") and same_folder(cache.run, obj.splashdown_cache.run):
            return one
    return obj


def _report_damage(obj, scene, run, number, error):
    """Reports a frame that cannot be read, in the words in which the opening of the run reports it."""
    series = obj.splashdown_cache.series
    text = run.damage(series).get(number) or unreadable([number], series, error)
    report_once(holder(scene, obj), text)


def load(obj, scene, force=False):
    """Gives an object the data of the present frame. Frames that are missing or cannot be read are replaced by the one
    before; nothing is shown before the first one. Without any frame the object stays as it is."""
    cache = obj.splashdown_cache
    # Blender refuses to change a mesh in Edit Mode, or would discard the change.
    if obj.data.is_editmode:
        return
    wanted = scene.frame_current - cache.start_frame
    path = folder_of(obj)
    run = run_folder(path)
    if run.main_series() is None:
        if baked is None or not same_folder(path, baked):
            report_once(obj, run.problems()[0])
        return
    # Droplets and foam of another frame would hang in the air.
    holds = cache.series in ("surface", "particles")
    number = wanted
    while True:
        found = run.at_or_before(cache.series, number) if holds or number in run.frames[cache.series] else None
        if found is None:
            key, frame = "", None
        else:
            number, path = found
            rate = pace(obj, scene) if number == wanted else 0.0
            try:
                key = f"{path}|{path.stat().st_mtime_ns}|{rate:.6g}|{cache.wall_overlap:.6g}"
                if not force and obj.data.get("splashdown_frame") == key:
                    return
                frame = ply.read(path)
            except (ply.FrameError, OSError) as error:
                _report_damage(obj, scene, run, number, error)
                number -= 1
                continue
        break
    if frame is None:
        if force or obj.data.get("splashdown_frame") != "" or len(obj.data.vertices):
            obj.data.clear_geometry()
            obj.data["splashdown_frame"] = ""
        return
    if cache.series == "surface":
        _fill_surface(obj.data, frame, cache, rate)
    else:
        _fill_points(obj.data, frame, cache, rate)
    obj.data["splashdown_frame"] = key


def _add_vector(mesh, name, values):
    attribute = mesh.attributes.new(name, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", np.ascontiguousarray(values, np.float32).ravel())


def _add_number(mesh, name, values):
    attribute = mesh.attributes.new(name, "FLOAT", "POINT")
    attribute.data.foreach_set("value", np.ascontiguousarray(values, np.float32))


def _fill_surface(mesh, frame, cache, rate):
    positions = frame.positions
    if cache.wall_overlap > 0:
        positions = beyond_walls(positions, cache.wall_low, cache.wall_high, cache.wall_overlap)
    unit = np.float32(cache.metres_per_unit)
    fill_triangles(mesh, axes.to_blender(positions, cache.up) / unit, frame.triangles, is_smooth=True)
    _add_vector(mesh, "velocity", axes.to_blender(frame.velocities(), cache.up) * np.float32(rate) / unit)
    mesh.update(calc_edges=True)


def fill_triangles(mesh, vertices, triangles, is_smooth):
    """Replaces the geometry of a mesh. `vertices`: shape (N, 3), float32, in the axes and units of Blender. `triangles`:
    shape (M, 3), int32. Update the mesh afterwards."""
    mesh.clear_geometry()
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", vertices.ravel())
    mesh.loops.add(triangles.size)
    mesh.loops.foreach_set("vertex_index", triangles.ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.full(len(triangles), is_smooth))


def beyond_walls(positions, low, high, overlap):
    """Positions, shape (N, 3), of which those on the sides of a box are moved outwards by `overlap` (m)."""
    low, high = np.asarray(low, np.float32), np.asarray(high, np.float32)
    near = np.float32(0.02 * overlap + 1e-6 * max(np.abs(low).max(), np.abs(high).max()))
    moved = positions.copy()
    moved[positions < low + near] -= np.float32(overlap)
    moved[positions > high - near] += np.float32(overlap)
    return moved


def _fill_points(mesh, frame, cache, rate):
    unit = np.float32(cache.metres_per_unit)
    count = len(frame.positions)
    mesh.clear_geometry()
    mesh.vertices.add(count)
    mesh.vertices.foreach_set("co", (axes.to_blender(frame.positions, cache.up) / unit).ravel())
    width = frame.values.get("width")
    radius = np.full(count, cache.radius, np.float32) if width is None else 0.5 * width
    _add_number(mesh, "radius", radius / unit)
    _add_vector(mesh, "velocity", axes.to_blender(frame.velocities(), cache.up) * np.float32(rate) / unit)
    if "lifetime" in frame.values:
        _add_number(mesh, "lifetime", frame.values["lifetime"])
    mesh.update()


def is_rendering():
    """Whether a render runs beside the interface."""
    return bpy.app.is_job_running("RENDER")


def load_all(scene, force=False):
    for obj in shown_objects(scene):
        load(obj, scene, force)


@persistent
def _on_frame(scene, _depsgraph=None):
    # A render visits times within a frame, and before it, for motion blur.
    if not _suspended and not (_rendering and scene.frame_subframe):
        load_all(scene)


@persistent
def _on_render_start(_scene=None, _depsgraph=None):
    global _rendering
    _rendering = True


@persistent
def _on_render_end(_scene=None, _depsgraph=None):
    global _rendering
    _rendering = False


@persistent
def _on_save(path=None, _more=None):
    """Makes relative paths absolute when the file is saved in another folder, because Blender does not adapt them."""
    if not path or not bpy.data.filepath or os.path.dirname(path) == os.path.dirname(bpy.data.filepath):
        return
    for obj in bpy.data.objects:
        if obj.library is None:
            for owner, name in ((obj.splashdown_cache, "run"), (obj.splashdown, "body_run")):
                saved = getattr(owner, name)
                if saved.startswith("//"):
                    setattr(owner, name, bpy.path.abspath(saved))


@persistent
def _on_load(_path=None):
    global _rendering
    _rendering = False
    _folders.clear()
    _reported.clear()
    for scene in bpy.data.scenes:
        load_all(scene)


_HANDLERS = (
    ("frame_change_pre", _on_frame),
    ("load_post", _on_load),
    ("save_pre", _on_save),
    ("render_pre", _on_render_start),
    ("render_post", _on_render_end),
    ("render_complete", _on_render_end),
    ("render_cancel", _on_render_end),
)


def register():
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister():
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
