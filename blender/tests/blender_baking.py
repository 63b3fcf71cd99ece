"""Headless tests of bakes: what is exported, and what a finished bake shows."""

import bpy
import numpy as np

import support
from blender_case import Case, attribute, part, ply_of, shown, table, vertices


def cloud_of(obj, graph):
    """The number of points and the names of the attributes of the point cloud that an object becomes."""
    if bpy.app.version >= (5, 0, 0):
        # The set owns the cloud.
        evaluated = obj.evaluated_get(graph).evaluated_geometry()
        return len(evaluated.pointcloud.points), evaluated.pointcloud.attributes.keys()
    # Before Blender 5.0 the cloud is an instance, which is valid only within the loop.
    for instance in graph.object_instances:
        if instance.object.original == obj and instance.object.type == "POINTCLOUD":
            return len(instance.object.data.points), instance.object.data.attributes.keys()
    return 0, []


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
        np.testing.assert_allclose(attribute(foam, "radius", 1), part("show").DIFFUSE_RADII["foam"] * 0.05, rtol=1e-5)
        droplets = shown(scene, "droplets")
        frame = ply_of(self.cache, "droplets", 9)
        self.assertGreater(len(frame.positions), 0)
        np.testing.assert_allclose(attribute(droplets, "radius", 1)[:, 0], frame.values["width"] / 2, rtol=1e-5)
        graph = bpy.context.evaluated_depsgraph_get()
        for obj in (foam, droplets):
            count, names = cloud_of(obj, graph)
            self.assertEqual(count, len(obj.data.vertices))
            self.assertIn("velocity", names)

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
