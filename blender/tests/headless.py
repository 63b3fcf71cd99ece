"""Tests of the packaged extension in Blender without a window: headless.py ZIP PROGRAM FOLDER [PICTURES].

With PICTURES, also draws the pictures of the guide into that folder.
"""

import json
import os
import shutil
import sys
import tempfile
import time
import unittest
from pathlib import Path

ZIP, PROGRAM, WORK = (Path(argument).resolve() for argument in sys.argv[1:4])
PICTURES = Path(sys.argv[4]).resolve() if len(sys.argv) > 4 else None
shutil.rmtree(WORK, ignore_errors=True)
WORK.mkdir(parents=True)
# An empty configuration, and no program on PATH: the tests set its path in the preferences.
os.environ["BLENDER_USER_RESOURCES"] = str(WORK / "user")
os.environ["PATH"] = os.defpath
os.environ["HOME"] = str(WORK)

import bpy  # noqa: E402
import numpy as np  # noqa: E402

MODULE = "bl_ext.user_default.splashdown"


def install():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.extensions.package_install_files(filepath=str(ZIP), repo="user_default", enable_on_install=True)
    bpy.context.preferences.addons[MODULE].preferences.program = str(PROGRAM)


def module(name):
    return sys.modules[f"{MODULE}.{name}"]


def add_box(name, low, high, role):
    low, high = np.array(low), np.array(high)
    bpy.ops.mesh.primitive_cube_add(size=1, location=tuple(0.5 * (low + high)))
    item = bpy.context.object
    item.name, item.scale = name, tuple(high - low)
    item.splashdown.role = role
    bpy.context.view_layer.update()
    return item


def build(frames=6, spacing=0.05):
    """A dam break from the side of low x, along y, with an obstacle."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    if MODULE not in bpy.context.preferences.addons:
        bpy.ops.preferences.addon_enable(module=MODULE)
    bpy.context.preferences.addons[MODULE].preferences.program = str(PROGRAM)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, frames
    domain = add_box("tank", (0, 0, 0), (1.2, 0.5, 0.9), "DOMAIN")
    domain.display_type, domain.hide_render = "WIRE", True
    add_box("water", (0, 0, 0), (0.4, 0.5, 0.6), "FLUID").hide_render = True
    settings = scene.splashdown
    settings.spacing, settings.device = spacing, "cpu"
    settings.cache = tempfile.mkdtemp(dir=WORK)
    return scene


def run_folder(scene):
    return Path(scene.splashdown.cache) / "run"


def bake(expected="FINISHED"):
    try:
        result = bpy.ops.splashdown.bake()
    except RuntimeError:
        # Blender raises reported errors of operators.
        result = {"CANCELLED"}
    return result == {expected}


def corners(item):
    points = np.empty(3 * len(item.data.vertices), np.float32)
    item.data.vertices.foreach_get("co", points)
    return points.reshape(-1, 3)


def surface():
    return bpy.data.objects["Splashdown surface"]


class Headless(unittest.TestCase):
    def refused(self, text):
        self.assertTrue(bake("CANCELLED"))
        self.assertIn(text, bpy.context.scene.splashdown.report)

    def test_bake_loads_the_frames_in_the_axes_of_blender(self):
        scene = build()
        self.assertTrue(bake(), scene.splashdown.report)
        scene.frame_set(1)
        points = corners(surface())
        # The column of water, to within a spacing.
        np.testing.assert_allclose(points.min(axis=0), (0, 0, 0), atol=0.05)
        np.testing.assert_allclose(points.max(axis=0), (0.4, 0.5, 0.6), atol=0.05)
        scene.frame_set(6)
        later = corners(surface())
        self.assertGreater(later[:, 0].max(), points[:, 0].max() + 0.05, "the front moves along x")
        velocity = surface().data.attributes["velocity"]
        values = np.empty(3 * len(velocity.data), np.float32)
        velocity.data.foreach_get("vector", values)
        values = values.reshape(-1, 3)
        self.assertGreater(values[:, 0].max(), 0.3, "the front moves along x")
        self.assertLess(values[:, 2].min(), -0.3, "the column falls along z")

    def test_the_cache_survives_saving_and_reopening(self):
        scene = build()
        self.assertTrue(bake(), scene.splashdown.report)
        scene.frame_set(6)
        last = corners(surface())
        file = str(WORK / "saved.blend")
        scene.frame_set(1)
        bpy.ops.wm.save_as_mainfile(filepath=file)
        bpy.ops.wm.open_mainfile(filepath=file)
        bpy.context.scene.frame_set(6)
        np.testing.assert_array_equal(corners(surface()), last)

    def test_cancel_keeps_the_finished_frames(self):
        scene = build(frames=200, spacing=0.03)
        job = module("bake").Job(bpy.context)
        end = time.monotonic() + 120
        while job.poll() and job.run.frame < 2 and time.monotonic() < end:
            time.sleep(0.02)
        self.assertGreaterEqual(job.run.frame, 2, scene.splashdown.report)
        job.run.cancel()
        while job.poll():
            time.sleep(0.02)
        self.assertIn("Cancelled", scene.splashdown.report)
        found = module("run_folder").scan(run_folder(scene))
        self.assertEqual(found.problems, [])
        self.assertGreaterEqual(len(found.frames), 3)
        self.assertLess(len(found.frames), 200)
        self.assertGreater(len(surface().data.vertices), 0)

    def test_an_existing_run_opens_with_a_truncated_and_a_missing_frame(self):
        scene = build()
        self.assertTrue(bake(), scene.splashdown.report)
        mesh = run_folder(scene) / "mesh"
        path = mesh / "surface_0003.ply"
        path.write_bytes(path.read_bytes()[:-100])
        (mesh / "surface_0001.ply").unlink()
        scene.frame_set(3)
        before = corners(surface())
        self.assertEqual(bpy.ops.splashdown.open_run(directory=str(mesh.parent)), {"FINISHED"})
        report = scene.splashdown.report
        self.assertIn("Truncated or invalid surface files, not used: frames 3.", report)
        self.assertIn("Missing surface files: frames 1.", report)
        scene.frame_set(4)
        np.testing.assert_array_equal(corners(surface()), before)
        reports = scene.splashdown.report
        scene.frame_set(5)
        scene.frame_set(4)
        self.assertEqual(scene.splashdown.report, reports, "a truncated file is reported once")

    def test_a_folder_without_frames_changes_nothing(self):
        scene = build()
        with self.assertRaises(RuntimeError):
            bpy.ops.splashdown.open_run(directory=str(WORK))
        self.assertIn("no frames", scene.splashdown.report)
        self.assertNotIn("Splashdown surface", bpy.data.objects)

    def test_a_missing_program_is_explained(self):
        build()
        preferences = bpy.context.preferences.addons[MODULE].preferences
        preferences.program = ""
        self.refused("cargo install --path crates/splashdown-cli")
        preferences.program = str(WORK / "absent")
        self.refused("is not a program")

    def test_scenes_that_cannot_be_simulated_are_refused(self):
        scene = build()
        tank, water = bpy.data.objects["tank"], bpy.data.objects["water"]
        tank.splashdown.role = "NONE"
        self.refused("No domain")
        tank.splashdown.role, water.splashdown.role = "DOMAIN", "NONE"
        self.refused("No fluid")
        water.splashdown.role = "FLUID"
        water.location.x += 5
        self.refused("outside the domain")
        water.location.x -= 4.5
        water.location.x += 0.6
        self.refused("beyond the domain")
        water.location.x = 0.2
        scene.splashdown.cache = "//cache"
        self.refused("Save the .blend file first")
        scene.splashdown.cache = str(WORK / "open")
        bpy.ops.object.select_all(action="DESELECT")
        bpy.context.view_layer.objects.active = water
        import bmesh

        built = bmesh.new()
        built.from_mesh(water.data)
        built.faces.ensure_lookup_table()
        bmesh.ops.delete(built, geom=[built.faces[0]], context="FACES_ONLY")
        built.to_mesh(water.data)
        built.free()
        self.refused("not closed")

    def test_errors_of_the_program_are_shown(self):
        scene = build()
        scene.gravity = (0, 0, -2000)
        self.refused("gravity")

    def test_an_animated_obstacle_pushes_the_water(self):
        scene = build(frames=8)
        paddle = add_box("paddle", (-0.3, 0.02, 0), (-0.1, 0.48, 0.6), "OBSTACLE")
        paddle.keyframe_insert("location", frame=1)
        paddle.location.x += 0.3
        paddle.rotation_euler.z = 0.1
        paddle.keyframe_insert("location", frame=8)
        paddle.keyframe_insert("rotation_euler", frame=8)
        self.assertTrue(bake(), scene.splashdown.report)
        scene.frame_set(8)
        # 0.1 m from the side at the last frame; it would be at 0 without the obstacle.
        self.assertGreater(np.quantile(corners(surface())[:, 0], 0.02), 0.03)
        text = (Path(scene.splashdown.cache) / "scene.toml").read_text()
        self.assertEqual(text.count("[[body.keyframe]]"), 8)
        last = json.loads(text.split("position = ")[-1].splitlines()[0])
        np.testing.assert_allclose(last, (0.1, 0.3, -0.25), atol=1e-6)

    def test_motion_blur_changes_a_cycles_frame(self):
        scene = build(frames=10)
        self.assertTrue(bake(), scene.splashdown.report)
        scene.frame_set(10)
        stage(scene, (320, 180), samples=8)
        sharp = draw(scene, False)
        again = draw(scene, False)
        blurred = draw(scene, True)
        noise, change = np.abs(again - sharp).mean(), np.abs(blurred - sharp).mean()
        self.assertGreater(change, 3 * noise + 1e-3)


def draw(scene, has_blur, path=None, shutter=1.0):
    """The pixels of a frame. The shutter is open for a part of a frame."""
    scene.render.use_motion_blur = has_blur
    scene.render.motion_blur_shutter = shutter
    scene.render.filepath = str(path or WORK / "frame.png")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.empty(4 * image.size[0] * image.size[1], np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels


def stage(scene, size, samples):
    """A camera, a sky, a sun and a tiled floor for Cycles."""
    from mathutils import Vector

    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.seed = "CPU", samples, 1
    scene.cycles.use_denoising = samples > 16
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (1.35, -1.6, 1.15)
    camera.rotation_euler = (Vector((0.56, 0.25, 0.24)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens = 42
    scene.collection.objects.link(camera)
    scene.camera = camera
    world = bpy.data.worlds.new("sky")
    scene.world = world
    # From a bright horizon to a blue zenith.
    tree = world.node_tree
    place, axes = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeSeparateXYZ")
    ramp = tree.nodes.new("ShaderNodeValToRGB")
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.95, 0.96, 1, 1), (0.12, 0.3, 0.75, 1)
    tree.links.new(place.outputs["Generated"], axes.inputs[0])
    tree.links.new(axes.outputs["Z"], ramp.inputs[0])
    tree.links.new(ramp.outputs[0], tree.nodes["Background"].inputs["Color"])
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 1.0
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle, sun.rotation_euler = 3, 0.02, (0.7, 0.2, 0.4)
    scene.collection.objects.link(sun)
    bpy.ops.mesh.primitive_plane_add(size=30, location=(0, 0, -0.03))
    material = bpy.data.materials.new("tiles")
    tree = material.node_tree
    checker = tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Scale"].default_value = 8
    checker.inputs["Color1"].default_value = (0.32, 0.3, 0.27, 1)
    checker.inputs["Color2"].default_value = (0.12, 0.12, 0.13, 1)
    place = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(place.outputs["Object"], checker.inputs["Vector"])
    tree.links.new(checker.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    bpy.context.object.data.materials.append(material)


def pictures():
    """The pictures of the guide: a dam break against a block, sharp and with motion blur."""
    scene = build(frames=12, spacing=0.016)
    block = add_box("block", (0.72, 0.17, 0), (0.86, 0.33, 0.2), "OBSTACLE")
    paint = bpy.data.materials.new("block")
    paint.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.7, 0.16, 0.05, 1)
    block.data.materials.append(paint)
    assert bake(), scene.splashdown.report
    print(scene.splashdown.report)
    scene.frame_set(11)
    stage(scene, (560, 315), samples=64)
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format = "WEBP"
    scene.render.image_settings.quality = 85
    PICTURES.mkdir(parents=True, exist_ok=True)
    draw(scene, False, PICTURES / "sharp.webp")
    draw(scene, True, PICTURES / "blurred.webp", shutter=0.5)


if __name__ == "__main__":
    install()
    if PICTURES:
        pictures()
    outcome = unittest.main(argv=sys.argv[:1], exit=False, verbosity=2).result
    sys.exit(not outcome.wasSuccessful())
