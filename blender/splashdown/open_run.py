"""Opens the folder of an existing run."""

import math
import tomllib
from pathlib import Path

import bpy
import numpy as np
from bpy.props import BoolProperty, StringProperty

from . import bodies, collect, playback, show
from .core import axes, ply
from .core.run_folder import RunFolder, scene_of, three_numbers
from .core.scene import HEADER

# Droplets are spheres with the volume of a particle, so many spacings wide.
DROPLET_WIDTH = 1.24


def open_run(scene, path, fit_frames=True, fit_rate=True):
    """Shows the run in the folder `path` from the first frame of the scene on.

    `fit_frames`: sets the end of the scene to the last frame of the run. `fit_rate`: sets the frame rate of the scene to
    that of the run, unless the scene shows another run or the extension has baked this one. Returns the objects and
    problems as texts; no objects if the folder has no frames that can be read.
    """
    run = RunFolder(bpy.path.abspath(path))
    problems = run.problems()
    series = run.present()
    if not series:
        return [], problems
    description, is_baked = scene_file(run)
    interval = run.frame_interval()
    if interval is not None and fit_rate and not is_baked and not _other_runs(scene, path):
        scene.render.fps, scene.render.fps_base = frame_rate(interval)
    if interval is None:
        interval = scene.render.fps_base / scene.render.fps
        problems.append("The time between frames is unknown: one frame of the scene is assumed")
    spacing = run.particle_spacing()
    if spacing is None:
        spacing = _spacing_of_droplets(run) or 0.01 * _extent(run)
        problems.append(f"The particle spacing is unknown: {spacing:.3g} m is assumed for the size of points")
    gravity = run.gravity() or three_numbers(_section(description, "scene").get("gravity"))
    # A bake has y up for any gravity.
    up = "Y" if is_baked or gravity is None else axes.up_of(gravity)
    unit = collect.metres_per_unit(scene)
    name = Path(run.path).name
    if name == "run":
        name = Path(run.path).parent.name
    shown = show.show(
        scene,
        path,
        series,
        name=name,
        start_frame=scene.frame_start,
        frame_interval=interval,
        spacing=spacing,
        metres_per_unit=unit,
        liquid=_word(description, "fluid", "material") or "water",
        domain=_walls(description),
        up=up,
    )
    problems += bodies.show_bodies(
        scene,
        path,
        name=name,
        start_frame=scene.frame_start,
        frame_interval=interval,
        metres_per_unit=unit,
        up=up,
        colours=_colours(description),
    )
    if fit_frames:
        scene.frame_end = scene.frame_start + run.last()
    for problem in problems:
        playback.note(shown[0], problem)
    return shown, problems


def frame_rate(interval):
    """The settings `fps` and `fps_base` of Blender for a time between frames in s."""
    fps = max(1, min(32767, math.ceil(1 / interval - 1e-3)))
    base = fps * interval
    return fps, 1.0 if abs(base - 1) < 1e-5 else base


def _other_runs(scene, path):
    """Whether the scene shows another run, which may have another frame rate."""
    return any(not playback.same_folder(obj.splashdown_cache.run, path) for obj in playback.shown_objects(scene))


def scene_file(run):
    """The scene file that `run.json` names, as a dictionary, and whether the extension has written it. If it is missing or
    not the one of the run: the scene of the last checkpoint, or an empty dictionary."""
    name = run.report.get("file")
    for path in (run.path.parent / Path(name).name, Path(name)) if isinstance(name, str) else ():
        try:
            text = path.read_text("utf-8")
            values = tomllib.loads(text)
        except (OSError, ValueError):
            continue
        if _word(values, "scene", "name") == run.report.get("scene"):
            return values, text.startswith(HEADER)
    return scene_of(run.path), False


def _section(values, name):
    part = values.get(name)
    return part if isinstance(part, dict) else {}


def _word(values, section, key):
    value = _section(values, section).get(key)
    return value if isinstance(value, str) else None


def _colours(values):
    """The bodies of a scene file with their colours."""
    sections = values.get("body")
    sections = [part for part in sections if isinstance(part, dict)] if isinstance(sections, list) else []
    named = [part for part in sections if isinstance(part.get("name"), str)]
    return {part["name"]: three_numbers(part.get("colour", part.get("color"))) for part in named}


def _walls(values):
    domain = values.get("domain")
    try:
        low, high = (np.array(domain[key], float) for key in ("min", "max"))
    except (TypeError, KeyError, ValueError):
        return None
    # The surface of a shaken tank is in other places.
    if low.shape != (3,) or high.shape != (3,) or "oscillation" in domain:
        return None
    return low, high


def _first_readable(run, series):
    for number in sorted(run.frames[series]):
        try:
            frame = ply.read(run.frames[series][number])
        except ply.FrameError:
            continue
        if len(frame.positions):
            yield frame


def _spacing_of_droplets(run):
    for frame in _first_readable(run, "droplets"):
        if "width" in frame.values:
            return float(np.median(frame.values["width"])) / DROPLET_WIDTH
    return None


def _extent(run):
    for frame in _first_readable(run, run.main_series()):
        return float(np.linalg.norm(np.ptp(frame.positions, axis=0)))
    return 1.0


class SPLASHDOWN_OT_open_run(bpy.types.Operator):
    """Show the frames of a run of the program in this scene"""

    bl_idname = "splashdown.open_run"
    bl_label = "Open Run"
    bl_options = {"REGISTER", "UNDO"}

    directory: StringProperty(name="Folder", description="Folder with `run.json`", subtype="DIR_PATH")
    filter_folder: BoolProperty(default=True, options={"HIDDEN"})
    fit_frames: BoolProperty(name="Set end frame", description="Set the end of the scene to the last frame", default=True)
    fit_rate: BoolProperty(
        name="Set frame rate",
        description="Set the frame rate of the scene to that of the run, unless the scene shows another run",
        default=True,
    )

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        if not self.directory:
            self.report({"ERROR"}, "Choose the folder of a run")
            return {"CANCELLED"}
        path = self.directory.rstrip("/\\") or self.directory
        shown, problems = open_run(context.scene, path, self.fit_frames, self.fit_rate)
        if not shown:
            self.report({"ERROR"}, problems[0])
            return {"CANCELLED"}
        if problems:
            self.report({"WARNING"}, "; ".join(problems))
        return {"FINISHED"}


class SPLASHDOWN_OT_reload(bpy.types.Operator):
    """Read the present frame of all runs again"""

    bl_idname = "splashdown.reload"
    bl_label = "Reload"

    def execute(self, context):
        for obj in playback.shown_objects(context.scene):
            obj.splashdown_cache.note = ""
        playback.load_all(context.scene, force=True)
        return {"FINISHED"}


CLASSES = (SPLASHDOWN_OT_open_run, SPLASHDOWN_OT_reload)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
