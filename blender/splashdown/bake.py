"""Runs the program: check, then simulation, as a child process whose events a timer reads.

A timer of the application, not a modal operator: Blender does not save automatically while one of these is active.
"""

import atexit
import subprocess
import time
from pathlib import Path

import bpy

from . import collect, motion, playback, preferences, show
from .core import program, scene as core
from .core.job import Job
from .core.run_folder import DIFFUSE

# Seconds between two looks at the output of the program.
INTERVAL = 0.2
# How often a bake without the interface looks, in seconds.
WAITING = 0.02
# Warnings that are shown.
MOST_WARNINGS = 8

# The bake that runs or ran last in this session.
current = None


class Failed(Exception):
    """A bake that cannot start or has failed. The text is for the user."""


class Bake:
    """One bake. `state`: CHECKING, RUNNING, STOPPING, then CHECKED, FINISHED, STOPPED or FAILED."""

    def __init__(self, context, resume=False, only_check=False):
        """Writes the scene and starts the program. Raises [`Failed`]."""
        scene = context.scene
        settings = scene.splashdown
        self.scene_id = _identity(scene)
        # Copies, because undo may replace the scene during the bake.
        self.spacing, self.limit = settings.particle_spacing, settings.max_particles * 1e6
        self.device, self.checkpoint_every = settings.device, settings.checkpoint_every
        self.folder = cache_folder(scene)
        self.run = self.folder / "run"
        self.only_check = only_check
        self.messages, self.estimate = [], ""
        self.frame, self.frames, self.fraction = None, None, 0.0
        self.job = None
        self.started = time.monotonic()
        try:
            self.program = preferences.find_program()
        except program.ProgramError as error:
            raise Failed(str(error)) from error
        if resume:
            if not has_checkpoint(self.run):
                raise Failed(f"There is nothing to resume in {self.run}: it has no checkpoint. Bake instead.")
            self.frame_rate = collect.frame_rate(scene) / settings.time_scale
            self.domain = saved_walls(scene)
            self._start("RUNNING", ["run", "--resume", "run", *self._output()])
            return
        described, problems = collect.describe(context)
        if problems:
            raise Failed("\n".join(problems))
        self.frame_rate = described.frame_rate
        self.domain = (described.domain.low, described.domain.high)
        self._refuse_too_many(core.particles(described))
        self._write(core.files(described))
        self._start("CHECKING", ["check", "scene.toml", "--json", "--device", self.device])

    def _output(self):
        every = str(self.checkpoint_every)
        return ["--json", "--formats", "ply", "--no-pictures", "--no-film", "--checkpoint-every", every]

    def _refuse_too_many(self, particles):
        if particles > self.limit:
            raise Failed(
                f"About {particles:,} particles at a spacing of {self.spacing:g} m are more than the "
                f"limit of {int(self.limit):,}. Increase the spacing, or the limit if the device has the memory."
            )

    def _write(self, files):
        for name, data in files.items():
            path = self.folder / name
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
                # The program caches distance fields by the content of a mesh, not by its time.
                path.write_bytes(data)
            except OSError as error:
                raise Failed(f"{path} cannot be written: {error.strerror}. Choose another cache folder.") from error

    def _start(self, state, arguments):
        try:
            self.job = Job([self.program, *arguments], self.folder)
        except OSError as error:
            raise Failed(f"`{self.program}` cannot be started: {error}") from error
        self.state = state

    @property
    def is_active(self):
        return self.state in ("CHECKING", "RUNNING", "STOPPING")

    def scene(self):
        """The scene of the bake; `None` if it was removed."""
        return next((scene for scene in bpy.data.scenes if _identity(scene) == self.scene_id), None)

    def update(self):
        """Handles what the program has printed. Returns whether the bake goes on."""
        if not self.is_active:
            return False
        events, code = self.job.poll()
        for event in events:
            self._handle(event)
        if code is not None:
            self._ended(code)
            if not self.is_active:
                playback.baked = None
        return self.is_active

    def _handle(self, event):
        kind = event["event"]
        if kind == "check":
            self._checked(event)
        elif kind == "started":
            self.frames = event.get("frames")
            self.frame = event.get("frame")
            self._show()
        elif kind in ("progress", "frame"):
            if self.frames and isinstance(event.get("time"), (int, float)):
                self.fraction = min(event["time"] * self.frame_rate / self.frames, 1.0)
            if kind == "frame":
                self.frame = event.get("frame")
                self._refresh()
        elif kind == "warning":
            if len(self.messages) < MOST_WARNINGS:
                self.messages.append(str(event.get("message")))
        elif kind == "error":
            self.messages.append(_error_text(event))

    def _checked(self, event):
        speed = event.get("speed") or {}
        emitted = event.get("emitted") or 0
        particles = (event.get("particles") or 0) + emitted
        seconds = speed.get("expected_seconds") or 0
        self.estimate = (
            f"{particles:,} particles, {(event.get('memory_forecast') or 0) / 1e6:,.0f} MB, about {duration(seconds)} on "
            f"{speed.get('device', 'this machine')}"
        )
        self.messages += [_warning_text(warning) for warning in (event.get("warnings") or [])[:MOST_WARNINGS]]
        try:
            self._refuse_too_many(particles)
        except Failed as error:
            self.messages.append(str(error))
            self.state = "FAILED"
            self.job.kill()

    def _ended(self, code):
        if self.state == "CHECKING" and code == 0 and not self.only_check:
            try:
                # Frames of the earlier bake are removed by the program.
                self._start("RUNNING", ["run", "scene.toml", "--out", "run", "--device", self.device, *self._output()])
            except Failed as error:
                self.messages.append(str(error))
                self.state = "FAILED"
            return
        stopping = self.state == "STOPPING"
        if code == 0:
            self.state = "CHECKED" if self.state == "CHECKING" else "FINISHED"
        elif stopping or code == 130:
            self.state = "STOPPED"
        else:
            self.state = "FAILED"
            tail = self.job.tail()
            if not any(self.messages) and tail:
                self.messages.append(tail.removeprefix("error: "))
            self.messages.append(f"The program ended with exit code {code}.")
        if self.state == "FINISHED":
            self.fraction = 1.0
        if self.state in ("FINISHED", "STOPPED") and self.frames is not None:
            self._refresh(bodies=True)

    def _show(self):
        scene = self.scene()
        if scene is None:
            return
        settings = scene.splashdown
        run = f"{settings.cache_folder}run" if settings.cache_folder.endswith(("/", "\\")) else f"{settings.cache_folder}/run"
        playback.baked = bpy.path.abspath(run)
        show.show(
            scene,
            run,
            ["surface", "droplets", *(DIFFUSE if settings.use_foam else ())],
            name=scene.name,
            start_frame=scene.frame_start,
            frame_interval=1 / self.frame_rate,
            spacing=self.spacing,
            metres_per_unit=collect.metres_per_unit(scene),
            liquid=settings.material,
            domain=self.domain,
        )

    def _refresh(self, bodies=False):
        """Shows new frames. A frame that is already shown is not read again."""
        scene = self.scene()
        if scene is None:
            return
        if bodies:
            problems = show.move_bodies(
                scene, str(self.run), scene.frame_start, 1 / self.frame_rate, collect.metres_per_unit(scene)
            )
            self.messages += problems
        playback.load_all(scene)

    def cancel(self):
        """Ends the bake after its frame; the second call ends it at once. Complete frames remain."""
        if self.state == "STOPPING":
            self.job.kill()
        elif self.is_active:
            self.job.stop()
            self.state = "STOPPING"

    def abandon(self):
        """Asks the program to end, without watching it any more."""
        if self.is_active:
            self.job.stop()
            self.state = "STOPPED"

    def text(self):
        """The state in words."""
        if self.state == "CHECKING":
            return "Checking the scene"
        if self.state == "CHECKED":
            return self.estimate
        frames = f"frame {self.frame} of {self.frames}" if self.frames else "starting"
        words = {
            "RUNNING": f"Simulating: {frames}",
            "STOPPING": f"Stopping after this frame ({frames})",
            "FINISHED": f"Finished: {self.frames} frames",
            "STOPPED": f"Stopped at {frames}",
            "FAILED": "Failed",
        }
        return words[self.state]


def _identity(scene):
    """A value that identifies a scene also after undo."""
    return getattr(scene, "session_uid", scene.name)


def _error_text(event):
    """The message of the program and every problem of the scene."""
    lines = [str(event.get("message"))]
    for problem in event.get("problems") or []:
        text = problem.get("message") if isinstance(problem, dict) else str(problem)
        if text and text not in lines[0]:
            lines.append(str(text))
    return "\n".join(lines)


def _warning_text(warning):
    return str(warning.get("message", warning) if isinstance(warning, dict) else warning)


def duration(seconds):
    """A duration in s in words."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def cache_folder(scene):
    """The absolute path of the cache. Raises [`Failed`] if it is relative to a file that has not been saved."""
    given = scene.splashdown.cache_folder
    if not given:
        raise Failed("Choose a cache folder.")
    if given.startswith("//") and not bpy.data.filepath:
        raise Failed("Save the .blend file first, or choose an absolute cache folder: the present one is relative to the file.")
    return Path(bpy.path.abspath(given))


def saved_walls(scene):
    """The corners of the domain of an earlier bake, from the objects that show it; `None` if there are none."""
    for obj in playback.shown_objects(scene):
        cache = obj.splashdown_cache
        if cache.series == "surface" and cache.wall_overlap > 0:
            return tuple(cache.wall_low), tuple(cache.wall_high)
    return None


def has_checkpoint(run):
    """Whether a run can be resumed."""
    return any(Path(run).glob("checkpoints/*.splashdown"))


def active():
    return current is not None and current.is_active


def start(context, **options):
    """Starts a bake and the timer that watches it. Raises [`Failed`]."""
    global current
    if active():
        raise Failed("A bake is in progress. Cancel it first.")
    current = Bake(context, **options)
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
    global current
    if current is not None:
        current.abandon()
        current = None


def _at_exit():
    if active():
        current.job.stop()
        try:
            current.job.wait(10)
        except subprocess.TimeoutExpired:
            current.job.kill()


CLASSES = (SPLASHDOWN_OT_bake, SPLASHDOWN_OT_resume, SPLASHDOWN_OT_check, SPLASHDOWN_OT_cancel, SPLASHDOWN_OT_restore)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.app.handlers.load_pre.append(_before_load)
    atexit.register(_at_exit)


def unregister():
    _before_load()
    atexit.unregister(_at_exit)
    bpy.app.handlers.load_pre.remove(_before_load)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
