"""Blender extension of Splashdown: describes a scene, runs the program, and shows the frames of its runs.

`properties` are what the user sets, `collect` turns objects into a scene of the program, `bake` runs the program,
`playback` shows frames, `panels` draw the sidebar. The folder `core` needs no Blender.
"""

from . import bake, open_run, panels, playback, preferences, properties

MODULES = (preferences, properties, playback, bake, open_run, panels)


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
