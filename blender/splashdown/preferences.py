"""The path of the program."""

import bpy

from . import process


class SplashdownPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(
        name="Program",
        description="Path of splashdown. Empty: search on PATH and in the folder of cargo",
        subtype="FILE_PATH",
    )

    def draw(self, _context):
        self.layout.prop(self, "program")
        try:
            self.layout.label(text=f"Found: {process.find_program(self.program)}", icon="CHECKMARK")
        except process.ProgramMissing as error:
            wrapped(self.layout, str(error), "ERROR")


def wrapped(layout, text, icon="NONE", width=60):
    """Draws a text as several labels."""
    import textwrap

    for paragraph in text.splitlines():
        for line in textwrap.wrap(paragraph, width) or [""]:
            layout.label(text=line, icon=icon)
            icon = "BLANK1" if icon != "NONE" else icon


def program(context):
    """The program. Raises process.ProgramMissing."""
    addon = context.preferences.addons.get(__package__)
    return process.find_program(addon.preferences.program if addon else "")


def register():
    bpy.utils.register_class(SplashdownPreferences)


def unregister():
    bpy.utils.unregister_class(SplashdownPreferences)
