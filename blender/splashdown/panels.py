"""The tab *Splashdown* in the sidebar of the 3D view."""

import textwrap

import bpy

from . import bake, playback, preferences
from .core.program import ProgramError

# Characters of a line of a message in a sidebar of usual width.
LINE = 46


class _Panel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Splashdown"


def _settings(layout):
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


def draw_text(layout, text, icon="NONE"):
    """Draws a text in several lines."""
    column = layout.column(align=True)
    column.scale_y = 0.8
    lines = [part for line in text.splitlines() for part in textwrap.wrap(line, LINE) or [""]]
    for number, line in enumerate(lines):
        column.label(text=line, icon=icon if number == 0 else "BLANK1" if icon != "NONE" else "NONE")


class SPLASHDOWN_PT_object(_Panel, bpy.types.Panel):
    bl_label = "Object"

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "MESH"

    def draw(self, context):
        layout = _settings(self.layout)
        own = context.object.splashdown
        layout.prop(own, "role")
        if own.role == "FLUID":
            layout.prop(own, "velocity")
        elif own.role == "OBSTACLE":
            layout.prop(own, "motion")
            layout.prop(own, "friction")
            if own.motion == "DYNAMIC":
                layout.prop(own, "density")
                layout.prop(own, "velocity")
        elif own.role == "EMITTER":
            layout.prop(own, "speed")
            layout.prop(own, "start")
            layout.prop(own, "use_end")
            if own.use_end:
                layout.prop(own, "end")


class SPLASHDOWN_PT_simulation(_Panel, bpy.types.Panel):
    bl_label = "Simulation"

    def draw(self, context):
        layout = _settings(self.layout)
        settings = context.scene.splashdown
        layout.prop(settings, "particle_spacing")
        layout.prop(settings, "material")
        if settings.material == "custom":
            layout.prop(settings, "density")
            layout.prop(settings, "viscosity")
            layout.prop(settings, "surface_tension")
        layout.prop(settings, "use_surface_tension")
        layout.prop(settings, "use_foam")
        layout.prop(settings, "time_scale")
        layout.prop(settings, "wall_friction")
        layout.label(text="Open sides")
        layout.row(align=True).prop(settings, "open_sides", expand=True)


class SPLASHDOWN_PT_surface(_Panel, bpy.types.Panel):
    bl_label = "Surface"
    bl_parent_id = "SPLASHDOWN_PT_simulation"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = _settings(self.layout)
        for name in ("smoothing", "cell_ratio", "use_anisotropic"):
            layout.prop(context.scene.splashdown, name)


class SPLASHDOWN_PT_bake(_Panel, bpy.types.Panel):
    bl_label = "Bake"

    def draw(self, context):
        layout = self.layout
        settings = context.scene.splashdown
        _settings(layout.column()).prop(settings, "cache_folder")
        column = _settings(layout.column())
        for name in ("device", "checkpoint_every", "max_particles"):
            column.prop(settings, name)
        try:
            preferences.find_program()
        except ProgramError as error:
            draw_text(layout, str(error), icon="ERROR")
        if bake.active():
            layout.progress(factor=bake.current.fraction, text=bake.current.text())
            layout.operator("splashdown.cancel", icon="CANCEL")
        else:
            row = layout.row(align=True)
            row.operator("splashdown.bake", icon="PLAY")
            row.operator("splashdown.resume")
            row.operator("splashdown.check")
            if bake.current is not None:
                draw_text(layout, bake.current.text())
        if bake.refusal:
            draw_text(layout, bake.refusal, icon="ERROR")
        if bake.current is not None:
            for message in bake.current.errors:
                draw_text(layout, message, icon="ERROR")
            for message in bake.current.warnings:
                draw_text(layout, message, icon="INFO")


class SPLASHDOWN_PT_results(_Panel, bpy.types.Panel):
    bl_label = "Results"

    def draw(self, context):
        layout = self.layout
        row = layout.row(align=True)
        row.operator("splashdown.open_run", icon="FILE_FOLDER")
        row.operator("splashdown.reload", icon="FILE_REFRESH")
        if any(obj.splashdown.has_rest for obj in context.scene.objects):
            layout.operator("splashdown.restore")
        _settings(layout.column()).prop(context.scene.render, "use_motion_blur")
        for obj in playback.shown_objects(context.scene):
            cache = obj.splashdown_cache
            box = layout.box()
            box.label(text=obj.name, icon="MOD_FLUIDSIM" if cache.series == "surface" else "POINTCLOUD_DATA")
            if cache.series == "surface":
                column = _settings(box.column())
                column.prop(cache, "start_frame")
                column.prop(cache, "wall_overlap")
            if cache.series in ("surface", "particles") and abs(playback.pace(obj, context.scene) - 1) > 1e-3:
                draw_text(box, playback.pace_text(obj, context.scene), icon="INFO")
            if cache.note:
                draw_text(box, cache.note, icon="ERROR")


CLASSES = (
    SPLASHDOWN_PT_object,
    SPLASHDOWN_PT_simulation,
    SPLASHDOWN_PT_surface,
    SPLASHDOWN_PT_bake,
    SPLASHDOWN_PT_results,
)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
