"""Headless tests of starting, refusing, cancelling and resuming bakes."""

import os
import shutil
import time

import bpy
import numpy as np

import support
from blender_case import Case, part, set_program, shown


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
