"""Headless tests of opening and showing runs."""

import io
import shutil
import tempfile
from contextlib import redirect_stdout
from pathlib import Path

import bpy
import numpy as np

import support
from blender_case import ARGUMENTS, MODULE, WORK, Case, attribute, part, ply_of, set_program, shown, table


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

    def test_objects_and_runs_of_the_same_name_are_not_mixed(self):
        other = self.cache / "more" / "dam" / "run"
        shutil.copytree(self.run_folder, other)
        scene = support.empty_scene(100)
        camera = bpy.data.objects.new("dam Post", bpy.data.cameras.new("dam Post"))
        scene.collection.objects.link(camera)
        camera.location = (1, 2, 3)
        camera.keyframe_insert("location", frame=1)
        for folder in (self.run_folder, other, self.run_folder):
            bpy.ops.splashdown.open_run(directory=str(folder))
        self.assertEqual((tuple(camera.location), camera.rotation_mode), ((1, 2, 3), "XYZ"))
        empties = [obj for obj in scene.objects if obj.type == "EMPTY"]
        self.assertEqual(
            sorted(obj.splashdown_cache.run for obj in empties), sorted([str(self.run_folder), str(other)])
        )
        self.assertEqual({obj.splashdown_cache.body for obj in empties}, {"Post"})

    def test_an_obstacle_of_another_run_is_not_moved(self):
        scene = support.dam_break(self.cache / "own", frames=2)
        post = scene.objects["Post"]
        post.splashdown.motion, post.splashdown.body_name = "DYNAMIC", "Post"
        post.splashdown.body_run = str(self.cache / "own/run")
        bpy.ops.splashdown.open_run(directory=str(self.run_folder))
        self.assertIsNone(post.animation_data)
        self.assertEqual(sum(obj.type == "EMPTY" for obj in scene.objects), 1)

    def test_times_within_a_frame_show_the_frame_before(self):
        scene, _ = self.open()
        scene.frame_set(2)
        counts = {number: len(ply_of(self.cache / "dam", "surface", number).positions) for number in (1, 5)}
        self.assertNotEqual(counts[1], counts[5])
        scene.frame_set(6, subframe=0.5)
        self.assertEqual(len(shown(scene).data.vertices), counts[5])

    def test_another_liquid_replaces_only_materials_of_the_extension(self):
        scene = support.dam_break(self.cache / "honey", frames=1)
        bpy.ops.splashdown.bake()
        scene.splashdown.material = "honey"
        bpy.ops.splashdown.bake()
        self.assertEqual(shown(scene).data.materials[0].name, "Splashdown Honey")
        modifier = shown(scene, "droplets").modifiers[0]
        self.assertIn("Splashdown Honey Droplets", [getattr(modifier.get(key), "name", "") for key in modifier.keys()])
        shown(scene).data.materials[0] = bpy.data.materials.new("Mine")
        scene.splashdown.material = "water"
        bpy.ops.splashdown.bake()
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
