"""Scenes of the headless tests, in Blender's axes and metres."""

import bpy
import numpy as np
from mathutils import Vector


def empty_scene(frames=8, fps=24):
    """An empty file with a sun. The scene ends at `frames`."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, frames + 1
    scene.render.fps = fps
    scene.frame_set(1)
    return scene


def box(name, low, high, role="NONE"):
    """A box between two corners."""
    centre = [(a + b) / 2 for a, b in zip(low, high)]
    bpy.ops.mesh.primitive_cube_add(size=1, location=centre)
    obj = bpy.context.object
    obj.name = name
    obj.scale = [b - a for a, b in zip(low, high)]
    obj.splashdown.role = role
    return obj


def sphere(name, centre, radius, role="NONE"):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=radius, location=centre)
    obj = bpy.context.object
    obj.name = name
    obj.splashdown.role = role
    return obj


def dam_break(folder, frames=8, spacing=0.05):
    """A column of water in a box of 1.2 x 0.6 x 0.9 m, with an obstacle."""
    scene = empty_scene(frames)
    box("Tank", (0, 0, 0), (1.2, 0.6, 0.9), "DOMAIN")
    box("Column", (0, 0, 0), (0.4, 0.6, 0.6), "FLUID")
    box("Post", (0.8, 0.2, 0), (0.9, 0.4, 0.35), "OBSTACLE")
    settings = scene.splashdown
    settings.cache_folder = str(folder)
    settings.particle_spacing = spacing
    settings.device = "cpu"
    bpy.context.view_layer.update()
    return scene


def world_vertices(obj):
    """The vertices of an object in the world, shape (N, 3)."""
    matrix = np.array(obj.matrix_world)
    return np.array([vertex.co for vertex in obj.data.vertices]) @ matrix[:3, :3].T + matrix[:3, 3]


def matte(obj, colour):
    """Gives an object a matte material."""
    material = bpy.data.materials.new(obj.name)
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*colour, 1)
    material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.7
    obj.data.materials.append(material)


def studio(scene, eye, target, size=(480, 270), samples=64, lens=40):
    """A floor at z = 0, a sky, a sun, a camera, and Cycles on the CPU."""
    bpy.ops.mesh.primitive_plane_add(size=40)
    floor = bpy.context.object
    floor.name = "Floor"
    matte(floor, (0.35, 0.33, 0.3))
    world = bpy.data.worlds.new("Sky")
    scene.world = world
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.45, 0.62, 0.9, 1)
    background.inputs["Strength"].default_value = 0.7
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.data.angle = 3.5, 0.05
    sun.rotation_euler = (0.75, 0.15, 0.5)
    scene.collection.objects.link(sun)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.lens = lens
    camera.location = eye
    direction = Vector(target) - Vector(eye)
    camera.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera
    render = scene.render
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = size
    render.resolution_percentage = 100
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.seed = 1
    scene.view_settings.view_transform = "AgX"


def glow(obj, colour=(1, 1, 1)):
    """Replaces the materials of an object by one that emits light, or is black."""
    name = f"Glow {colour}"
    material = bpy.data.materials.get(name) or bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    emission, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    emission.inputs["Color"].default_value = (*colour, 1)
    links.new(emission.outputs[0], output.inputs[0])
    obj.data.materials.clear()
    obj.data.materials.append(material)
    for modifier in obj.modifiers:
        if modifier.type == "NODES":
            for item in modifier.node_group.interface.items_tree:
                if item.name == "Material":
                    modifier[item.identifier] = material


def render(scene, path):
    """Renders the present frame and returns the brightness, linear, shape (height, width)."""
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(path))
    width, height = image.size
    pixels = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[..., :3].mean(axis=2)


def tiles(obj, side=0.2):
    """A checkerboard of dark tiles with this side in m, so that refraction is visible."""
    material = obj.data.materials[0]
    nodes, links = material.node_tree.nodes, material.node_tree.links
    checker, position = nodes.new("ShaderNodeTexChecker"), nodes.new("ShaderNodeNewGeometry")
    lifted = nodes.new("ShaderNodeVectorMath")
    # The floor would otherwise lie between two layers of cubes.
    lifted.inputs[1].default_value = (0, 0, 0.5 * side)
    checker.inputs["Scale"].default_value = 1 / side
    checker.inputs["Color1"].default_value = (0.26, 0.27, 0.29, 1)
    checker.inputs["Color2"].default_value = (0.10, 0.11, 0.125, 1)
    links.new(position.outputs["Position"], lifted.inputs[0])
    links.new(lifted.outputs[0], checker.inputs["Vector"])
    links.new(checker.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
