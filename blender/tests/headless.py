"""Tests of the packaged extension in Blender without a window:

    python headless.py ZIP PROGRAM [--pictures FOLDER] [TEST ...]

`python` is one with the package `bpy`. Every bake is one of the program PROGRAM. Blender's settings are kept in a
temporary folder.
"""

import argparse
import csv
import io
import os
import shutil
import sys
import tempfile
import time
import unittest
from contextlib import redirect_stdout
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


def setUpModule():
    result = bpy.ops.extensions.package_install_files(
        repo="user_default", filepath=str(ARGUMENTS.zip), enable_on_install=True
    )
    assert result == {"FINISHED"} and MODULE in bpy.context.preferences.addons.keys()
    installed = Path(part("bake").__file__)
    assert installed.is_relative_to(WORK), f"the tests use {installed} instead of the package"
    set_program(ARGUMENTS.program)


def tearDownModule():
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

    def bake(self):
        self.assertEqual(bpy.ops.splashdown.bake(), {"FINISHED"})
        return part("bake").current


class Baking(Case):
    def test_a_bake_shows_the_frames_of_the_program(self):
        scene = support.dam_break(self.cache, frames=6)
        bake = self.bake()
        self.assertEqual((bake.state, bake.frames, bake.fraction), ("FINISHED", 6, 1.0))
        self.assertIn("1,152 particles", bake.estimate)
        surface = shown(scene)
        for number in (0, 3, 6):
            scene.frame_set(1 + number)
            frame = ply_of(self.cache, "surface", number)
            expected = frame.positions[:, [0, 2, 1]] * (1, -1, 1)
            # Vertices on walls are moved by a twentieth of a spacing.
            self.assertEqual(len(surface.data.polygons), len(frame.triangles))
            np.testing.assert_allclose(vertices(surface), expected, atol=0.0026)
            inside = (np.abs(vertices(surface) - expected) < 1e-6).all(axis=1)
            self.assertGreater(np.count_nonzero(inside), 100)
            self.assertLess(np.count_nonzero(inside), len(inside))
            # One frame of the run is one of the film.
            speeds = frame.velocities()[:, [0, 2, 1]] * (1, -1, 1)
            np.testing.assert_allclose(attribute(surface, "velocity", 3), speeds, rtol=1e-5, atol=1e-6)
        self.assertGreater(np.abs(speeds).max(), 0.5)
        # The surface is closed and oriented outwards in Blender's axes as well.
        mesh = part("core.geometry").Mesh(vertices(surface), [tuple(p.vertices) for p in surface.data.polygons])
        self.assertEqual(part("core.geometry").open_edges(mesh), 0)
        self.assertAlmostEqual(mesh.volume(), 0.144, delta=0.02)
        self.assertTrue(surface.data.materials[0].name.startswith("Splashdown Water"))

    def test_points_have_radii_and_become_a_point_cloud(self):
        scene = support.dam_break(self.cache, frames=9)
        self.bake()
        scene.frame_set(10)
        foam = shown(scene, "foam")
        self.assertGreater(len(foam.data.vertices), 50)
        np.testing.assert_allclose(attribute(foam, "radius", 1), part("show").DIFFUSE_RADIUS * 0.05, rtol=1e-5)
        droplets = shown(scene, "droplets")
        frame = ply_of(self.cache, "droplets", 9)
        self.assertGreater(len(frame.positions), 0)
        np.testing.assert_allclose(attribute(droplets, "radius", 1)[:, 0], frame.values["width"] / 2, rtol=1e-5)
        graph = bpy.context.evaluated_depsgraph_get()
        for obj in (foam, droplets):
            # The set owns the cloud.
            evaluated = obj.evaluated_get(graph).evaluated_geometry()
            cloud = evaluated.pointcloud
            self.assertEqual(len(cloud.points), len(obj.data.vertices))
            self.assertIn("velocity", cloud.attributes)

    def test_slow_motion_has_more_frames_per_simulated_second(self):
        scene = support.dam_break(self.cache, frames=6)
        scene.splashdown.time_scale = 0.25
        self.bake()
        scene.frame_set(7)
        self.assertAlmostEqual(part("core.run_folder").RunFolder(self.cache / "run").frame_interval(), 0.25 / 24, 6)
        frame = ply_of(self.cache, "surface", 6)
        speeds = 0.25 * np.linalg.norm(frame.velocities(), axis=1)
        np.testing.assert_allclose(
            np.linalg.norm(attribute(shown(scene), "velocity", 3), axis=1), speeds, rtol=1e-4, atol=1e-6
        )

    def test_the_unit_of_the_scene_is_respected(self):
        scene = support.empty_scene(2)
        scene.unit_settings.system, scene.unit_settings.scale_length = "METRIC", 0.01
        support.box("Tank", (0, 0, 0), (120, 60, 90), "DOMAIN")
        support.box("Column", (0, 0, 0), (40, 60, 60), "FLUID")
        scene.splashdown.cache_folder, scene.splashdown.particle_spacing = str(self.cache), 0.05
        bpy.context.view_layer.update()
        self.assertIn("1,152 particles", self.bake().estimate)
        np.testing.assert_allclose(vertices(shown(scene)).max(axis=0), (40, 60, 60), atol=3)

    def test_meshes_are_exported_with_their_transformation(self):
        counts = []
        for scale, rotation in (((1, 1, 1), (0, 0, 0)), ((-1, 1, 1), (0, 0, 0)), ((1, 1, 1), (0.4, 1, 2))):
            scene = support.dam_break(self.cache, frames=1)
            bpy.data.objects.remove(scene.objects["Column"])
            ball = support.sphere("Ball", (0.3, 0.3, 0.3), 0.2, "FLUID")
            ball.scale, ball.rotation_euler = scale, rotation
            bpy.context.view_layer.update()
            bpy.ops.splashdown.check()
            estimate = part("bake").current.estimate
            counts.append(int(estimate.split(" particles")[0].replace(",", "")))
        # 4/3 pi 0.2^3 / 0.05^3 = 268, less for a mesh of 24 by 12 faces.
        for count in counts:
            self.assertAlmostEqual(count, 262, delta=20)

    def test_an_animated_obstacle_moves_as_in_blender(self):
        scene = support.dam_break(self.cache, frames=6)
        post = scene.objects["Post"]
        post.rotation_mode = "XYZ"
        for frame, angle, x in ((1, 0.0, 0.85), (4, 0.9, 0.8), (7, 1.4, 0.95)):
            post.rotation_euler = (0.2 * angle, 0.1, angle)
            post.location.x = x
            post.keyframe_insert("rotation_euler", frame=frame)
            post.keyframe_insert("location", frame=frame)
        before = scene.frame_current
        self.bake()
        self.assertEqual(scene.frame_current, before)
        times, positions, quaternions = table(self.cache / "run/bodies/Post.csv")
        self.assertEqual(len(times), 7)
        turned = part("core.axes")
        for number in range(7):
            scene.frame_set(1 + number)
            location, rotation, _ = post.matrix_world.decompose()
            np.testing.assert_allclose(turned.to_blender(positions[number]), location, atol=1e-5)
            there = turned.quaternion_to_blender(quaternions[number])
            self.assertAlmostEqual(abs(np.dot(there, rotation)), 1, 5)
        # It moved at all.
        self.assertGreater(np.ptp(positions[:, 0]), 0.1)

    def test_an_obstacle_that_the_fluid_moves_gets_keyframes(self):
        scene = support.dam_break(self.cache, frames=9)
        post = scene.objects["Post"]
        post.location.z += 0.3
        post.rotation_euler.z = 0.5
        post.splashdown.motion, post.splashdown.density = "DYNAMIC", 300
        bpy.context.view_layer.update()
        rest = post.matrix_world.copy()
        self.bake()
        scene.frame_set(1)
        np.testing.assert_allclose(np.array(post.matrix_world), np.array(rest), atol=1e-5)
        _, positions, quaternions = table(self.cache / "run/bodies/Post.csv")
        scene.frame_set(10)
        location, rotation, scale = post.matrix_world.decompose()
        np.testing.assert_allclose(part("core.axes").to_blender(positions[9]), location, atol=1e-5)
        there = part("core.axes").quaternion_to_blender(quaternions[9])
        self.assertAlmostEqual(abs(np.dot(there, rotation)), 1, 5)
        np.testing.assert_allclose(scale, rest.to_scale(), rtol=1e-5)
        self.assertLess(location.z, rest.translation.z - 0.1)
        # A second bake starts from the same pose.
        first = (self.cache / "scene.toml").read_text()
        self.bake()
        second = (self.cache / "scene.toml").read_text()
        self.assertEqual(first.count("\n"), second.count("\n"))
        bpy.ops.splashdown.restore()
        bpy.context.view_layer.update()
        np.testing.assert_allclose(np.array(post.matrix_world), np.array(rest), atol=1e-6)
        self.assertIsNone(post.animation_data)

    def test_emitters_add_and_outflows_remove_fluid(self):
        scene = support.dam_break(self.cache, frames=12, spacing=0.04)
        bpy.data.objects.remove(scene.objects["Column"])
        bpy.ops.mesh.primitive_plane_add(size=0.2, location=(0.3, 0.3, 0.5), rotation=(0, 1.2, 0))
        tap = bpy.context.object
        tap.splashdown.role, tap.splashdown.speed = "EMITTER", 2.0
        bpy.context.view_layer.update()
        self.bake()
        # 0.2 m x 0.2 m x 2 m/s x 0.5 s / (0.04 m)^3
        particles = ply_of(self.cache, "particles", 12).positions
        self.assertAlmostEqual(len(particles), 625, delta=60)
        # The normal points towards +x and up.
        self.assertGreater(particles[:, 0].mean(), 0.4)
        support.box("Drain", (0.5, 0, 0), (1.2, 0.6, 0.9), "OUTFLOW")
        bpy.context.view_layer.update()
        self.bake()
        drained = ply_of(self.cache, "particles", 12).positions
        self.assertLess(len(drained), 0.8 * len(particles))
        self.assertLess(drained[:, 0].max(), 0.55)


class Cancelling(Case):
    def start(self, frames):
        scene = support.dam_break(self.cache, frames=frames)
        scene.splashdown.use_foam = False
        return scene, part("bake").start(bpy.context)

    def run_until(self, bake, condition):
        end = time.monotonic() + 120
        while not condition() and bake.update():
            self.assertLess(time.monotonic(), end, "the bake does not go on")
            time.sleep(0.005)

    def test_a_cancelled_bake_keeps_its_frames_and_can_be_resumed(self):
        scene, bake = self.start(40)
        self.run_until(bake, lambda: (bake.frame or 0) >= 3)
        self.assertTrue(part("bake").active())
        self.assertFalse(bpy.ops.splashdown.bake.poll())
        bpy.ops.splashdown.cancel()
        self.assertIn("Stopping", bake.text())
        self.run_until(bake, lambda: False)
        self.assertEqual(bake.state, "STOPPED")
        run = part("core.run_folder").RunFolder(self.cache / "run")
        self.assertEqual(run.problems(), [])
        self.assertGreaterEqual(run.last(), 3)
        self.assertLess(run.last(), 40)
        scene.frame_set(1 + run.last())
        self.assertGreater(len(shown(scene).data.vertices), 1000)
        self.assertEqual(bpy.ops.splashdown.resume(), {"FINISHED"})
        self.assertEqual(part("bake").current.state, "FINISHED")
        whole = self.cache / "whole"
        resumed = (self.cache / "run/mesh/surface_0040.ply").read_bytes()
        scene.splashdown.cache_folder = str(whole)
        self.bake()
        self.assertEqual((whole / "run/mesh/surface_0040.ply").read_bytes(), resumed)

    def test_a_second_cancel_ends_the_program_at_once(self):
        _, bake = self.start(2000)
        self.run_until(bake, lambda: (bake.frame or 0) >= 1)
        bake.cancel()
        bake.cancel()
        self.run_until(bake, lambda: False)
        self.assertEqual(bake.state, "STOPPED")
        with self.assertRaises(ProcessLookupError):
            os.kill(bake.job.pid, 0)

    def test_opening_another_file_ends_the_program(self):
        _, bake = self.start(2000)
        self.run_until(bake, lambda: (bake.frame or 0) >= 1)
        job = bake.job
        support.empty_scene()
        self.assertFalse(part("bake").active())
        job.wait(60)

    def test_there_is_nothing_to_resume_without_a_checkpoint(self):
        support.dam_break(self.cache)
        self.assertIn("nothing to resume", self.refused(bpy.ops.splashdown.resume))


class Refusals(Case):
    def test_all_problems_of_a_scene_are_reported_at_once(self):
        scene = support.empty_scene()
        scene.splashdown.cache_folder = str(self.cache)
        text = self.refused(bpy.ops.splashdown.bake)
        self.assertIn("There is no domain", text)
        self.assertIn("There is no fluid", text)
        self.assertEqual(list(self.cache.iterdir()), [])

    def test_objects_that_cannot_be_used_are_named(self):
        def rotated(scene):
            scene.objects["Tank"].rotation_euler.z = 0.3

        def second(scene):
            support.box("Other", (0, 0, 0), (1, 1, 1), "DOMAIN")

        def outside(scene):
            scene.objects["Column"].location.x = 5

        def opened(scene):
            mesh = scene.objects["Column"].data
            corners = np.array([vertex.co for vertex in mesh.vertices])
            faces = [tuple(face.vertices) for face in mesh.polygons][1:]
            scene.objects["Column"].data = bpy.data.meshes.new("open")
            scene.objects["Column"].data.from_pydata(corners.tolist(), [], faces)

        def parented(scene):
            scene.objects["Post"].splashdown.motion = "DYNAMIC"
            scene.objects["Post"].parent = scene.objects["Tank"]

        def solid(scene):
            support.sphere("Tap", (0.5, 0.3, 0.5), 0.1, "EMITTER")

        def growing(scene):
            for frame in (1, 5):
                scene.objects["Post"].scale.x = 0.02 * frame
                scene.objects["Post"].keyframe_insert("scale", frame=frame)

        def backwards(scene):
            scene.frame_end = scene.frame_start

        cases = [
            (rotated, '"Tank" is not a box along the axes'),
            (second, "There are 2 domains"),
            (outside, '"Column" is outside the domain'),
            (opened, '"Column" is not closed: 4 edges'),
            (parented, '"Post" is moved by the fluid, but has a parent'),
            (solid, '"Tap" is not flat'),
            (growing, '"Post" changes its size'),
            (backwards, "The frame range is empty"),
        ]
        for change, words in cases:
            with self.subTest(change.__name__):
                scene = support.dam_break(self.cache)
                change(scene)
                bpy.context.view_layer.update()
                self.assertIn(words, self.refused(bpy.ops.splashdown.bake))

    def test_too_many_particles_are_refused_before_the_start(self):
        scene = support.dam_break(self.cache)
        scene.splashdown.max_particles = 0.001
        self.assertIn("1,152 particles", self.refused(bpy.ops.splashdown.bake))
        self.assertFalse((self.cache / "run").exists())

    def test_a_relative_cache_needs_a_saved_file(self):
        support.dam_break("//cache")
        self.assertIn("Save the .blend file first", self.refused(bpy.ops.splashdown.bake))

    def test_a_missing_program_is_answered_with_instructions(self):
        support.dam_break(self.cache)
        set_program(self.cache / "nowhere")
        text = self.refused(bpy.ops.splashdown.bake)
        self.assertIn("cargo install --path crates/splashdown-cli", text)
        self.assertIn("pip install ./crates/splashdown-py", text)

    def test_errors_of_the_program_are_shown(self):
        scene = support.dam_break(self.cache)
        scene.splashdown.device = "no such device"
        text = self.refused(bpy.ops.splashdown.bake)
        self.assertIn("no such device", text)
        self.assertIn("exit code 4", text)
        set_program(shutil.which("false"))
        self.assertIn("exit code 1", self.refused(bpy.ops.splashdown.bake))

    def test_a_cache_that_cannot_be_written_is_reported(self):
        file = self.cache / "file"
        file.write_text("")
        support.dam_break(file / "cache")
        self.assertIn("cannot be written", self.refused(bpy.ops.splashdown.bake))


class Opening(Case):
    @classmethod
    def setUpClass(cls):
        cls.original = Path(tempfile.mkdtemp(dir=WORK))
        set_program(ARGUMENTS.program)
        scene = support.dam_break(cls.original, frames=8)
        post = scene.objects["Post"]
        post.splashdown.motion = "DYNAMIC"
        bpy.ops.splashdown.bake()

    def setUp(self):
        super().setUp()
        self.run_folder = self.cache / "dam" / "run"
        shutil.copytree(self.original, self.cache / "dam")

    def open(self):
        """The scene, and what opening printed."""
        scene = support.empty_scene(100)
        output = io.StringIO()
        with redirect_stdout(output):
            self.assertEqual(bpy.ops.splashdown.open_run(directory=str(self.run_folder)), {"FINISHED"})
        return scene, output.getvalue()

    def test_a_run_is_shown_with_its_bodies(self):
        scene, output = self.open()
        self.assertEqual(output.count("Splashdown:"), 0, output)
        self.assertEqual(scene.frame_end, 9)
        scene.frame_set(6)
        surface = shown(scene)
        self.assertEqual(len(surface.data.vertices), len(ply_of(self.cache / "dam", "surface", 5).positions))
        self.assertAlmostEqual(surface.splashdown_cache.frame_interval, 1 / 24, 5)
        self.assertAlmostEqual(surface.splashdown_cache.wall_overlap, 0.0025, 5)
        empty = scene.objects["dam Post"]
        _, positions, _ = table(self.run_folder / "bodies/Post.csv")
        np.testing.assert_allclose(empty.matrix_world.translation, part("core.axes").to_blender(positions[5]), atol=1e-5)

    def test_opening_twice_makes_no_second_objects(self):
        scene, _ = self.open()
        before = sorted(obj.name for obj in scene.objects)
        shown(scene).data.materials[0] = bpy.data.materials.new("Mine")
        bpy.ops.splashdown.open_run(directory=str(self.run_folder))
        self.assertEqual(sorted(obj.name for obj in scene.objects), before)
        self.assertEqual(shown(scene).data.materials[0].name, "Mine")

    def test_damaged_runs_show_what_exists_and_report_once(self):
        (self.run_folder / "mesh/surface_0002.ply").unlink()
        broken = self.run_folder / "mesh/surface_0005.ply"
        broken.write_bytes(broken.read_bytes()[:-100])
        (self.run_folder / "droplets/droplets_0004.ply").unlink()
        (self.run_folder / "run.json").write_text("{")
        scene, output = self.open()
        self.assertIn("run.json cannot be read", output)
        for words in ("frame 2 missing", "frame 5 of surface cannot be read (it is truncated", "frame 4 without droplets"):
            self.assertEqual(output.count(words), 1, output)
        surface = shown(scene)
        note = surface.splashdown_cache.note
        later = io.StringIO()
        with redirect_stdout(later):
            for number in (1, 2, 4, 5, 2, 5, 5):
                scene.frame_set(1 + number)
                existing = {2: 1, 5: 4}.get(number, number)
                self.assertEqual(
                    len(surface.data.vertices), len(ply_of(self.cache / "dam", "surface", existing).positions), number
                )
                # A frame that stands in for another one does not move.
                speed = np.abs(attribute(surface, "velocity", 3)).max()
                self.assertEqual(speed == 0, existing != number)
        # The file is named when it is shown for the first time, and then no more.
        self.assertLessEqual(later.getvalue().count("Splashdown:"), 1)
        self.assertIn("frame 2 missing", note)
        scene.frame_set(5)
        self.assertEqual(len(shown(scene, "droplets").data.vertices), 0)

    def test_nothing_is_shown_before_the_first_frame(self):
        scene, _ = self.open()
        shown(scene).splashdown_cache.start_frame = 5
        self.assertEqual({obj.splashdown_cache.start_frame for obj in part("playback").shown_objects(scene)}, {5})
        scene.frame_set(4)
        self.assertEqual(len(shown(scene).data.vertices), 0)
        scene.frame_set(5)
        self.assertGreater(len(shown(scene).data.vertices), 1000)

    def test_a_run_without_a_surface_shows_particles(self):
        shutil.rmtree(self.run_folder / "mesh")
        scene, _ = self.open()
        scene.frame_set(3)
        self.assertEqual(len(shown(scene, "particles").data.vertices), 1152)
        np.testing.assert_allclose(attribute(shown(scene, "particles"), "radius", 1), 0.025, rtol=1e-5)

    def test_other_folders_are_refused(self):
        support.empty_scene()
        text = self.refused(bpy.ops.splashdown.open_run, directory=str(self.cache))
        self.assertIn("has no frames in PLY files", text)
        text = self.refused(bpy.ops.splashdown.open_run, directory=str(self.cache / "nowhere"))
        self.assertIn("it is not a folder", text)
        self.assertEqual(len(bpy.context.scene.objects), 0)

    def test_a_saved_file_plays_after_it_is_opened_again(self):
        scene, _ = self.open()
        scene.frame_set(3)
        count = len(shown(scene).data.vertices)
        blend = self.cache / "saved.blend"
        shown(scene).splashdown_cache.run = "//dam/run"
        bpy.ops.wm.save_as_mainfile(filepath=str(blend))
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        bpy.ops.wm.open_mainfile(filepath=str(blend))
        scene = bpy.context.scene
        self.assertEqual(len(shown(scene).data.vertices), count)
        scene.frame_set(8)
        frame = ply_of(self.cache / "dam", "surface", 7)
        self.assertEqual(len(shown(scene).data.vertices), len(frame.positions))
        self.assertNotEqual(len(frame.positions), count)
        # Without the run the file shows its last frame, and says why.
        shutil.rmtree(self.run_folder / "mesh")
        shutil.rmtree(self.run_folder / "particles")
        with redirect_stdout(io.StringIO()):
            bpy.ops.wm.open_mainfile(filepath=str(blend))
        self.assertEqual(len(shown(bpy.context.scene).data.vertices), count)
        self.assertIn("no frames", shown(bpy.context.scene).splashdown_cache.note)

    def test_the_extension_can_be_disabled_and_enabled(self):
        def handlers():
            ours = [f for f in bpy.app.handlers.frame_change_pre if f.__module__.startswith(MODULE)]
            return len(ours)

        self.assertEqual(handlers(), 1)
        bpy.ops.preferences.addon_disable(module=MODULE)
        self.assertEqual(handlers(), 0)
        self.assertFalse(hasattr(bpy.types.Scene, "splashdown"))
        bpy.ops.preferences.addon_enable(module=MODULE)
        self.assertEqual(handlers(), 1)


class Rendering(Case):
    def test_motion_blurs_the_water_and_nothing_else(self):
        scene = support.dam_break(self.cache, frames=9)
        self.bake()
        scene.frame_set(10)
        support.studio(scene, (2.1, -1.7, 1.0), (0.6, 0.3, 0.25), size=(160, 100), samples=16)
        scene.cycles.use_denoising = False
        scene.render.motion_blur_shutter = 1
        for obj in part("playback").shown_objects(scene):
            support.glow(obj)
        support.glow(scene.objects["Post"], (0, 0, 0))
        # The floor is black, so that all light comes from the liquid.
        support.glow(scene.objects["Floor"], (0, 0, 0))
        scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
        scene.objects["Sun"].hide_render = True

        def sharpness(blur, series):
            for obj in part("playback").shown_objects(scene):
                obj.hide_render = obj.splashdown_cache.series not in series
            scene.render.use_motion_blur = blur
            picture = support.render(scene, self.cache / "frame.exr")
            across, along = np.diff(picture, axis=0), np.diff(picture, axis=1)
            # Of a picture with the same total light, a blurred one has smaller squares of differences.
            return float((across**2).sum() + (along**2).sum()) / float(picture.sum()), picture

        for series in ({"surface"}, {"foam", "spray", "droplets"}):
            sharp, still = sharpness(False, series)
            blurred, moving = sharpness(True, series)
            self.assertGreater(still.sum(), 10)
            self.assertLess(blurred, 0.85 * sharp, series)
            # Blur distributes the light; it does not remove it.
            self.assertAlmostEqual(moving.sum() / still.sum(), 1, delta=0.25)
            self.assertEqual(scene.frame_current, 10)
        # The negative control: without velocities the same frame is as sharp as without motion blur.
        for obj in part("playback").shown_objects(scene):
            data = obj.data.attributes["velocity"].data
            data.foreach_set("vector", np.zeros(3 * len(data), np.float32))
            obj.data.update()
        sharp, _ = sharpness(False, {"surface"})
        resting, _ = sharpness(True, {"surface"})
        self.assertAlmostEqual(resting / sharp, 1, delta=0.03)

    def test_water_lets_light_through(self):
        scene = support.dam_break(self.cache, frames=1)
        self.bake()
        support.studio(scene, (0.2, 0.3, 4.0), (0.2, 0.301, 0), size=(64, 64), samples=32)
        scene.cycles.use_denoising = False
        picture = support.render(scene, self.cache / "frame.exr")
        inside, outside = picture[28:36, 28:36].mean(), picture[:4].mean()
        # The floor below 0.6 m of water is darker than the dry one, and not black.
        self.assertGreater(inside, 0.35 * outside)
        self.assertLess(inside, 1.1 * outside)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("zip", type=Path)
    parser.add_argument("program", type=Path)
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("tests", nargs="*")
    parsed = parser.parse_args()
    ARGUMENTS.zip, ARGUMENTS.program = parsed.zip.resolve(), parsed.program.resolve()
    if parsed.pictures:
        setUpModule()
        import pictures

        pictures.draw(parsed.pictures.resolve(), WORK)
        tearDownModule()
    else:
        unittest.main(argv=[sys.argv[0], "-v", *parsed.tests])
