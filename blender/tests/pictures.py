"""Draws the picture of the guide: a bake of the extension, rendered by Cycles."""

import bpy

import support

SIZE = (640, 360)
FRAMES = 26


def _crate(name, low, high, turn):
    obj = support.box(name, low, high, "OBSTACLE")
    obj.rotation_euler.z = turn
    obj.splashdown.motion, obj.splashdown.density = "DYNAMIC", 350
    support.matte(obj, (0.75, 0.5, 0.12))
    return obj


def _scene(cache):
    scene = support.empty_scene(FRAMES)
    support.box("Tank", (0, 0, 0), (1.6, 0.8, 1.2), "DOMAIN")
    support.box("Column", (0, 0, 0), (0.45, 0.8, 0.65), "FLUID")
    support.box("Pool", (0.45, 0, 0), (1.6, 0.8, 0.1), "FLUID")
    ball = support.sphere("Ball", (1.0, 0.5, 0.12), 0.16, "OBSTACLE")
    support.matte(ball, (0.8, 0.16, 0.05))
    bpy.ops.object.shade_smooth()
    _crate("Crate", (1.2, 0.15, 0.1), (1.38, 0.33, 0.28), 0.4)
    scene.splashdown.cache_folder = str(cache)
    scene.splashdown.particle_spacing = 0.02
    scene.splashdown.device = "cpu"
    bpy.context.view_layer.update()
    return scene


def draw(folder, work):
    """Writes `water.webp` into `folder`; the cache is below `work`."""
    folder.mkdir(parents=True, exist_ok=True)
    scene = _scene(work / "cache")
    bpy.ops.splashdown.bake()
    support.studio(scene, (2.45, -1.5, 0.95), (0.9, 0.4, 0.22), SIZE, samples=128, lens=38)
    support.tiles(scene.objects["Floor"])
    scene.frame_set(12)
    settings = scene.render.image_settings
    settings.file_format, settings.quality = "WEBP", 82
    scene.render.filepath = str(folder / "water.webp")
    bpy.ops.render.render(write_still=True)
