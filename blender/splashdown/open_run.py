"""Opens the folder of an existing run."""

import tomllib
from pathlib import Path

import bpy
import numpy as np
from bpy.props import BoolProperty, StringProperty

from . import collect, playback, show
from .core import ply
from .core.run_folder import RunFolder

# Droplets are spheres with the volume of a particle, so many spacings wide.
DROPLET_WIDTH = 1.24


def open_run(scene, path, fit_frames=True):
    """Shows the run in the folder `path` from the first frame of the scene on.

    `fit_frames`: sets the end of the scene to the last frame of the run. Returns the objects and problems as texts; no
    objects if the folder has no frames that can be read.
    """
    run = RunFolder(bpy.path.abspath(path))
    problems = run.problems()
    series = run.present()
    if not series:
        return [], problems
    interval = run.frame_interval()
    if interval is None:
        interval = scene.render.fps_base / scene.render.fps
        problems.append("The time between frames is unknown: one frame of the scene is assumed")
    spacing = run.particle_spacing()
    if spacing is None:
        spacing = _spacing_of_droplets(run) or 0.01 * _extent(run)
        problems.append(f"The particle spacing is unknown: {spacing:.3g} m is assumed for the size of points")
    description = scene_file(run)
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
    )
    problems += show.show_bodies(scene, path, name, scene.frame_start, interval, unit)
    if fit_frames:
        scene.frame_end = scene.frame_start + run.last()
    for problem in problems:
        playback.note(shown[0], problem)
    return shown, problems


def scene_file(run):
    """The scene file that `run.json` names, as a dictionary; empty if it is missing or is not the one of the run."""
    name = run.report.get("file")
    if not isinstance(name, str):
        return {}
    for path in (run.path.parent / Path(name).name, Path(name)):
        try:
            values = tomllib.loads(path.read_text("utf-8"))
        except (OSError, ValueError):
            continue
        if _word(values, "scene", "name") == run.report.get("scene"):
            return values
    return {}


def _word(values, section, key):
    part = values.get(section)
    value = part.get(key) if isinstance(part, dict) else None
    return value if isinstance(value, str) else None


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

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        if not self.directory:
            self.report({"ERROR"}, "Choose the folder of a run")
            return {"CANCELLED"}
        path = self.directory.rstrip("/\\") or self.directory
        shown, problems = open_run(context.scene, path, self.fit_frames)
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
