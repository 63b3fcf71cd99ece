"""Splashdown in Blender: choose objects, bake, and play the surface and the foam of a run."""

from . import bake, cache, panel, preferences, properties

MODULES = (preferences, properties, cache, bake, panel)


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
