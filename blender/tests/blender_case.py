"""What the headless tests share: the installed extension, and access to objects, frames and tables.

Blender's settings are kept in a temporary folder.
"""

import argparse
import csv
import os
import shutil
import sys
import tempfile
import time
import unittest
from pathlib import Path

WORK = Path(tempfile.mkdtemp(prefix="splashdown-blender-"))
os.environ["BLENDER_USER_RESOURCES"] = str(WORK / "user")

import bpy
import numpy as np

import support

MODULE = "bl_ext.user_default.splashdown"
ARGUMENTS = argparse.Namespace(zip=None, program=None, pictures=None)


def part(name):
    """A module of the installed extension."""
    return sys.modules[f"{MODULE}.{name}"]


def set_program(path):
    bpy.context.preferences.addons[MODULE].preferences.path = str(path)


def install():
    """Installs and enables the packaged extension."""
    result = bpy.ops.extensions.package_install_files(
        repo="user_default", filepath=str(ARGUMENTS.zip), enable_on_install=True
    )
    assert result == {"FINISHED"} and MODULE in bpy.context.preferences.addons.keys()
    installed = Path(part("bake").__file__)
    assert installed.is_relative_to(WORK), f"the tests use {installed} instead of the package"
    set_program(ARGUMENTS.program)


def clean_up():
    shutil.rmtree(WORK, ignore_errors=True)


def vertices(obj):
    """The vertices of the object's mesh, shape (N, 3)."""
    values = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


def attribute(obj, name, width):
    data = obj.data.attributes[name].data
    values = np.empty(width * len(data), np.float32)
    data.foreach_get("vector" if width == 3 else "value", values)
    return values.reshape(-1, width)


def shown(scene, series="surface"):
    return next(obj for obj in scene.objects if obj.splashdown_cache.series == series)


def shown_or_none(scene, series="surface"):
    return next((obj for obj in scene.objects if obj.splashdown_cache.series == series), None)


def ply_of(folder, series, number):
    run = part("core.run_folder").RunFolder(Path(folder) / "run")
    return part("core.ply").read(run.frames[series][number])


def table(path):
    """Times, positions and quaternions x, y, z, w of the table of a body."""
    with open(path, newline="") as file:
        rows = np.array([[float(word) for word in row[:8]] for row in list(csv.reader(file))[1:]])
    return rows[:, 0], rows[:, 1:4], rows[:, 4:8]


class Case(unittest.TestCase):
    def setUp(self):
        self.cache = Path(tempfile.mkdtemp(dir=WORK))
        set_program(ARGUMENTS.program)

    def refused(self, operator, **arguments):
        """The text with which an operator refuses."""
        with self.assertRaises(RuntimeError) as caught:
            operator(**arguments)
        return str(caught.exception)

    def start(self, frames):
        """A scene without foam, and its bake, which nobody watches."""
        scene = support.dam_break(self.cache, frames=frames)
        scene.splashdown.use_foam = False
        return scene, part("bake").start(bpy.context)

    def run_until(self, bake, condition=lambda: False):
        """Watches a bake until a condition holds or it ends."""
        end = time.monotonic() + 120
        while not condition() and bake.update():
            self.assertLess(time.monotonic(), end, "the bake does not go on")
            time.sleep(0.005)

    def script(self, text):
        """The path of a program for the shell that has the version of the extension."""
        path = self.cache / "program"
        version = part("core.program").extension_version()
        path.write_text(f'#!/bin/sh\n[ "$1" = --version ] && echo splashdown {version} && exit\n{text}\n')
        path.chmod(0o755)
        return path

    def bake(self):
        self.assertEqual(bpy.ops.splashdown.bake(), {"FINISHED"})
        return part("bake").current
