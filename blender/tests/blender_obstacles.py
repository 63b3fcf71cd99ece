"""Headless tests of obstacles and roles: export, keyframes of a bake, and how they are removed."""

import tomllib

import bpy
import numpy as np
from mathutils import Matrix

import support
from blender_case import Case, part, table

CORNERS = [(-0.06, -0.06, -0.06), (0.1, -0.06, -0.06), (-0.06, 0.08, -0.06), (-0.06, -0.06, 0.14)]
FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]


def wedge(scene, **values):
    """An obstacle that the fluid moves and that looks different after every reflection."""
    mesh = bpy.data.meshes.new("Wedge")
    mesh.from_pydata(CORNERS, [], FACES)
    obj = bpy.data.objects.new("Wedge", mesh)
    scene.collection.objects.link(obj)
    obj.splashdown.role, obj.splashdown.motion = "OBSTACLE", "DYNAMIC"
    obj.location, obj.rotation_euler = (0.8, 0.3, 0.4), (0.3, 0.2, 0.5)
    for name, value in values.items():
        setattr(obj, name, value)
    bpy.context.view_layer.update()
    return obj


class Obstacles(Case):
    def scene(self, frames=2):
        scene = support.dam_break(self.cache, frames=frames)
        scene.splashdown.use_foam = False
        bpy.data.objects.remove(scene.objects["Post"])
        return scene

    def test_floating_obstacles_start_where_they_are_whatever_their_transformation(self):
        cases = [
            {},
            {"scale": (-1, 1, 1)},
            {"scale": (-1, -1, 1)},
            {"scale": (-1, -1, -1)},
            {"scale": (1, -2, 0.5)},
            {"rotation_mode": "ZYX", "scale": (1, 1, -1)},
            {"rotation_mode": "QUATERNION", "rotation_quaternion": (0.8, 0.6, 0, 0)},
            {"rotation_mode": "AXIS_ANGLE", "rotation_axis_angle": (0.7, 0, 0.6, 0.8)},
            {"delta_location": (-0.1, 0.05, 0.1), "delta_rotation_euler": (0, 0, 1), "delta_scale": (1, 1, -1.2)},
        ]
        for values in cases:
            with self.subTest(values):
                scene = self.scene()
                obj = wedge(scene, **values)
                before = support.world_vertices(obj)
                mode, rotation = obj.rotation_mode, tuple(obj.rotation_euler)
                self.bake()
                for number in (0, 2):
                    scene.frame_set(1 + number)
                    # The run moves the exported mesh.
                    exported = self.exported(number)
                    np.testing.assert_allclose(support.world_vertices(obj), exported, atol=2e-5)
                    if number == 0:
                        np.testing.assert_allclose(exported, before, atol=2e-5)
                self.assertGreater(np.abs(exported - before).max(), 1e-3)
                bpy.ops.splashdown.restore()
                bpy.context.view_layer.update()
                np.testing.assert_allclose(support.world_vertices(obj), before, atol=1e-6)
                self.assertEqual((obj.rotation_mode, obj.animation_data), (mode, None))
                np.testing.assert_allclose(obj.rotation_euler, rotation, atol=1e-6)

    def exported(self, number):
        """The vertices of the first body of the run in a frame, in the order and the axes of Blender."""
        axes = part("core.axes")
        body = tomllib.loads((self.cache / "scene.toml").read_text())["body"][0]
        mesh = part("core.ply").read(self.cache / body["mesh"])
        _, positions, quaternions = table(self.cache / f"run/bodies/{body['name']}.csv")
        x, y, z, w = quaternions[number]
        turned = np.array(Matrix(_rotation(x, y, z, w)))
        return axes.to_blender(mesh.positions @ turned.T + positions[number])

    def test_a_bake_changes_only_its_own_curves(self):
        scene = self.scene()
        obj = wedge(scene)
        obj.hide_render = False
        obj.keyframe_insert("hide_render", frame=1)
        action = obj.animation_data.action
        other = bpy.data.objects.new("Other", None)
        scene.collection.objects.link(other)
        other.animation_data_create().action = action
        for _ in range(2):
            self.bake()
            paths = {curve.data_path for curve in part("motion")._curves(obj)}
            self.assertEqual(paths, {"hide_render", "location", "rotation_quaternion"})
        # The action of the other object is not changed.
        self.assertIsNot(obj.animation_data.action, action)
        bpy.ops.splashdown.restore()
        self.assertEqual({curve.data_path for curve in part("motion")._curves(obj)}, {"hide_render"})

    def test_a_second_bake_starts_from_the_pose_before_the_first(self):
        scene = self.scene(frames=6)
        scene.objects["Tank"].hide_render = True
        obj = wedge(scene, scale=(1, -2, 0.5))
        before = support.world_vertices(obj)
        self.bake()
        scene.frame_set(6)
        # The control: the keyframes have moved it.
        self.assertGreater(np.abs(support.world_vertices(obj) - before).max(), 0.01)
        scene.frame_start, scene.frame_end = 4, 6
        self.bake()
        np.testing.assert_allclose(self.exported(0), before, atol=2e-5)
        scene.frame_set(4)
        np.testing.assert_allclose(support.world_vertices(obj), before, atol=2e-5)
        bpy.ops.splashdown.restore()
        bpy.context.view_layer.update()
        np.testing.assert_allclose(support.world_vertices(obj), before, atol=1e-6)

    def test_an_animated_pose_of_a_floating_obstacle_is_refused(self):
        obj = wedge(self.scene())
        obj.keyframe_insert("location", frame=1)
        self.assertIn('"Wedge" is moved by the fluid, but its location', self.refused(bpy.ops.splashdown.bake))

    def test_objects_that_blender_does_not_evaluate_are_refused(self):
        def disabled(obj):
            obj.hide_viewport = True

        def excluded(obj):
            made = bpy.data.collections.new("Away")
            bpy.context.scene.collection.children.link(made)
            for collection in obj.users_collection:
                collection.objects.unlink(obj)
            made.objects.link(obj)
            bpy.context.view_layer.layer_collection.children["Away"].exclude = True

        def collection_disabled(obj):
            excluded(obj)
            bpy.context.view_layer.layer_collection.children["Away"].exclude = False
            bpy.data.collections["Away"].hide_viewport = True

        for change in (disabled, excluded, collection_disabled):
            with self.subTest(change.__name__):
                scene = support.dam_break(self.cache)
                change(scene.objects["Post"])
                bpy.context.view_layer.update()
                self.assertIn('"Post" is disabled in viewports', self.refused(bpy.ops.splashdown.check))
        # The eye icon hides without disabling.
        scene = support.dam_break(self.cache)
        scene.objects["Post"].hide_set(True)
        bpy.context.view_layer.update()
        self.assertEqual(bpy.ops.splashdown.check(), {"FINISHED"})

    def test_an_obstacle_is_animated_by_what_a_bone_follows(self):
        scene = support.dam_break(self.cache, frames=4)
        target = bpy.data.objects.new("Target", None)
        scene.collection.objects.link(target)
        for frame, x in ((1, 0.0), (5, 0.1)):
            target.location.x = x
            target.keyframe_insert("location", frame=frame)
        bpy.ops.object.armature_add(location=(0, 0, 0))
        armature = bpy.context.object
        constraint = armature.pose.bones[0].constraints.new("COPY_LOCATION")
        constraint.target = target
        post = scene.objects["Post"]
        post.parent, post.parent_type, post.parent_bone = armature, "BONE", armature.pose.bones[0].name
        post.location = (0.85, -0.7, 0.175)
        bpy.context.view_layer.update()
        self.bake()
        _, positions, _ = table(self.cache / "run/bodies/Post.csv")
        self.assertAlmostEqual(np.ptp(positions[:, 0]), 0.1, delta=0.01)

    def test_a_fast_turn_is_exported_between_frames(self):
        # Radians per frame: slow, more than half a circle, a whole circle, too fast.
        for angle, count, is_reported in ((1.5, 4, False), (4.0, 10, False), (2 * np.pi, 13, False), (400.0, 193, True)):
            scene = support.dam_break(self.cache, frames=2)
            axle = bpy.data.objects.new("Axle", None)
            scene.collection.objects.link(axle)
            scene.objects["Post"].parent = axle
            for frame in (1, 6):
                axle.rotation_euler.z = angle * frame
                axle.keyframe_insert("rotation_euler", frame=frame)
            for curve in part("motion")._curves(axle):
                for key in curve.keyframe_points:
                    key.interpolation = "LINEAR"
            described = part("collect").describe(bpy.context)
            self.assertEqual(any("too fast" in text for text in described.warnings), is_reported)
            poses = described.scene.bodies[0].poses
            self.assertEqual(len(poses), count)
            np.testing.assert_allclose([poses[0].time, poses[-1].time], [0, 3 / 24])
            self.assertEqual(bpy.ops.splashdown.check(), {"FINISHED"})
            if not is_reported:
                # The post turns in the direction of its axle at every step: x towards -z of the program.
                steps = np.diff([np.arctan2(-pose.position[2], pose.position[0]) for pose in poses])
                steps = (steps + np.pi) % (2 * np.pi) - np.pi
                np.testing.assert_allclose(steps, 3 * angle / (count - 1), atol=1e-4)

    def test_gravity_follows_the_unit_scale_as_in_the_interface(self):
        scene = support.dam_break(self.cache)
        for scale, gravity in ((1.0, 9.81), (0.5, 4.905)):
            scene.unit_settings.scale_length = scale
            described = part("collect").describe(bpy.context)
            np.testing.assert_allclose(described.scene.gravity, (0, -gravity, 0), rtol=1e-5, atol=1e-9)
            self.assertEqual(any("unit scale" in text for text in described.warnings), scale != 1)

    def test_problems_name_the_object_and_not_its_file(self):
        scene = support.dam_break(self.cache)
        scene.objects["Post"].name = "Würfel.001"
        scene.objects["Würfel.001"].data.clear_geometry()
        bpy.context.view_layer.update()
        self.assertIn('"Würfel.001" has no faces', self.refused(bpy.ops.splashdown.bake))

    def test_warnings_name_the_object_once(self):
        scene = support.dam_break(self.cache, frames=1)
        scene.objects["Column"].scale.z = 0.575
        scene.objects["Column"].location.z = 0.2875
        bpy.context.view_layer.update()
        warnings = self.bake().warnings
        about = [text for text in warnings if "spacings long" in text]
        self.assertEqual(len(about), 1, warnings)
        self.assertTrue(about[0].startswith('fluid "Column" is'), about)
        self.assertNotIn("scene.toml", "".join(warnings))

    def test_roles_bring_the_users_own_display_back(self):
        support.empty_scene()
        obj = support.box("Box", (0, 0, 0), (1, 1, 1))
        obj.display_type, obj.hide_render = "BOUNDS", True
        obj.splashdown.role = "OBSTACLE"
        self.assertEqual((obj.display_type, obj.hide_render), ("BOUNDS", True))
        obj.hide_render = False
        for role in ("FLUID", "EMITTER"):
            obj.splashdown.role = role
            self.assertEqual((obj.display_type, obj.hide_render), ("WIRE", True))
        obj.splashdown.role = "NONE"
        self.assertEqual((obj.display_type, obj.hide_render), ("BOUNDS", False))


def _rotation(x, y, z, w):
    """The rotation matrix of a unit quaternion."""
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
