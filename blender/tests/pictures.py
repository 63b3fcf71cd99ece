"""Draws the pictures of the guide, rendered by Cycles: a bake of the extension, and a run of the program."""

import subprocess
from pathlib import Path

import bpy

import support
from blender_case import ARGUMENTS

SIZE = (640, 360)
FRAMES = 26
# Three bodies in a breaking wave.
FLOATING = Path(__file__).resolve().parents[2] / "crates/splashdown/scenes/floating.toml"
# The frames of this run that are drawn: before and after the wave meets the bodies.
OPENED = (8, 20)


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
    """Writes the pictures into `folder`; the runs are below `work`."""
    folder.mkdir(parents=True, exist_ok=True)
    _draw_bake(folder, work)
    _draw_opened_run(folder, work)


def _draw_opened_run(folder, work):
    """Writes `opened-run-FRAME.webp`: what *Open Run* shows, without a change to its objects and materials."""
    words = ["run", FLOATING, "--device", "cpu", "--no-pictures", "--frames", str(OPENED[-1]), "--out", "floating"]
    subprocess.run([ARGUMENTS.program, *words], cwd=work, check=True)
    scene = support.empty_scene()
    bpy.ops.splashdown.open_run(directory=str(work / "floating"))
    support.studio(scene, (2.9, -1.85, 0.85), (1.25, -0.38, 0.17), SIZE, samples=128, lens=40)
    support.tiles(scene.objects["Floor"])
    for frame in OPENED:
        scene.frame_set(scene.frame_start + frame)
        _render(scene, folder / f"opened-run-{frame:02}.webp")


def _draw_bake(folder, work):
    """Writes `water.webp`."""
    scene = _scene(work / "cache")
    bpy.ops.splashdown.bake()
    support.studio(scene, (2.45, -1.5, 0.95), (0.9, 0.4, 0.22), SIZE, samples=128, lens=38)
    support.tiles(scene.objects["Floor"])
    scene.frame_set(12)
    _render(scene, folder / "water.webp")


def _render(scene, path):
    settings = scene.render.image_settings
    settings.file_format, settings.quality = "WEBP", 82
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
