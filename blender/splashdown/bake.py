"""Bakes in Blender: copies the settings, watches the program with a timer, and shows the frames.

A timer of the application, not a modal operator: Blender does not save automatically while one of these is active.
"""

import time
from pathlib import Path

import bpy

from . import bodies, collect, motion, playback, preferences, show
from .core import program, scene as core
from .core.run_folder import DIFFUSE, scene_of
from .core.simulation import Failed, Simulation, refuse_resume

# Seconds between two looks at the output of the program.
INTERVAL = 0.2
# How often a bake without the interface looks, in seconds.
WAITING = 0.02
# How long the program may take to write its last frame when Blender quits, in seconds.
QUIT_LIMIT = 5.0

# The bake that runs or ran last in this session, and why the last one did not start.
current = None
refusal = ""


class Bake(Simulation):
    """One bake of a scene. Everything it needs is copied at the start: undo may replace the scene and its objects."""

    def __init__(self, context, resume=False, only_check=False):
        """Starts the program. Raises [`Failed`]."""
        scene = context.scene
        settings = scene.splashdown
        self.scene_id, self.name = playback.identity(scene), scene.name
        self.start_frame, self.metres_per_unit = scene.frame_start, collect.metres_per_unit(scene)
        # The names in the run of the obstacles, by identity, and the identities of those that the fluid moves.
        self.bodies, self.floating = {}, set()
        try:
            found = preferences.find_program()
            program.require(found)
        except program.ProgramError as error:
            raise Failed(str(error)) from error
        folder = None if only_check else cache_folder(scene)
        common = {
            "device": settings.device,
            "checkpoint_every": settings.checkpoint_every,
            "limit": settings.max_particles * 1e6,
        }
        self.saved_run = None if folder is None else _saved_path(settings.cache_folder, folder)
        if resume:
            refuse_resume(folder / "run")
            values = scene_of(folder / "run")
            super().__init__(found, folder, **common, **self._settings_of_run(scene, values))
            self.resume()
            return
        described = collect.describe(context)
        if described.problems:
            raise Failed("\n".join(described.problems))
        whole = described.scene
        super().__init__(
            found,
            folder,
            **common,
            spacing=settings.particle_spacing,
            frame_rate=whole.frame_rate,
            names=core.names(whole),
        )
        self.liquid, self.use_foam = settings.material, settings.use_foam
        self.domain = (whole.domain.low, whole.domain.high)
        self.bodies, self.floating = described.bodies, described.floating
        for warning in described.warnings:
            self.warn(warning)
        self.refuse_too_many(core.particles(whole))
        self.check(core.files(whole))

    def _settings_of_run(self, scene, values):
        """Takes from a run what shows it; the settings of the scene may have changed since. Returns its frame rate and
        spacing. Raises [`Failed`]."""
        run = bpy.path.abspath(self.saved_run)
        try:
            settings = {
                "frame_rate": float(values["scene"]["frame_rate"]),
                "spacing": float(values["fluid"]["particle_spacing"]),
            }
            self.domain = tuple(tuple(map(float, values["domain"][key])) for key in ("min", "max"))
        except (KeyError, TypeError, ValueError) as error:
            raise Failed(f"The last checkpoint of {run} cannot be read. Bake instead.") from error
        self.liquid = values["fluid"].get("material", "custom")
        self.use_foam = bool(values.get("foam", {}).get("enabled"))
        surface = show.find(scene, run, "surface")
        if surface is not None:
            self.start_frame = surface.splashdown_cache.start_frame
        names = collect.body_names(scene)
        for obj in collect.objects_of(scene, "OBSTACLE"):
            own, key = obj.splashdown, playback.identity(obj)
            # An obstacle without a run: the file was not saved after the start of the bake.
            if not own.body_run or playback.same_folder(own.body_run, run):
                self.bodies[key] = own.body_name if own.body_run else names[key]
                if own.motion == "DYNAMIC":
                    self.floating.add(key)
        return settings

    def scene(self):
        """The scene of the bake; `None` if it was removed."""
        return next((scene for scene in bpy.data.scenes if playback.identity(scene) == self.scene_id), None)

    def update(self):
        going = super().update()
        if not going:
            playback.baked = None
        return going

    def on_started(self):
        playback.baked = str(self.run)
        self._show(self.scene())

    def on_frame(self):
        """Shows the frame. One that is already shown is not read again."""
        scene = self.scene()
        if scene is None:
            return
        if show.find(scene, self.run, "surface") is None:
            # Undo has removed it.
            self._show(scene)
        playback.load_all(scene)

    def on_end(self):
        """Shows the result again, because undo during the bake removes objects and keyframes."""
        scene = self.scene()
        if scene is None:
            return
        playback.baked = None
        self._show(scene)
        moved = {obj: self.bodies[key] for key, obj in self._obstacles(scene).items() if key in self.floating}
        for problem in bodies.move_obstacles(str(self.run), moved, self.start_frame, 1 / self.frame_rate, self.metres_per_unit):
            self.warn(problem)
        _push_undo()

    def _run_path(self):
        """The path of the run as it is saved. It is absolute if the file was saved in another folder meanwhile."""
        return self.saved_run if playback.same_folder(self.saved_run, self.run) else str(self.run)

    def _obstacles(self, scene):
        found = {playback.identity(obj): obj for obj in scene.objects}
        return {key: found[key] for key in self.bodies if key in found}

    def _show(self, scene):
        if scene is None:
            return
        run = self._run_path()
        for key, obj in self._obstacles(scene).items():
            obj.splashdown.body_name, obj.splashdown.body_run = self.bodies[key], run
        show.show(
            scene,
            run,
            ["surface", "droplets", *(DIFFUSE if self.use_foam else ())],
            name=self.name,
            start_frame=self.start_frame,
            frame_interval=1 / self.frame_rate,
            spacing=self.spacing,
            metres_per_unit=self.metres_per_unit,
            liquid=self.liquid,
            domain=self.domain,
        )


def _push_undo():
    """Makes the result a step of its own, so that the next undo does not remove it with the step before."""
    for window in bpy.context.window_manager.windows:
        with bpy.context.temp_override(window=window):
            if bpy.ops.ed.undo_push.poll():
                bpy.ops.ed.undo_push(message="Splashdown Bake")
        return


def _saved_path(given, folder):
    """The path of the run, relative to the .blend file if the cache folder is."""
    if not given.startswith("//"):
        return str(folder / "run")
    return f"{given}run" if given.endswith(("/", "\\")) else f"{given}/run"


def cache_folder(scene):
    """The absolute path of the cache. Raises [`Failed`] if it is relative to a file that has not been saved."""
    given = scene.splashdown.cache_folder
    if not given:
        raise Failed("Choose a cache folder.")
    if given.startswith("//") and not bpy.data.filepath:
        raise Failed("Save the .blend file first, or choose an absolute cache folder: the present one is relative to the file.")
    return Path(bpy.path.abspath(given)).expanduser().absolute()


def active():
    return current is not None and current.is_active


def start(context, **options):
    """Starts a bake and the timer that watches it. Raises [`Failed`]."""
    global current, refusal
    if active():
        raise Failed("A bake is in progress. Cancel it first.")
    current, refusal = None, ""
    try:
        current = Bake(context, **options)
    except Failed as error:
        refusal = str(error)
        raise
    if not bpy.app.background:
        bpy.app.timers.register(_tick, first_interval=INTERVAL, persistent=True)
    return current


def finish():
    """Waits for the end of the bake, for scripts and renders without an interface."""
    last = None
    while current.update():
        if current.frame != last and current.frames:
            last = current.frame
            print(f"Splashdown: {current.text()}")
        time.sleep(WAITING)
    return current


def _tick():
    if current is None:
        return None
    # The handlers of an animation render change the same meshes.
    if playback.is_rendering():
        return INTERVAL
    going = current.update()
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
    return INTERVAL if going else None


def _report(operator, error):
    for line in str(error).splitlines():
        operator.report({"ERROR"}, line)
    return {"CANCELLED"}


class _Starts(bpy.types.Operator):
    """An operator that starts the program. From scripts and in the background it waits for the end."""

    how = {}

    @classmethod
    def poll(cls, _context):
        return not active()

    def invoke(self, context, _event):
        try:
            start(context, **self.how)
        except Failed as error:
            return _report(self, error)
        return {"FINISHED"}

    def execute(self, context):
        try:
            start(context, **self.how)
        except Failed as error:
            return _report(self, error)
        if not bpy.app.background:
            return {"FINISHED"}
        bake = finish()
        if bake.state == "FAILED":
            return _report(self, "\n".join(bake.messages))
        for message in bake.messages:
            self.report({"WARNING"}, message)
        self.report({"INFO"}, bake.text())
        return {"FINISHED"}


class SPLASHDOWN_OT_bake(_Starts):
    """Simulate the scene. Frames of the earlier bake in the cache folder are replaced"""

    bl_idname = "splashdown.bake"
    bl_label = "Bake"


class SPLASHDOWN_OT_resume(_Starts):
    """Continue an interrupted bake with its own scene and settings"""

    bl_idname = "splashdown.resume"
    bl_label = "Resume"
    how = {"resume": True}


class SPLASHDOWN_OT_check(_Starts):
    """Check the scene and estimate particles, memory and time without simulating"""

    bl_idname = "splashdown.check"
    bl_label = "Check"
    how = {"only_check": True}


class SPLASHDOWN_OT_cancel(bpy.types.Operator):
    """Stop after the present frame. Complete frames remain, and the bake can be resumed. A second click stops at once"""

    bl_idname = "splashdown.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, _context):
        return active()

    def execute(self, _context):
        current.cancel()
        return {"FINISHED"}


class SPLASHDOWN_OT_restore(bpy.types.Operator):
    """Remove the keyframes of the bake from obstacles that the fluid moved, and bring their poses from before back"""

    bl_idname = "splashdown.restore"
    bl_label = "Restore Obstacles"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        for obj in context.scene.objects:
            motion.restore(obj)
        return {"FINISHED"}


@bpy.app.handlers.persistent
def _before_load(_path=None):
    _leave()


def _leave(seconds=0.0):
    global current, refusal
    if current is not None:
        current.abandon(seconds)
    current, refusal = None, ""


CLASSES = (SPLASHDOWN_OT_bake, SPLASHDOWN_OT_resume, SPLASHDOWN_OT_check, SPLASHDOWN_OT_cancel, SPLASHDOWN_OT_restore)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.app.handlers.load_pre.append(_before_load)


def unregister():
    # Blender disables extensions when it quits.
    _leave(QUIT_LIMIT)
    bpy.app.handlers.load_pre.remove(_before_load)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
