"""The tab Splashdown in the sidebar of the 3-D view."""

import bpy

from . import bake, preferences


class SPLASHDOWN_PT_panel(bpy.types.Panel):
    bl_label = "Splashdown"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Splashdown"

    def draw(self, context):
        layout, settings, item = self.layout, context.scene.splashdown, context.object
        layout.use_property_split = True
        if item and not item.splashdown.kind:
            box = layout.box()
            box.label(text=item.name, icon="OBJECT_DATA")
            box.prop(item.splashdown, "role")
            if item.splashdown.role == "FLUID":
                box.prop(item.splashdown, "velocity")
            elif item.splashdown.role == "OBSTACLE":
                box.prop(item.splashdown, "friction")
        elif item:
            layout.prop(item.splashdown, "first_frame")
            if item.splashdown.kind != "surface":
                layout.prop(item.splashdown, "point_radius")
        for name in ("spacing", "liquid"):
            layout.prop(settings, name)
        if settings.liquid == "custom":
            layout.prop(settings, "density", text="Density (kg/m³)")
            layout.prop(settings, "viscosity", text="Viscosity (m²/s)")
        for name in ("has_foam", "device", "cache"):
            layout.prop(settings, name)
        row = layout.row(align=True)
        row.prop(context.scene, "frame_start", text="Frames")
        row.prop(context.scene, "frame_end", text="")
        if bake.is_baking():
            layout.progress(factor=settings.progress, text=settings.report)
            layout.operator("splashdown.cancel", icon="CANCEL")
        else:
            layout.operator("splashdown.bake", icon="MOD_FLUIDSIM")
            layout.operator("splashdown.open_run", icon="FILE_FOLDER")
            if settings.report:
                preferences.wrapped(layout, settings.report, "ERROR" if settings.is_error else "INFO", 42)


def register():
    bpy.utils.register_class(SPLASHDOWN_PT_panel)


def unregister():
    bpy.utils.unregister_class(SPLASHDOWN_PT_panel)
