"""Headless tests of starting, refusing, cancelling and resuming bakes."""

import os
import time
from pathlib import Path

import bpy
import numpy as np

import support
from blender_case import MODULE, Case, part, set_program, shown, shown_or_none, table


class Cancelling(Case):
    def test_a_cancelled_bake_keeps_its_frames_and_can_be_resumed(self):
        scene, bake = self.start(40)
        self.run_until(bake, lambda: (bake.frame or 0) >= 3)
        self.assertTrue(part("bake").active())
        self.assertFalse(bpy.ops.splashdown.bake.poll())
        bpy.ops.splashdown.cancel()
        self.assertIn("Stopping", bake.text())
        self.run_until(bake)
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
        self.run_until(bake)
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

    def test_a_mesh_in_edit_mode_does_not_stop_a_bake(self):
        scene = support.dam_break(self.cache, frames=8)
        scene.frame_set(9)
        bake = part("bake").start(bpy.context)
        self.run_until(bake, lambda: shown_or_none(scene) is not None)
        surface = shown(scene)
        bpy.context.view_layer.objects.active = surface
        bpy.ops.object.mode_set(mode="EDIT")
        self.run_until(bake)
        self.assertEqual((bake.state, bake.errors), ("FINISHED", []))
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(len(surface.data.vertices), 0)
        scene.frame_set(8)
        count = len(surface.data.vertices)
        self.assertGreater(count, 1000)
        # Nor does Edit Mode lose the mesh when the frame changes.
        bpy.ops.object.mode_set(mode="EDIT")
        scene.frame_set(2)
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(len(surface.data.vertices), count)
        scene.frame_set(3)
        self.assertNotEqual(len(surface.data.vertices), count)

    def test_undo_during_a_bake_does_not_lose_the_result(self):
        scene = support.dam_break(self.cache, frames=12)
        scene.objects["Post"].splashdown.motion = "DYNAMIC"
        bpy.ops.ed.undo_push(message="before")
        scene.objects["Tank"].name = "Basin"
        bpy.ops.ed.undo_push(message="renamed")
        bake = part("bake").start(bpy.context)
        self.run_until(bake, lambda: (bake.frame or 0) >= 2)
        self.assertIsNotNone(shown_or_none(bpy.context.scene))
        bpy.ops.ed.undo()
        scene = bpy.context.scene
        # The control: the undo has removed the objects and the names in the run.
        self.assertIsNone(shown_or_none(scene))
        self.assertEqual(scene.objects["Post"].splashdown.body_name, "")
        self.run_until(bake)
        self.assertEqual((bake.state, bake.errors), ("FINISHED", []))
        scene.frame_set(13)
        self.assertGreater(len(shown(scene).data.vertices), 1000)
        post = scene.objects["Post"]
        self.assertEqual(post.splashdown.body_name, "Post")
        _, positions, _ = table(self.cache / "run/bodies/Post.csv")
        np.testing.assert_allclose(post.location, part("core.axes").to_blender(positions[12]), atol=1e-5)

    def test_a_bake_is_an_undo_step_of_its_own(self):
        support.dam_break(self.cache, frames=2)
        bpy.ops.ed.undo_push(message="before")
        self.bake()
        bpy.context.scene.objects["Tank"].name = "Basin"
        bpy.ops.ed.undo_push(message="renamed")
        bpy.ops.ed.undo()
        self.assertIn("Tank", bpy.context.scene.objects)
        self.assertIsNotNone(shown_or_none(bpy.context.scene))
        bpy.ops.ed.undo()
        self.assertIsNone(shown_or_none(bpy.context.scene))
        bpy.ops.ed.redo()
        self.assertIsNotNone(shown_or_none(bpy.context.scene))

    def test_settings_are_those_of_the_start(self):
        scene, bake = self.start(4)
        scene.splashdown.cache_folder = str(self.cache / "other")
        scene.frame_start, scene.unit_settings.scale_length = 20, 0.5
        self.run_until(bake)
        cache = shown(scene).splashdown_cache
        self.assertEqual((Path(cache.run), cache.start_frame, cache.metres_per_unit), (self.cache / "run", 1, 1))

    def test_the_result_is_found_after_saving_in_another_folder_during_a_bake(self):
        for name in ("one", "two"):
            (self.cache / name).mkdir()
        scene = support.dam_break("//water", frames=12)
        bpy.ops.wm.save_as_mainfile(filepath=str(self.cache / "one/a.blend"))
        bake = part("bake").start(bpy.context)
        self.run_until(bake, lambda: (bake.frame or 0) >= 1)
        self.assertEqual(shown(scene).splashdown_cache.run, "//water/run")
        bpy.ops.wm.save_as_mainfile(filepath=str(self.cache / "two/a.blend"))
        self.run_until(bake)
        self.assertEqual(bake.state, "FINISHED")
        scene.frame_set(13)
        self.assertEqual(Path(shown(scene).splashdown_cache.run), self.cache / "one/water/run")
        self.assertEqual(sum(obj.splashdown_cache.series == "surface" for obj in scene.objects), 1)
        self.assertGreater(len(shown(scene).data.vertices), 1000)

    def test_a_resumed_run_is_shown_with_its_own_settings(self):
        scene, bake = self.start(40)
        scene.objects["Post"].splashdown.motion = "DYNAMIC"
        self.run_until(bake, lambda: (bake.frame or 0) >= 11)
        bake.cancel()
        self.run_until(bake)
        self.assertEqual(bake.state, "STOPPED")
        settings = scene.splashdown
        settings.particle_spacing, settings.material, scene.render.fps = 0.08, "honey", 48
        scene.frame_start, scene.objects["Tank"].location.x = 11, 7
        bpy.context.view_layer.update()
        self.assertEqual(bpy.ops.splashdown.resume(), {"FINISHED"})
        cache = shown(scene).splashdown_cache
        self.assertEqual(cache.start_frame, 1)
        self.assertAlmostEqual(cache.frame_interval, 1 / 24, 6)
        self.assertAlmostEqual(cache.wall_overlap, 0.0025, 6)
        np.testing.assert_allclose(cache.wall_high, (1.2, 0.9, 0), atol=1e-6)
        self.assertIn("Water", shown(scene).data.materials[0].name)
        self.assertIn("is finished", self.refused(bpy.ops.splashdown.resume))

    def test_a_resumed_run_moves_obstacles_of_a_file_that_was_not_saved_since(self):
        scene, bake = self.start(30)
        post = scene.objects["Post"]
        post.splashdown.motion = "DYNAMIC"
        bake.cancel()
        bake.cancel()
        self.run_until(bake)
        bake = part("bake").start(bpy.context)
        self.run_until(bake, lambda: (bake.frame or 0) >= 11)
        # As if Blender had been killed and the file from before the bake were open.
        bake.abandon(30)
        part("bake").current = None
        post.splashdown.body_name = post.splashdown.body_run = ""
        self.assertIsNone(post.animation_data)
        self.assertEqual(bpy.ops.splashdown.resume(), {"FINISHED"})
        self.assertIsNotNone(post.animation_data)

    def test_the_timer_waits_while_a_render_reads_the_meshes(self):
        scene, bake = self.start(3)
        playback = part("playback")
        original = playback.is_rendering
        try:
            playback.is_rendering = lambda: True
            bake.job.wait(60)
            self.assertEqual(part("bake")._tick(), part("bake").INTERVAL)
            self.assertEqual((bake.state, bake.estimate), ("CHECKING", ""))
        finally:
            playback.is_rendering = original
        end = time.monotonic() + 60
        while part("bake")._tick() is not None:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)
        self.assertEqual(bake.state, "FINISHED")
        self.assertIsNotNone(shown_or_none(scene))

    def test_a_failed_run_moves_obstacles_as_far_as_it_came(self):
        scene = support.dam_break(self.cache, frames=2000)
        post = scene.objects["Post"]
        post.splashdown.motion = "DYNAMIC"
        bake = part("bake").start(bpy.context)
        self.run_until(bake, lambda: (bake.frame or 0) >= 3)
        bake.job.kill()
        self.run_until(bake)
        self.assertEqual(bake.state, "FAILED")
        self.assertIn("SIGKILL", bake.errors[-1])
        self.assertIsNotNone(post.animation_data)

    def test_quitting_waits_for_the_program(self):
        _, bake = self.start(2000)
        self.run_until(bake, lambda: (bake.frame or 0) >= 1)
        bpy.ops.preferences.addon_disable(module=MODULE)
        try:
            with self.assertRaises(ProcessLookupError):
                os.kill(bake.job.pid, 0)
        finally:
            bpy.ops.preferences.addon_enable(module=MODULE)

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

    def test_too_many_emitted_particles_are_refused(self):
        scene = support.dam_break(self.cache, frames=24)
        bpy.data.objects.remove(scene.objects["Column"])
        bpy.ops.mesh.primitive_plane_add(size=0.3, location=(0.3, 0.3, 0.5))
        tap = bpy.context.object
        tap.splashdown.role, tap.splashdown.speed = "EMITTER", 2
        scene.splashdown.max_particles = 0.001
        bpy.context.view_layer.update()
        self.assertIn("limit of 1,000", self.refused(bpy.ops.splashdown.bake))
        self.assertFalse((self.cache / "run").exists())

    def test_the_scene_of_a_bake_is_not_changed_by_a_check_or_a_second_bake(self):
        scene, bake = self.start(2000)
        self.run_until(bake, lambda: (bake.frame or 0) >= 1)
        before = (self.cache / "scene.toml").read_bytes()
        scene.splashdown.particle_spacing = 0.06
        # What another Blender does.
        other = part("bake").Bake
        with self.assertRaisesRegex(part("bake").Failed, "Another simulation writes"):
            other(bpy.context)
        check = other(bpy.context, only_check=True)
        self.run_until(check)
        self.assertEqual(check.state, "CHECKED")
        self.assertEqual((self.cache / "scene.toml").read_bytes(), before)
        bake.cancel()
        bake.cancel()
        self.run_until(bake)
        # It is a change of the scene: without a lock a bake writes another file.
        scene.frame_end = 2
        self.bake()
        self.assertNotEqual((self.cache / "scene.toml").read_bytes(), before)

    def test_a_cache_in_the_home_folder_is_found(self):
        before = os.environ["HOME"]
        os.environ["HOME"] = str(self.cache)
        self.addCleanup(os.environ.__setitem__, "HOME", before)
        scene = support.dam_break("~/water", frames=1)
        self.bake()
        self.assertTrue((self.cache / "water/run/run.json").is_file())
        self.assertEqual(Path(shown(scene).splashdown_cache.run), self.cache / "water/run")

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
        set_program(self.script('echo trouble >&2; exit 1'))
        text = self.refused(bpy.ops.splashdown.bake)
        self.assertIn("trouble", text)
        self.assertIn("exit code 1", text)

    def test_another_program_or_version_does_not_start(self):
        support.dam_break(self.cache)
        path = self.script("")
        for text, words in (("exit 0", "is not the program"), ("echo splashdown 0.0.1", "has version 0.0.1")):
            path.write_text(f"#!/bin/sh\n{text}\n")
            set_program(path)
            self.assertIn(words, self.refused(bpy.ops.splashdown.bake))
            # The panel shows it as well.
            self.assertIn(words, part("bake").refusal)

    def test_a_cache_that_cannot_be_written_is_reported(self):
        file = self.cache / "file"
        file.write_text("")
        support.dam_break(file / "cache")
        self.assertIn("cannot be written", self.refused(bpy.ops.splashdown.bake))
