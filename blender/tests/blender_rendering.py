"""Headless tests of pictures by Cycles."""

import numpy as np

import support
from blender_case import Case, part


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
