"""Headless tests of opening and showing runs."""

import io
import shutil
import subprocess
import tempfile
from contextlib import redirect_stdout
from pathlib import Path

import bpy
import numpy as np

import support
from blender_case import ARGUMENTS, MODULE, WORK, Case, attribute, part, ply_of, set_program, shown, table, vertices


# A falling block and water in a tank whose gravity is along -z, with 50 frames per second.
UPRIGHT = """
[scene]
name = "upright"
duration = 0.08
frame_rate = 50
gravity = [0, 0, -9.81]
[domain]
min = [0, 0, 0]
max = [0.6, 0.3, 0.5]
[fluid]
particle_spacing = 0.05
[[fluid.block]]
position = [0, 0, 0]
size = [0.3, 0.3, 0.2]
[[body]]
name = "block"
mesh = "cube"
scale = [0.1, 0.1, 0.2]
position = [0.45, 0.15, 0.3]
rotation = [0, 0, 20]
motion = "dynamic"
density = 500
colour = [0.8, 0.2, 0.1]
"""


class OtherRuns(Case):
    """Runs that the extension has not baked."""

    def setUp(self):
        super().setUp()
        (self.cache / "upright.toml").write_text(UPRIGHT)
        words = ["run", "upright.toml", "--device", "cpu", "--no-pictures", "--out", "out"]
        subprocess.run([ARGUMENTS.program, *words], cwd=self.cache, check=True, capture_output=True)

    def open(self, **options):
        scene = support.empty_scene(100)
        with redirect_stdout(io.StringIO()):
            bpy.ops.splashdown.open_run(directory=str(self.cache / "out"), **options)
        return scene

    def test_the_axis_against_gravity_is_up(self):
        scene = self.open()
        water, block = shown(scene), scene.objects["out block"]
        for number, bottom in ((0, 0.2), (4, 0.2 - 0.5 * 9.81 * 0.08**2)):
            scene.frame_set(scene.frame_start + number)
            heights = vertices(water)[:, 2]
            self.assertLess(heights.max(), 0.25)
            self.assertAlmostEqual(float(heights.min()), -water.splashdown_cache.wall_overlap, delta=0.02)
            corners = support.world_vertices(block)
            self.assertAlmostEqual(corners[:, 2].min(), bottom, delta=0.005)
            self.assertAlmostEqual(np.ptp(corners[:, 2]), 0.2, 4)
            np.testing.assert_allclose(corners[:, :2].mean(axis=0), (0.45, 0.15), atol=0.005)
            # A square that is turned by 20 degrees.
            width = 0.1 * (np.cos(np.radians(20)) + np.sin(np.radians(20)))
            np.testing.assert_allclose(np.ptp(corners[:, :2], axis=0), width, atol=1e-3)
        speed = attribute(water, "velocity", 3)[:, 2].mean()
        self.assertLess(speed, 0)
        self.assertEqual(block.data.materials[0].name, "Splashdown Body 0.8 0.2 0.1")
        # Without its report the run is upright as well, by the scene in its checkpoint or its scene file.
        (self.cache / "out/run.json").unlink()
        if part("core.run_folder").scene_of(self.cache / "out"):
            self.assertEqual(shown(self.open()).splashdown_cache.up, "Z")

    def test_the_scene_gets_the_frame_rate_of_the_run(self):
        scene = self.open()
        self.assertEqual((scene.render.fps, scene.render.fps_base), (50, 1))
        self.assertAlmostEqual(part("playback").pace(shown(scene), scene), 1, 5)
        scene = self.open(fit_rate=False)
        self.assertEqual(scene.render.fps, 24)
        text = part("playback").pace_text(shown(scene), scene)
        self.assertEqual(
            text, "The run has 50 frames per second and the scene 24: it plays at 0.48 times its speed"
        )
        rates = part("open_run").frame_rate
        self.assertEqual(rates(1 / 30), (30, 1.0))
        fps, base = rates(1.001 / 24)
        self.assertEqual(fps, 24)
        self.assertAlmostEqual(base, 1.001, 9)

    def test_a_second_run_leaves_the_frame_rate(self):
        scene = self.open()
        scene.render.fps = 25
        shutil.copytree(self.cache / "out", self.cache / "other")
        with redirect_stdout(io.StringIO()):
            bpy.ops.splashdown.open_run(directory=str(self.cache / "other"))
        self.assertEqual(scene.render.fps, 25)


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
        body = scene.objects["dam Post"]
        _, positions, _ = table(self.run_folder / "bodies/Post.csv")
        np.testing.assert_allclose(body.matrix_world.translation, part("core.axes").to_blender(positions[5]), atol=1e-5)
        low, high = (support.world_vertices(body).min(axis=0), support.world_vertices(body).max(axis=0))
        # It has drifted and turned a little since the start.
        np.testing.assert_allclose(high - low, (0.1, 0.2, 0.35), atol=0.1)
        self.assertEqual((len(body.data.polygons), body.data.materials[0].name), (12, "Splashdown Body"))

    def test_opening_twice_makes_no_second_objects(self):
        scene, _ = self.open()
        before = sorted(obj.name for obj in scene.objects)
        shown(scene).data.materials[0] = bpy.data.materials.new("Mine")
        bpy.ops.splashdown.open_run(directory=str(self.run_folder))
        self.assertEqual(sorted(obj.name for obj in scene.objects), before)
        self.assertEqual(shown(scene).data.materials[0].name, "Mine")

    def test_foam_is_as_large_as_in_the_pictures_of_the_program(self):
        scene, _ = self.open()
        radii = {"spray": 0.13, "foam": 0.25, "bubbles": 0.16}
        for series, radius in radii.items():
            cache = shown(scene, series).splashdown_cache
            self.assertAlmostEqual(cache.radius / 0.05, radius, 5, series)

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
        bodies = [obj for obj in scene.objects if obj.splashdown_cache.body]
        self.assertEqual(sorted(obj.splashdown_cache.run for obj in bodies), sorted([str(self.run_folder), str(other)]))
        self.assertEqual({obj.splashdown_cache.body for obj in bodies}, {"Post"})

    def test_an_obstacle_of_another_run_is_not_moved(self):
        scene = support.dam_break(self.cache / "own", frames=2)
        post = scene.objects["Post"]
        post.splashdown.motion, post.splashdown.body_name = "DYNAMIC", "Post"
        post.splashdown.body_run = str(self.cache / "own/run")
        bpy.ops.splashdown.open_run(directory=str(self.run_folder))
        self.assertIsNone(post.animation_data)
        self.assertEqual(sum(obj.splashdown_cache.body == "Post" for obj in scene.objects), 1)

    def test_a_run_without_meshes_of_bodies_has_empties_until_they_exist(self):
        mesh = self.run_folder / "bodies/Post.ply"
        content = mesh.read_bytes()
        mesh.unlink()
        scene, output = self.open()
        self.assertEqual(output.count("Post.ply in bodies cannot be read"), 1, output)
        self.assertIn("shown as an empty", shown(scene).splashdown_cache.note)
        self.assertEqual(scene.objects["dam Post"].type, "EMPTY")
        mesh.write_bytes(content)
        bpy.ops.splashdown.open_run(directory=str(self.run_folder))
        self.assertEqual([obj.type for obj in scene.objects if obj.splashdown_cache.body], ["MESH"])

    def test_damaged_tables_of_bodies_are_reported_once(self):
        path = self.run_folder / "bodies/Post.csv"
        content = path.read_text().splitlines(keepends=True)
        for text, words in (
            (None, "Post.csv is missing in bodies: the body does not move"),
            ("junk\n", "Post.csv is not the table of a body: the body does not move"),
            ("".join(content[:4]), "Post.csv has 3 rows for 9 frames: the body stops at"),
        ):
            path.unlink() if text is None else path.write_text(text)
            scene, output = self.open()
            self.assertEqual(output.count(words), 1, output)
            self.assertEqual(shown(scene).splashdown_cache.note.count(words), 1)
            path.write_text("".join(content))
        _, output = self.open()
        self.assertNotIn("Post.csv", output)

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
        # The damage is known since the run was opened.
        self.assertEqual(later.getvalue().count("Splashdown:"), 0, later.getvalue())
        self.assertIn("frame 2 missing", note)
        notes = [obj.splashdown_cache.note for obj in part("playback").shown_objects(scene)]
        self.assertEqual("\n".join(notes).count("frame 5"), 1, notes)
        # Damage that occurs later is reported once, with its own cause.
        (self.run_folder / "mesh/surface_0006.ply").write_text("no mesh")
        with redirect_stdout(later):
            for number in (6, 7, 6):
                scene.frame_set(1 + number)
        self.assertEqual(later.getvalue().count("frame 6 of surface cannot be read (it is not a PLY file)"), 1)
        self.assertEqual(surface.splashdown_cache.note.count("frame 6"), 1)
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
