"""Tests of the packaged extension in Blender without a window:

    python headless.py ZIP PROGRAM [--pictures FOLDER] [TEST ...]

`python` is one with the package `bpy`. Every bake is one of the program PROGRAM. A TEST is the name of a class, or
`Class.test`.
"""

import argparse
import sys
import unittest
from pathlib import Path

from blender_case import ARGUMENTS, WORK, clean_up, install
from blender_baking import Baking
from blender_control import Cancelling, Refusals
from blender_obstacles import Obstacles
from blender_rendering import Rendering
from blender_runs import Opening, OtherRuns

# `unittest.main` finds the tests in this module.
TESTS = (Baking, Cancelling, Refusals, Obstacles, Opening, OtherRuns, Rendering)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("zip", type=Path)
    parser.add_argument("program", type=Path)
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("tests", nargs="*")
    parsed = parser.parse_args()
    ARGUMENTS.zip, ARGUMENTS.program = parsed.zip.resolve(), parsed.program.resolve()
    install()
    try:
        if parsed.pictures:
            import pictures

            pictures.draw(parsed.pictures.resolve(), WORK)
        else:
            unittest.main(argv=[sys.argv[0], "-v", *parsed.tests])
    finally:
        clean_up()
