"""Preferences of the extension: the path of the program."""

import bpy

from .core import program


class SplashdownPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    path: bpy.props.StringProperty(
        name="Program",
        description="Path of the program `splashdown`. Empty: it is searched on the PATH and in Cargo's folder",
        subtype="FILE_PATH",
    )

    def draw(self, context):
        self.layout.prop(self, "path")
        draw_program(self.layout)


def draw_program(layout):
    """Shows the path of the program, or how to install it. Returns whether it was found."""
    try:
        layout.label(text=find_program(), icon="CHECKMARK")
    except program.ProgramError as error:
        column = layout.column()
        for number, line in enumerate(str(error).splitlines()):
            column.label(text=line, icon="BLANK1" if number else "ERROR")
        return False
    return True


def find_program():
    """The path of the program. Raises [`program.ProgramError`] with instructions."""
    addon = bpy.context.preferences.addons.get(__package__)
    given = addon.preferences.path if addon else ""
    return program.find(bpy.path.abspath(given) if given else "")


def register():
    bpy.utils.register_class(SplashdownPreferences)


def unregister():
    bpy.utils.unregister_class(SplashdownPreferences)
