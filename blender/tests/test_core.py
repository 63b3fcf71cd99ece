"""Tests of what needs no Blender: `python -m unittest discover blender/tests`. They need NumPy."""

import json
import os
import re
import sys
import tempfile
import time
import tomllib
import unittest
import zipfile
from pathlib import Path

import numpy as np

BLENDER = Path(__file__).resolve().parent.parent
ROOT = BLENDER.parent
sys.path[:0] = [str(BLENDER), str(BLENDER / "splashdown")]

import package
from core import axes, geometry, liquids, ply, program, run_folder, scene
from core.job import Job

CUBE = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
FACES = [t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))]


def cube(low=(0, 0, 0), high=(1, 1, 1)):
    low, high = np.array(low, float), np.array(high, float)
    return geometry.Mesh(low + CUBE * (high - low), FACES)


def octahedron(centre=(0, 0, 0), radius=1.0):
    points = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], float)
    faces = [(x, y, z) if (x + y + z) % 2 == 0 else (x, z, y) for x in (0, 1) for y in (2, 3) for z in (4, 5)]
    return geometry.Mesh(np.array(centre) + radius * points, faces)


def turn(axis, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = c, -s, s, c
    return matrix


class Axes(unittest.TestCase):
    def test_up_is_up_and_the_handedness_remains(self):
        self.assertEqual(axes.to_program((0, 0, 1)).tolist(), [0, 1, 0])
        self.assertEqual(axes.to_blender(np.array([0.0, 1, 0])).tolist(), [0, 0, 1])
        self.assertAlmostEqual(np.linalg.det(axes.PROGRAM_FROM_BLENDER), 1)
        points = np.random.default_rng(1).normal(size=(20, 3))
        np.testing.assert_allclose(axes.to_blender(axes.to_program(points)), points)

    def test_the_axis_against_gravity_becomes_z(self):
        for up, gravity in {
            "Y": (0, -9.81, 0),
            "-Y": (0, 9.81, 1),
            "Z": (0.5, 0, -9.81),
            "-Z": (0, 0, 1),
            "X": (-3, 2, 1),
            "-X": (3, 2, 1),
        }.items():
            self.assertEqual(axes.up_of(gravity), up)
            matrix = axes.to_blender(np.eye(3), up).T
            self.assertAlmostEqual(np.linalg.det(matrix), 1)
            against = np.zeros(3)
            axis = int(np.abs(gravity).argmax())
            against[axis] = -np.sign(gravity[axis])
            self.assertEqual(axes.to_blender(against, up).tolist(), [0, 0, 1])
        self.assertEqual([axes.up_of(gravity) for gravity in ((0, 0, 0), (0, 0, np.nan))], ["Y", "Y"])
        self.assertEqual(axes.to_blender(np.ones((2, 3), np.float32), "X").dtype, np.float32)

    def test_the_angles_of_a_scene_file_give_the_rotation_back(self):
        for angles in [(20, -50, 130), (0, 90, 30), (170, -90, 0), (-179, 10, -100), (0, 0, 0)]:
            x, y, z = angles
            matrix = turn(2, z) @ turn(1, y) @ turn(0, x)
            a, b, c = axes.angles(matrix)
            np.testing.assert_allclose(turn(2, c) @ turn(1, b) @ turn(0, a), matrix, atol=1e-9)

    def test_a_quaternion_turns_as_the_matrix_does(self):
        half = np.radians(35)
        axis = np.array([1, 2, 3]) / np.sqrt(14)

        def rotated(v, w, *u):
            return v + 2 * np.cross(u, np.cross(u, v) + w * v)

        # Rodrigues' formula in the axes of the program.
        v = np.array([0.3, -1, 2.0])
        expected = v * np.cos(2 * half) + np.cross(axis, v) * np.sin(2 * half) + axis * (axis @ v) * (1 - np.cos(2 * half))
        for up in axes.TURNS:
            quaternion = axes.quaternion_to_blender((*(np.sin(half) * axis), np.cos(half)), up)
            turned = rotated(axes.to_blender(v, up), *quaternion)
            np.testing.assert_allclose(turned, axes.to_blender(expected, up))

    def test_each_side_of_the_domain_is_the_one_of_its_name(self):
        for name, side, label in axes.SIDES:
            outward = np.zeros(3)
            outward["XYZ".index(label[1])] = 1 if label[0] == "+" else -1
            turned = axes.to_program(outward)
            axis = int(np.abs(turned).argmax())
            self.assertEqual(side, "xyz"[axis] + ("_max" if turned[axis] > 0 else "_min"), name)


class Geometry(unittest.TestCase):
    def test_closed_meshes_have_no_open_edges(self):
        self.assertEqual(geometry.open_edges(cube()), 0)
        self.assertEqual(geometry.open_edges(octahedron()), 0)
        self.assertEqual(geometry.open_edges(geometry.Mesh(CUBE, FACES[2:])), 4)
        flipped = [FACES[0][::-1], *FACES[1:]]
        self.assertEqual(geometry.open_edges(geometry.Mesh(CUBE, flipped)), 3)

    def test_split_vertices_are_not_holes(self):
        split = geometry.Mesh(cube().corners().reshape(-1, 3), np.arange(36))
        self.assertEqual(geometry.open_edges(split), 0)

    def test_only_boxes_along_the_axes_are_boxes(self):
        self.assertTrue(geometry.is_box(cube((1, 2, 3), (2, 5, 4))))
        self.assertTrue(geometry.is_box(cube().flipped()))
        self.assertFalse(geometry.is_box(octahedron()))
        self.assertFalse(geometry.is_box(geometry.Mesh(CUBE @ turn(1, 30).T, FACES)))
        self.assertFalse(geometry.is_box(geometry.Mesh(CUBE, FACES[2:])))

    def test_a_matrix_is_split_into_rotation_and_stretch(self):
        turned = turn(0, 20) @ turn(1, -50) @ turn(2, 130)
        for scale in [(1, 1, 1), (2, 0.5, 3), (-1, 1, 1), (-1, -1, 1), (-1, -2, -0.5)]:
            rotation, stretch = geometry.split(turned @ np.diag(scale))
            np.testing.assert_allclose(rotation @ stretch, turned @ np.diag(scale), atol=1e-12)
            self.assertAlmostEqual(np.linalg.det(rotation), 1)
            self.assertEqual(np.linalg.det(stretch) < 0, np.prod(scale) < 0)
        sheared = np.array([(1, 0.2, 0), (0, 1, 0), (0, 0, 1.0)])
        for matrix in (sheared, np.diag([1.0, 1, 0])):
            self.assertIsNone(geometry.split(matrix)[1])

    def test_a_flat_mesh_is_an_outlet_of_its_area(self):
        square = geometry.Mesh([(0, 1, 0), (2, 1, 0), (2, 1, 1), (0, 1, 1)], [(0, 2, 1), (0, 3, 2)])
        outlet = geometry.flat_outlet(square)
        np.testing.assert_allclose(outlet.direction, (0, 1, 0), atol=1e-12)
        np.testing.assert_allclose(outlet.position, (1, 1, 0.5))
        self.assertAlmostEqual(outlet.area, 2)
        self.assertEqual(geometry.open_edges(outlet.mesh), 0)
        low, high = outlet.mesh.bounds()
        np.testing.assert_allclose(high - low, (2, 1, 1))
        self.assertAlmostEqual(outlet.mesh.volume(), 2)

    def test_solids_and_folded_meshes_are_no_outlets(self):
        folded = geometry.Mesh([(0, 0, 0), (1, 0, 0), (1, 1, 0.5), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
        for mesh in (cube(), folded, geometry.Mesh(CUBE[:3] * 0, [(0, 1, 2)])):
            self.assertIsNone(geometry.flat_outlet(mesh))


class Ply(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = Path(self.folder.name) / "mesh.ply"
        self.data = ply.mesh_bytes(CUBE, FACES)
        self.path.write_bytes(self.data)

    def tearDown(self):
        self.folder.cleanup()

    def test_a_mesh_is_read_as_it_was_written(self):
        frame = ply.read(self.path)
        np.testing.assert_array_equal(frame.positions, CUBE.astype(np.float32))
        np.testing.assert_array_equal(frame.triangles, FACES)
        np.testing.assert_array_equal(frame.velocities(), np.zeros((8, 3)))

    def test_every_truncation_is_reported(self):
        for length in range(len(self.data)):
            self.path.write_bytes(self.data[:length])
            with self.assertRaises(ply.FrameError):
                ply.read(self.path)
            with self.assertRaises(ply.FrameError):
                ply.check(self.path)

    def test_changed_bytes_are_an_error_or_a_usable_mesh(self):
        random = np.random.default_rng(2)
        outcomes = set()
        for _ in range(3000):
            data = bytearray(self.data)
            for place in random.integers(0, len(data), 3):
                data[place] = random.integers(0, 256)
            self.path.write_bytes(data)
            try:
                frame = ply.read(self.path)
            except ply.FrameError:
                outcomes.add("error")
                continue
            outcomes.add("mesh")
            self.assertTrue(np.isfinite(frame.positions).all())
            if frame.triangles.size:
                self.assertLess(frame.triangles.max(), len(frame.positions))
                self.assertGreaterEqual(frame.triangles.min(), 0)
        self.assertEqual(outcomes, {"error", "mesh"})

    def test_other_files_are_reported(self):
        text = b"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n"
        for data, reason in [(b"solid", "not a PLY"), (text, "binary"), (b"", "not a PLY")]:
            self.path.write_bytes(data)
            with self.assertRaisesRegex(ply.FrameError, reason):
                ply.read(self.path)
        with self.assertRaises(ply.FrameError):
            ply.read(self.path.with_name("missing.ply"))


class Runs(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = Path(self.folder.name)
        (self.path / "mesh").mkdir()
        for number in range(5):
            self.mesh(number)
        report = {"complete_frames": 5, "particle_spacing": 0.1, "end": {"time": 0.2}}
        (self.path / "run.json").write_text(json.dumps(report))

    def tearDown(self):
        self.folder.cleanup()

    def mesh(self, number, digits=4, ending="ply"):
        path = self.path / f"mesh/surface_{number:0{digits}}.{ending}"
        path.write_bytes(ply.mesh_bytes(CUBE, FACES))
        return path

    def problems(self):
        return "; ".join(run_folder.RunFolder(self.path).problems())

    def test_a_complete_run_has_no_problems(self):
        run = run_folder.RunFolder(self.path)
        self.assertEqual(run.problems(), [])
        self.assertEqual(run.present(), ["surface"])
        self.assertEqual(run.last(), 4)
        self.assertAlmostEqual(run.frame_interval(), 0.05)
        self.assertEqual(run.particle_spacing(), 0.1)

    def test_missing_and_truncated_frames_are_reported_together(self):
        (self.path / "mesh/surface_0002.ply").unlink()
        broken = self.path / "mesh/surface_0004.ply"
        broken.write_bytes(broken.read_bytes()[:-1])
        self.assertIn("frame 2 missing", self.problems())
        self.assertIn("frame 4 of surface cannot be read (it is truncated", self.problems())
        run = run_folder.RunFolder(self.path)
        self.assertEqual(run.at_or_before("surface", 2)[0], 1)
        self.assertEqual(run.at_or_before("surface", 99)[0], 4)
        self.assertIsNone(run.at_or_before("surface", -1))

    def test_frames_of_two_runs_are_reported(self):
        self.mesh(7)
        self.assertIn("frame 7 are later than the last one", self.problems())
        newer = self.mesh(1, digits=5)
        os.utime(newer, ns=(2**62, 2**62))
        self.assertIn("frame 1 exist twice", self.problems())
        self.assertEqual(run_folder.RunFolder(self.path).frames["surface"][1], newer)

    def test_other_formats_are_named(self):
        (self.path / "mesh/surface_0003.ply").unlink()
        self.mesh(3, ending="obj")
        self.assertIn("frame 3 of surface only as obj", self.problems())
        for path in (self.path / "mesh").glob("*.ply"):
            path.unlink()
        run = run_folder.RunFolder(self.path)
        self.assertEqual(run.present(), [])
        self.assertIn("--formats ply", run.problems()[0])

    def test_a_missing_or_strange_report_is_a_problem_and_not_an_error(self):
        for text in ("", "[]", "{", '{"complete_frames": "5", "end": 3, "particle_spacing": true}'):
            (self.path / "run.json").write_text(text)
            run = run_folder.RunFolder(self.path)
            self.assertEqual(run.present(), ["surface"])
            self.assertIsNone(run.frame_interval())
            self.assertIsNone(run.particle_spacing())
        (self.path / "run.json").unlink()
        self.assertIn("run.json is missing", self.problems())

    def test_incomplete_rows_of_bodies_are_left_out(self):
        (self.path / "bodies").mkdir()
        header = "time (s),position x (m),y,z,orientation x,y,z,w\n"
        rows = "0,1,2,3,0,0,0,1\n0.1,1,2,3,0,0,0,0\n0.2,nonsense\n0.3,4,5,6,0,1,0,0\n"
        (self.path / "bodies/crate.csv").write_text(header + rows)
        places, problems = run_folder.RunFolder(self.path).bodies()
        self.assertEqual([row[0] for row in places["crate"]], [0.0, 0.3])
        self.assertEqual(problems[0], "crate.csv has 2 incomplete rows")

    def test_tables_of_bodies_are_compared_with_the_run(self):
        (self.path / "bodies").mkdir()
        header = "time (s),position x (m),y,z,orientation x,y,z,w\n"
        rows = [f"{0.05 * number},1,2,3,0,0,0,1\n" for number in range(5)]
        report = json.loads((self.path / "run.json").read_text())
        (self.path / "run.json").write_text(json.dumps(report | {"bodies": ["whole", "short", "junk", "gone"]}))
        (self.path / "bodies/whole.csv").write_text(header + "".join(rows))
        (self.path / "bodies/short.csv").write_text(header + "".join(rows[:3]))
        (self.path / "bodies/junk.csv").write_bytes(bytes(range(256)))
        (self.path / "bodies/empty.csv").write_bytes(b"")
        (self.path / "bodies/bare.csv").write_text(header)
        places, problems = run_folder.RunFolder(self.path).bodies(["named"])
        self.assertEqual(sorted(places), ["short", "whole"])
        for text in (
            "short.csv has 3 rows for 5 frames: the body stops at 0.1 s",
            "junk.csv is not the table of a body: the body does not move",
            "empty.csv is not the table of a body: the body does not move",
            "bare.csv has 0 rows for 5 frames: the body does not move",
            "gone.csv is missing in bodies: the body does not move",
            "named.csv is missing in bodies: the body does not move",
        ):
            self.assertEqual(problems.count(text), 1, problems)
        self.assertEqual(len(problems), 6, problems)

    def test_the_causes_of_damage_are_not_mixed(self):
        for number in (1, 2):
            broken = self.path / f"mesh/surface_000{number}.ply"
            broken.write_bytes(broken.read_bytes()[:-number])
        (self.path / "mesh/surface_0003.ply").write_text("no mesh")
        run = run_folder.RunFolder(self.path)
        truncated = "frames 1 to 2 of surface cannot be read (it is truncated): the frame before is shown"
        foreign = "frame 3 of surface cannot be read (it is not a PLY file): the frame before is shown"
        self.assertEqual(run.problems(), [truncated, foreign])
        self.assertEqual(run.damage("surface"), {1: truncated, 2: truncated, 3: foreign})

    def test_the_report_says_the_frame_rate_and_the_gravity(self):
        (self.path / "run.json").write_text('{"frame_rate": 25, "gravity": [0, 0, -9.81], "bodies": "crate"}')
        run = run_folder.RunFolder(self.path)
        self.assertEqual((run.frame_interval(), run.gravity(), run.body_names()), (0.04, [0, 0, -9.81], None))
        (self.path / "run.json").write_text('{"frame_rate": 0, "gravity": [0, true, -9.81]}')
        run = run_folder.RunFolder(self.path)
        self.assertEqual((run.frame_interval(), run.gravity()), (None, None))

    def test_numbers_are_listed_as_ranges(self):
        self.assertEqual(run_folder.listed([3]), "frame 3")
        self.assertEqual(run_folder.listed([9, 3, 7, 8]), "frames 3, 7 to 9")
        self.assertEqual(run_folder.listed([1, 3, 5, 7, 9]), "frames 1, 3, 5, 7, ...")


def simple_scene():
    return scene.Scene(
        "test",
        1.0,
        24.0,
        0.05,
        domain=scene.Domain(np.zeros(3), np.ones(3)),
        fluids=[scene.Fluid("water", cube((0, 0, 0), (0.5, 0.5, 1)))],
    )


class Scenes(unittest.TestCase):
    def problem(self, **changes):
        described = simple_scene()
        for name, value in changes.items():
            setattr(described, name, value)
        return "\n".join(scene.problems(described))

    def test_a_good_scene_has_no_problems(self):
        self.assertEqual(self.problem(), "")

    def test_each_problem_is_reported_with_the_name_of_the_object(self):
        far = scene.Fluid("Far", cube((2, 0, 0), (3, 1, 1)))
        over = scene.Fluid("Over", cube((0.5, 0, 0), (1.2, 1, 1)))
        holed = scene.Fluid("Holed", geometry.Mesh(0.5 * CUBE, FACES[2:]))
        pose = [scene.Pose(0, (0, 0, 0), (0, 0, 0))]
        light = scene.Body("Light", cube(), pose, density=10)
        flat = scene.Emitter("T_p", geometry.flat_outlet(geometry.Mesh(CUBE[:4] + 5, [(0, 1, 2), (2, 1, 3)])), 1, label="Tüp")
        cases = [
            ({"emitters": [flat]}, '"Tüp" is outside the domain'),
            ({"domain": None}, "no domain"),
            ({"fluids": []}, "no fluid"),
            ({"fluids": [far]}, '"Far" is outside the domain'),
            ({"fluids": [over]}, '"Over" reaches 0.2 m out'),
            ({"fluids": [holed]}, '"Holed" is not closed: 4 edges'),
            ({"sinks": [scene.Sink("Drain", geometry.Mesh(CUBE, FACES[2:]))]}, '"Drain" is not closed'),
            ({"bodies": [light]}, '"Light" has a density of 10'),
            ({"bodies": [scene.Body("N_ne", geometry.Mesh([], []), pose, label="Näne")]}, '"Näne" has no faces'),
            ({"duration": 0.0}, "frame range is empty"),
            ({"frame_rate": 1e5}, "0.1 to 10000"),
            ({"particle_spacing": 0.6}, "less than two particle spacings"),
        ]
        for changes, words in cases:
            self.assertIn(words, self.problem(**changes))
        several = self.problem(fluids=[far, holed], duration=0.0).splitlines()
        self.assertEqual(len(several), 3)

    def test_a_touching_wall_is_not_outside(self):
        touching = scene.Fluid("water", cube((0, 0, 0), (0.5, 0.5, 1.0000005)))
        self.assertEqual(self.problem(fluids=[touching]), "")
        text = scene.files(self.with_fluid(touching))["scene.toml"].decode()
        self.assertEqual(tomllib.loads(text)["fluid"]["block"][0]["size"], [0.5, 0.5, 1])

    def with_fluid(self, fluid):
        described = simple_scene()
        described.fluids = [fluid]
        return described

    def test_boxes_become_blocks_and_other_meshes_files(self):
        described = simple_scene()
        described.fluids.append(scene.Fluid('Drop "1"', octahedron((0.7, 0.7, 0.5), 0.1).flipped(), (0, -2.0, 0)))
        described.settings = {"fluid": {"density": 1000.0}, "solver": {"wall_friction": None}, "foam": {"enabled": True}}
        files = scene.files(described)
        values = tomllib.loads(files["scene.toml"].decode())
        self.assertEqual(values["fluid"]["block"], [{"position": [0, 0, 0], "size": [0.5, 0.5, 1]}])
        self.assertEqual(values["fluid"]["mesh"], [{"mesh": "meshes/Drop_1.ply", "velocity": [0, -2, 0]}])
        self.assertEqual(values["fluid"]["density"], 1000)
        self.assertEqual(values["foam"], {"enabled": True})
        self.assertNotIn("solver", values)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "drop.ply"
            path.write_bytes(files["meshes/Drop_1.ply"])
            frame = ply.read(path)
        self.assertGreater(geometry.Mesh(frame.positions, frame.triangles).volume(), 0)

    def test_names_are_valid_and_different(self):
        taken = set()
        names = [scene.file_name(name, taken) for name in ("Cube", "cube", "Würfel.001", "***", "x" * 100)]
        self.assertEqual(len({name.lower() for name in names}), 5)
        for name in names:
            self.assertRegex(name, r"^[A-Za-z0-9_-]{1,64}$")

    def test_parts_have_the_names_of_the_users_objects(self):
        described = simple_scene()
        described.fluids += [scene.Fluid("Drop", octahedron()), scene.Fluid("Pool", cube())]
        described.bodies = [scene.Body("W_rfel", cube(), [], label="Würfel"), scene.Body("Post", cube(), [])]
        names = scene.names(described)
        expected = {
            "fluid.block[0]": 'fluid "water"',
            "fluid.mesh[0]": 'fluid "Drop"',
            "fluid.block[1]": 'fluid "Pool"',
            "body[0]": 'obstacle "Würfel"',
            'body "W_rfel"': 'obstacle "Würfel"',
            "body[1]": 'obstacle "Post"',
            'body "Post"': 'obstacle "Post"',
        }
        self.assertEqual(names, expected)
        # The blocks and meshes of the file are counted in the same order.
        described.bodies = []
        fluid = tomllib.loads(scene.files(described)["scene.toml"].decode())["fluid"]
        self.assertEqual([block["size"] for block in fluid["block"]], [[0.5, 0.5, 1], [1, 1, 1]])
        self.assertEqual([part["mesh"] for part in fluid["mesh"]], ["meshes/Drop.ply"])

    def test_the_estimate_is_the_volume_over_that_of_a_particle(self):
        self.assertAlmostEqual(scene.particles(simple_scene()), 2000, delta=1)


class Jobs(unittest.TestCase):
    def run_code(self, code):
        return Job([sys.executable, "-u", "-c", code], ".")

    def finish(self, job):
        events, end = [], time.monotonic() + 20
        while time.monotonic() < end:
            found, code = job.poll()
            events += found
            if code is not None:
                return events, code
            time.sleep(0.01)
        self.fail("the process does not end")

    def test_events_arrive_in_order_and_other_lines_are_kept(self):
        code = "import sys\nfor i in range(500): print('{\"event\": \"frame\", \"frame\": %d}' % i)\n"
        code += "print('not json'); print('[1]'); print('trouble', file=sys.stderr); sys.exit(7)"
        job = self.run_code(code)
        events, exit_code = self.finish(job)
        self.assertEqual([event["frame"] for event in events], list(range(500)))
        self.assertEqual(exit_code, 7)
        self.assertEqual(set(job.tail().splitlines()), {"not json", "[1]", "trouble"})

    def test_looking_at_a_silent_process_does_not_wait(self):
        job = self.run_code("import time; time.sleep(60)")
        start = time.monotonic()
        self.assertEqual(job.poll(), ([], None))
        self.assertLess(time.monotonic() - start, 1)
        job.stop()
        _, code = self.finish(job)
        self.assertNotEqual(code, 0)
        job.stop()
        job.kill()

    def test_a_missing_program_is_an_error(self):
        with self.assertRaises(OSError):
            Job([str(BLENDER / "no-such-program")], ".")


class Program(unittest.TestCase):
    def test_a_missing_program_is_answered_with_the_commands_of_the_readme(self):
        with self.assertRaises(program.ProgramError) as caught:
            program.find(str(BLENDER / "nowhere"))
        readme = (ROOT / "README.md").read_text("utf-8")
        for command in ("cargo install --path crates/splashdown-cli", "pip install ./crates/splashdown-py"):
            self.assertIn(command, str(caught.exception))
            self.assertIn(command, readme)

    def test_another_program_is_recognised(self):
        with self.assertRaisesRegex(program.ProgramError, "is not the program"):
            program.version(sys.executable)


class Sources(unittest.TestCase):
    def test_the_version_is_that_of_the_workspace(self):
        manifest = tomllib.loads((BLENDER / "splashdown/blender_manifest.toml").read_text("utf-8"))
        workspace = tomllib.loads((ROOT / "Cargo.toml").read_text("utf-8"))["workspace"]["package"]
        self.assertEqual(manifest["version"], workspace["version"])
        self.assertEqual(manifest["website"], workspace["repository"])
        # Limits of Blender's own validation.
        for text in (manifest["tagline"], *manifest["permissions"].values()):
            self.assertLessEqual(len(text), 64)
            self.assertRegex(text, r"\w$")

    def test_the_liquids_are_those_of_the_program(self):
        rust = (ROOT / "crates/splashdown/src/scene/materials.rs").read_text("utf-8")
        pattern = r'name: "(\w+)".*?rest_density: ([\d.e-]+),\s+viscosity: ([\d.e-]+),\s+surface_tension: ([\d.e-]+)'
        found = {name: tuple(map(float, values)) for name, *values in re.findall(pattern, rust, re.S)}
        ours = {name: (l.density, l.viscosity, l.surface_tension) for name, l in liquids.LIQUIDS.items()}
        self.assertEqual(found, ours)
        rust = (ROOT / "crates/splashdown-render/src/liquid.rs").read_text("utf-8")
        for name, liquid in liquids.LIQUIDS.items():
            match = re.search(rf"fn {name}\(\).*?Liquid::clear\(\[([^\]]+)\], ([\d.]+)\)", rust, re.S)
            self.assertEqual(tuple(map(float, match[1].split(","))), liquid.absorption)
            self.assertEqual(float(match[2]), liquid.refractive_index)

    def test_every_source_compiles_and_is_packed(self):
        for path in package.sources():
            compile(path.read_text("utf-8"), str(path), "exec")
        with tempfile.TemporaryDirectory() as folder:
            first, second = Path(folder) / "1.zip", Path(folder) / "2.zip"
            package.pack(first)
            time.sleep(0.01)
            package.pack(second)
            self.assertEqual(first.read_bytes(), second.read_bytes())
            names = zipfile.ZipFile(first).namelist()
        self.assertEqual(names, sorted(names))
        for name in ("blender_manifest.toml", "__init__.py", "core/ply.py"):
            self.assertIn(name, names)
        self.assertFalse([name for name in names if "__pycache__" in name])


if __name__ == "__main__":
    unittest.main()
