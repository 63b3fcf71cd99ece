"""Tests of the modules that do not need Blender: python -m unittest discover -s blender/tests."""

import json
import os
import stat
import struct
import sys
import tempfile
import time
import types
import unittest
from pathlib import Path

# The package itself imports Blender, its modules ply, run_folder and process do not.
FOLDER = Path(__file__).resolve().parents[1] / "splashdown"
package = types.ModuleType("extension")
package.__path__ = [str(FOLDER)]
sys.modules["extension"] = package

from extension import ply, process, run_folder  # noqa: E402

HEADER = """ply
format binary_little_endian 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
"""


def triangle():
    return HEADER.encode() + struct.pack("<9fB3i", 0, 1, 2, 3, 4, 5, 6, 7, 8, 3, 0, 1, 2)


class Modules(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name, data):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        return path

    def test_positions_have_z_up(self):
        arrays = ply.read(self.write("a.ply", triangle()))
        self.assertEqual(ply.vectors(arrays["vertex"], "xyz").tolist()[0], [0, -2, 1])
        self.assertEqual(arrays["face"]["corners"].tolist(), [[0, 1, 2]])
        self.assertIsNone(ply.vectors(arrays["vertex"], ("vx", "vy", "vz")))

    def test_every_truncation_is_found(self):
        data = triangle()
        for length in range(len(data)):
            path = self.write("a.ply", data[:length])
            self.assertFalse(ply.is_complete(path), length)
            with self.assertRaises(ply.PlyError):
                ply.read(path)
        self.assertTrue(ply.is_complete(self.write("a.ply", data)))

    def test_other_files_are_errors(self):
        for text in (HEADER.replace("binary_little_endian", "ascii"), HEADER.replace("float z", "half z")):
            with self.assertRaises(ply.PlyError):
                ply.read(self.write("a.ply", text.encode() + bytes(100)))
        quad = HEADER.encode() + struct.pack("<9fB3i", *range(9), 4, 0, 1, 2)
        with self.assertRaises(ply.PlyError):
            ply.read(self.write("a.ply", quad))

    def test_a_mixed_folder_is_scanned(self):
        for frame in (0, 1, 4, 5):
            self.write(f"mesh/surface_{frame:04}.ply", triangle())
        self.write("mesh/surface_0002.ply", triangle()[:-1])
        self.write("mesh/surface_0003.obj", b"")
        self.write("mesh/surface_0003.ply.tmp", b"")
        self.write("particles/foam_0001.ply", triangle())
        self.write("run.json", json.dumps({"particle_spacing": 0.25}).encode())
        run = run_folder.scan(self.folder)
        self.assertEqual(run.frames, [0, 1, 4, 5])
        self.assertEqual(sorted(run.files["foam"]), [1])
        self.assertEqual(run.spacing, 0.25)
        self.assertEqual(len(run.problems), 3, run.problems)
        self.assertIn("frames 2.", run.problems[0])
        self.assertIn("frames 3.", run.problems[1])
        self.assertIn(".obj", run.problems[2])

    def test_empty_and_absent_folders_have_no_frames(self):
        self.write("run.json", b"[]")
        self.assertEqual(run_folder.scan(self.folder).frames, [])
        self.assertIn("not a folder", run_folder.scan(self.folder / "absent").report())

    def test_a_missing_program_is_explained(self):
        with self.assertRaisesRegex(process.ProgramMissing, "cargo install"):
            process.find_program(str(self.folder / "absent"))

    @unittest.skipIf(os.name == "nt", "needs a script with a first line that names its interpreter")
    def test_events_and_errors_are_read(self):
        script = [
            f"#!{sys.executable}",
            "import sys",
            'print(\'{"event":"started","frames":4}\')',
            "print('not JSON')",
            'print(\'{"event":"frame","frame":2}\')',
            'print(\'{"event":"error","message":"too deep"}\')',
            "sys.exit(3)",
        ]
        path = self.write("program", "\n".join(script).encode())
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        run = process.Run(str(path), "a.toml", "out")
        self.wait(run)
        self.assertEqual((run.frame, run.frames, run.progress, run.error), (2, 4, 0.5, "too deep"))

    @unittest.skipIf(os.name == "nt", "needs a script with a first line that names its interpreter")
    def test_a_program_that_ignores_the_signal_is_killed(self):
        script = [
            f"#!{sys.executable}",
            "import signal, time",
            "signal.signal(signal.SIGINT, signal.SIG_IGN)",
            'print(\'{"event":"started","frames":4}\', flush=True)',
            "time.sleep(60)",
        ]
        path = self.write("program", "\n".join(script).encode())
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        run = process.Run(str(path), "a.toml", "out")
        end = time.monotonic() + 20
        while run.frames is None and time.monotonic() < end:
            run.poll()
            time.sleep(0.01)
        run.cancel(timeout=0.1)
        self.wait(run)
        self.assertTrue(run.was_cancelled)
        self.assertIsNone(run.error)

    def wait(self, run):
        end = time.monotonic() + 20
        while run.poll():
            self.assertLess(time.monotonic(), end, "the program still runs")
            time.sleep(0.01)


if __name__ == "__main__":
    unittest.main()
