"""Operators: bake, cancel, and open a run."""

import time

import bpy

from . import cache, preferences, process, scene_export


class Job:
    """A bake from the export to the loaded frames."""

    def __init__(self, context):
        """Raises process.ProgramMissing, scene_export.SceneError or OSError."""
        self.scene = context.scene
        program = preferences.program(context)
        path = scene_export.export(self.scene)
        self.out = path.parent / "run"
        self.run = process.Run(program, path, self.out, self.scene.splashdown.device)
        self.report("Started")

    def report(self, text, is_error=False):
        self.scene.splashdown.report = text
        self.scene.splashdown.is_error = is_error

    def poll(self):
        """Updates the progress. Returns whether the bake continues; at its end the frames are loaded."""
        is_running = self.run.poll()
        self.scene.splashdown.progress = self.run.progress
        if is_running:
            self.report(f"Frame {max(self.run.frame, 0)} of {self.run.frames or '?'}")
            return True
        spacing = self.scene.splashdown.spacing
        loaded = cache.load(self.scene, self.out, self.scene.splashdown.liquid, spacing)
        lines = [*self.run.warnings]
        if loaded.frames or not self.run.error:
            lines.append(loaded.report())
        if self.run.error:
            lines.insert(0, self.run.error)
        elif self.run.was_cancelled:
            lines.insert(0, "Cancelled. The finished frames are kept.")
        self.report("\n".join(lines), is_error=bool(self.run.error))
        return False


_job = None


def is_baking():
    return _job is not None


def stop():
    """Stops a bake without loading its frames."""
    global _job
    if _job:
        _job.run.cancel()
        _job = None


class SPLASHDOWN_OT_bake(bpy.types.Operator):
    """Simulate the scene and load the result"""

    bl_idname = "splashdown.bake"
    bl_label = "Bake"

    @classmethod
    def poll(cls, _context):
        return not is_baking()

    def start(self, context):
        global _job
        try:
            _job = Job(context)
        except (process.ProgramMissing, scene_export.SceneError, OSError) as error:
            context.scene.splashdown.report = str(error)
            context.scene.splashdown.is_error = True
            self.report({"ERROR"}, str(error))
        return _job is not None

    def finish(self, context):
        global _job
        job, _job = _job, None
        text = context.scene.splashdown.report
        self.report({"ERROR"} if job.run.error else {"INFO"}, text)
        return {"CANCELLED"} if job.run.error else {"FINISHED"}

    def execute(self, context):
        """Waits for the end, for scripts and the command line."""
        if not self.start(context):
            return {"CANCELLED"}
        while _job.poll():
            time.sleep(0.05)
        return self.finish(context)

    def invoke(self, context, _event):
        if bpy.app.background:
            return self.execute(context)
        if not self.start(context):
            return {"CANCELLED"}
        self.timer = context.window_manager.event_timer_add(0.2, window=context.window)
        context.window_manager.progress_begin(0, 100)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def cancel(self, _context):
        """Called by Blender when another file is opened during a bake."""
        stop()

    def modal(self, context, event):
        if _job is None:
            return {"CANCELLED"}
        if event.type == "ESC" and event.value == "PRESS":
            _job.run.cancel()
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        is_running = _job.poll()
        context.window_manager.progress_update(100 * context.scene.splashdown.progress)
        for area in context.screen.areas if context.screen else []:
            area.tag_redraw()
        if is_running:
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.progress_end()
        return self.finish(context)


class SPLASHDOWN_OT_cancel(bpy.types.Operator):
    """Stop the simulation. The finished frames are kept"""

    bl_idname = "splashdown.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, _context):
        return is_baking()

    def execute(self, _context):
        _job.run.cancel()
        return {"FINISHED"}


class SPLASHDOWN_OT_open_run(bpy.types.Operator):
    """Show the frames of an existing run"""

    bl_idname = "splashdown.open_run"
    bl_label = "Open Run"

    directory: bpy.props.StringProperty(subtype="DIR_PATH")

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        settings = context.scene.splashdown
        run = cache.load(context.scene, bpy.path.abspath(self.directory), settings.liquid, settings.spacing)
        settings.report, settings.is_error = run.report(), not run.frames
        if not run.frames:
            self.report({"ERROR"}, run.report())
            return {"CANCELLED"}
        self.report({"WARNING"} if run.problems else {"INFO"}, run.report())
        return {"FINISHED"}


CLASSES = (SPLASHDOWN_OT_bake, SPLASHDOWN_OT_cancel, SPLASHDOWN_OT_open_run)


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)


def unregister():
    stop()
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)
