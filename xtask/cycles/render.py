"""Renders a frame with Cycles: `render.py DATA.json WIDTH HEIGHT SAMPLES OUT.npy`.

DATA.json is that of the example `picture_data`, whose y axis points up. Blender's z axis points up. The result is
linear light without tone mapping, shape (height, width, 3), from the top row to the bottom.
"""

import json
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

import surroundings

# Diameter of the sun in degrees.
SUN_DIAMETER = 0.53
# Its diameter for light that passes water before it meets a matte surface.
WIDE_SUN_DIAMETER = 12.0
# Absorption of clear glass, 1/m.
GLASS_ABSORPTION = (2.0, 0.8, 1.2)
# Gap between panes and water, relative to the diagonal of the domain: coincident surfaces would be ambiguous.
GAP = 2e-4


def turned(points):
    """Points with y up in the axes of Blender."""
    points = np.asarray(points, np.float32).reshape(-1, 3)
    return np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)


class Nodes:
    """The nodes of a material or of the world."""

    def __init__(self, owner):
        owner.use_nodes = True
        self.tree = owner.node_tree
        self.tree.nodes.clear()

    def add(self, kind, inputs=(), **settings):
        """Adds a node. `inputs` maps names or indices of sockets to values or to the outputs of other nodes."""
        node = self.tree.nodes.new(kind)
        for key, value in settings.items():
            setattr(node, key, value)
        for key, value in dict(inputs).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node

    def math(self, operation, *values):
        return self.add("ShaderNodeMath", enumerate(values), operation=operation).outputs[0]


def passed(nodes, absorption, inside):
    """The colour that an absorption in 1/m leaves of a ray from its last surface, where `inside` is 1."""
    length = nodes.add("ShaderNodeLightPath").outputs["Ray Length"]
    length = nodes.math("MULTIPLY", length, inside)
    parts = [nodes.math("EXPONENT", nodes.math("MULTIPLY", length, -float(rate))) for rate in absorption]
    return nodes.add("ShaderNodeCombineColor", enumerate(parts)).outputs[0]


def glass_surface(nodes, index, absorption):
    """A smooth dielectric that absorbs. Its absorption is that of the rays that reach its surface from inside."""
    inside = nodes.add("ShaderNodeNewGeometry").outputs["Backfacing"]
    colour = passed(nodes, absorption, inside)
    return nodes.add("ShaderNodeBsdfGlass", {"Color": colour, "Roughness": 0.0, "IOR": index}).outputs[0]


def dielectric(name, index, absorption):
    material = bpy.data.materials.new(name)
    nodes = Nodes(material)
    nodes.add("ShaderNodeOutputMaterial", {"Surface": glass_surface(nodes, index, absorption)})
    return material


def pane_material():
    """Glass that lets light of the sun and of matte surfaces pass straight, which it does but for a small shift."""
    material = bpy.data.materials.new("glass")
    nodes = Nodes(material)
    glass = glass_surface(nodes, 1.5, GLASS_ABSORPTION)
    # The ray is not bent: at the back face it has the angle that it has at the front face.
    back = nodes.add("ShaderNodeNewGeometry").outputs["Backfacing"]
    index = nodes.math("ADD", 1.5, nodes.math("MULTIPLY", back, 1 / 1.5 - 1.5))
    left = nodes.math("SUBTRACT", 1.0, nodes.add("ShaderNodeFresnel", {"IOR": index}).outputs[0])
    colour = nodes.add("ShaderNodeCombineColor", {0: left, 1: left, 2: left}).outputs[0]
    clear = nodes.add("ShaderNodeBsdfTransparent", {"Color": colour})
    path = nodes.add("ShaderNodeLightPath").outputs
    passes = nodes.math("MAXIMUM", path["Is Shadow Ray"], path["Is Diffuse Ray"])
    mixed = nodes.add("ShaderNodeMixShader", {0: passes, 1: glass, 2: clear.outputs[0]})
    nodes.add("ShaderNodeOutputMaterial", {"Surface": mixed.outputs[0]})
    return material


def matte(name, colour):
    material = bpy.data.materials.new(name)
    nodes = Nodes(material)
    surface = nodes.add("ShaderNodeBsdfDiffuse", {"Color": (*colour, 1)})
    nodes.add("ShaderNodeOutputMaterial", {"Surface": surface.outputs[0]})
    return material


def image(name, pixels):
    height, width, _ = pixels.shape
    made = bpy.data.images.new(name, width, height, alpha=True, float_buffer=True)
    made.colorspace_settings.name = "Non-Color"
    opaque = np.ones((height, width, 4), np.float32)
    opaque[..., :3] = pixels
    made.pixels.foreach_set(opaque.ravel())
    made.update()
    return made


def add_mesh(name, vertices, triangles, material, smooth=True):
    """Adds a mesh in the axes of Blender."""
    mesh = bpy.data.meshes.new(name)
    vertices, triangles = np.asarray(vertices, np.float32), np.asarray(triangles, np.int32)
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", vertices.ravel())
    mesh.loops.add(triangles.size)
    mesh.loops.foreach_set("vertex_index", triangles.ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.full(len(triangles), smooth))
    mesh.update(calc_edges=True)
    mesh.validate()
    mesh.materials.append(material)
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


def add_box(name, low, high, material):
    corners = [[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)]
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))]
    return add_mesh(name, turned(corners), triangles, material, smooth=False)


def add_camera(data, scene):
    view = data["camera"]
    eye, target, up = (Vector(row) for row in turned([view["eye"], view["target"], view["up"]]))
    forward = (target - eye).normalized()
    right = forward.cross(up).normalized()
    upward = right.cross(forward)
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = np.radians(view["field_of_view"])
    camera.clip_start, camera.clip_end = 1e-3, 1e6
    made = bpy.data.objects.new("camera", camera)
    axes = Matrix((right, upward, -forward)).transposed()
    made.matrix_world = Matrix.Translation(eye) @ axes.to_4x4()
    scene.collection.objects.link(made)
    scene.camera = made


def add_sky(data, scene):
    """The sky, and the sun for rays that meet it by chance: of its size after mirrors and refractions only, and larger
    after matte surfaces below water, which a ray rarely leaves towards so small a disc."""
    scene.world = bpy.data.worlds.new("sky")
    nodes = Nodes(scene.world)
    picture = image("sky", surroundings.sky_image(data))
    texture = nodes.add("ShaderNodeTexEnvironment", image=picture)
    sky = nodes.add("ShaderNodeBackground", {"Color": texture.outputs["Color"]}).outputs[0]
    light = np.asarray(data["sky"]["sun_light"])
    path = nodes.add("ShaderNodeLightPath").outputs
    towards = nodes.add("ShaderNodeTexCoord").outputs["Generated"]
    sun = Vector(turned([data["sun"]])[0]).normalized()
    cosine = nodes.add("ShaderNodeVectorMath", {0: towards, 1: sun}, operation="DOT_PRODUCT").outputs["Value"]
    after_matte = nodes.math("GREATER_THAN", path["Diffuse Depth"], 0.5)
    through_water = nodes.math("MULTIPLY", after_matte, path["Is Transmission Ray"])
    only_mirrors = nodes.math("MULTIPLY", nodes.math("SUBTRACT", 1.0, after_matte), path["Is Singular Ray"])
    for seen, diameter in ((through_water, WIDE_SUN_DIAMETER), (only_mirrors, SUN_DIAMETER)):
        edge = np.cos(np.radians(diameter / 2))
        inside = nodes.math("MULTIPLY", nodes.math("GREATER_THAN", cosine, float(edge)), seen)
        # The irradiance of the sun, pi times its light, over the solid angle of the disc.
        strength = nodes.math("MULTIPLY", inside, float(np.pi / (2 * np.pi * (1 - edge))))
        disc = nodes.add("ShaderNodeBackground", {"Color": (*light, 1), "Strength": strength}).outputs[0]
        sky = nodes.add("ShaderNodeAddShader", {0: sky, 1: disc}).outputs[0]
    nodes.add("ShaderNodeOutputWorld", {"Surface": sky})


def add_sun(data, scene):
    """The sun for matte surfaces that see it. Water and bodies are opaque for it."""
    light = np.asarray(data["sky"]["sun_light"])
    if not light.any():
        return
    sun = bpy.data.lights.new("sun", "SUN")
    # A light of 1 makes a white matte surface that faces it 1, which takes an irradiance of pi.
    sun.energy = np.pi * light.max()
    sun.color = light / light.max()
    sun.angle = np.radians(SUN_DIAMETER)
    # Only from matte surfaces: rays that meet the sun by chance meet it in the sky.
    sun.cycles.use_multiple_importance_sampling = False
    sun.specular_factor = sun.transmission_factor = 0
    made = bpy.data.objects.new("sun", sun)
    made.rotation_euler = Vector(turned([data["sun"]])[0]).to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(made)


def add_floor(data, extent):
    floor = data["floor"]
    if floor is None:
        return
    domain = data["domain"]
    centre = turned([0.5 * (np.asarray(domain["min"]) + np.asarray(domain["max"]))])[0]
    centre[2] = floor["height"]
    material = bpy.data.materials.new("floor")
    material.cycles.emission_sampling = "NONE"
    nodes = Nodes(material)
    position = nodes.add("ShaderNodeNewGeometry").outputs["Position"]

    def tiles(name, half_side, extension):
        picture = image(name, surroundings.floor_image(data, half_side))
        size = 2 * half_side
        mapping = {
            "Vector": position,
            "Location": [0.5 - centre[0] / size, 0.5 - centre[1] / size, 0],
            "Scale": [1 / size, 1 / size, 0],
        }
        place = nodes.add("ShaderNodeMapping", mapping).outputs[0]
        return nodes.add("ShaderNodeTexImage", {"Vector": place}, image=picture, extension=extension).outputs

    near, far = tiles("near", 1.6 * extent, "CLIP"), tiles("far", 2.5 * floor["fade_distance"], "EXTEND")
    albedo = nodes.add("ShaderNodeMix", data_type="RGBA")
    for socket, output in (("Factor_Float", near["Alpha"]), ("A_Color", far["Color"]), ("B_Color", near["Color"])):
        target = next(entry for entry in albedo.inputs if entry.identifier == socket)
        nodes.tree.links.new(output, target)
    colour = next(entry for entry in albedo.outputs if entry.identifier == "Result_Color")
    matte_floor = nodes.add("ShaderNodeBsdfDiffuse", {"Color": colour})
    distance = nodes.add("ShaderNodeVectorMath", {0: position, 1: centre}, operation="DISTANCE").outputs["Value"]
    away = nodes.math("DIVIDE", distance, floor["fade_distance"])
    clear = nodes.math("EXPONENT", nodes.math("MULTIPLY", nodes.math("MULTIPLY", away, away), -1.0))
    haze = nodes.add("ShaderNodeEmission", {"Color": (*data["sky"]["haze"], 1)})
    mixed = nodes.add("ShaderNodeMixShader", {0: clear, 1: haze.outputs[0], 2: matte_floor.outputs[0]})
    nodes.add("ShaderNodeOutputMaterial", {"Surface": mixed.outputs[0]})
    reach = 200 * floor["fade_distance"]
    corners = [centre + np.array([x, y, 0]) * reach for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    add_mesh("floor", corners, [(0, 1, 2), (0, 2, 3)], material, smooth=False)


def add_tank(data, extent):
    """The panes of glass.wgsl as solid slabs."""
    domain = data["domain"]
    low, high = np.asarray(domain["min"], float), np.asarray(domain["max"], float)
    low[1] = data["floor"]["height"] - GAP * extent if data["floor"] else low[1]
    thickness, closed = data["glass_thickness"], domain["closed"]
    material = pane_material()
    for axis in (0, 2):
        for upper in (0, 1):
            if not closed[2 * axis + upper]:
                continue
            start, end = low.copy(), high.copy()
            inner = high[axis] + GAP * extent if upper else low[axis] - GAP * extent
            outer = inner + (thickness if upper else -thickness)
            start[axis], end[axis] = min(inner, outer), max(inner, outer)
            if axis == 2:
                start[0] -= thickness if closed[0] else 0
                end[0] += thickness if closed[1] else 0
            add_box(f"pane {axis} {upper}", start, end, material)


def add_water(data, extent):
    bpy.ops.wm.ply_import(filepath=data["mesh"], forward_axis="Y", up_axis="Z")
    imported = bpy.context.object
    vertices = np.empty(3 * len(imported.data.vertices), np.float32)
    imported.data.vertices.foreach_get("co", vertices)
    triangles = np.empty(3 * len(imported.data.polygons), np.int32)
    imported.data.polygons.foreach_get("vertices", triangles)
    bpy.data.objects.remove(imported)
    vertices = vertices.reshape(-1, 3)
    if data["floor"]:
        # Water that touches the floor ends below it, so that there is no air between them.
        floor = data["floor"]["height"]
        touching = vertices[:, 1] < floor + max(0.006 * extent, 1.3 * data["droplets"]["radius"])
        vertices[touching, 1] = floor - GAP * extent
    liquid = data["liquid"]
    material = dielectric("water", liquid["refractive_index"], liquid["absorption"])
    add_mesh("water", turned(vertices), triangles.reshape(-1, 3), material)
    return material


def add_droplets(data, material):
    centres = turned(data["droplets"]["positions"])
    if len(centres) == 0:
        return
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=data["droplets"]["radius"])
    ball = bpy.context.object
    corners = np.array([vertex.co for vertex in ball.data.vertices], np.float32)
    triangles = np.array([list(polygon.vertices) for polygon in ball.data.polygons], np.int32)
    bpy.data.objects.remove(ball)
    vertices = (centres[:, None] + corners[None]).reshape(-1, 3)
    offsets = len(corners) * np.arange(len(centres), dtype=np.int32)
    made = add_mesh("droplets", vertices, (offsets[:, None, None] + triangles).reshape(-1, 3), material)
    velocities = turned(data["droplets"]["velocities"])
    velocity = made.data.attributes.new("velocity", "FLOAT_VECTOR", "POINT")
    velocity.data.foreach_set("vector", np.repeat(velocities, len(corners), axis=0).ravel())


def render(data, width, height, samples):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    extent = float(np.linalg.norm(np.subtract(data["domain"]["max"], data["domain"]["min"])))
    add_camera(data, scene)
    add_sky(data, scene)
    add_sun(data, scene)
    add_floor(data, extent)
    if data["has_glass"]:
        add_tank(data, extent)
    add_droplets(data, add_water(data, extent))
    for number, body in enumerate(data["bodies"]):
        material = matte(f"body {number}", body["colour"])
        add_mesh(f"body {number}", turned(body["vertices"]), body["triangles"], material, smooth=False)
    
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples, cycles.use_adaptive_sampling, cycles.adaptive_threshold = samples, False, 0.01
    cycles.use_denoising, cycles.denoising_prefilter = True, "ACCURATE"
    # Light that a pane guides along itself is reflected at its faces every few centimetres.
    cycles.max_bounces = cycles.transmission_bounces = cycles.glossy_bounces = 128
    cycles.diffuse_bounces = 4
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = 0
    cycles.caustics_refractive = cycles.caustics_reflective = True
    # Learns from which directions light arrives, such as the sun through the surface of the water.
    cycles.use_guiding, cycles.guiding_training_samples = True, 128
    scene.render.use_motion_blur = data["camera"]["shutter"] > 0
    scene.render.motion_blur_shutter = data["camera"]["shutter"] * scene.render.fps
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "light.exr")
        bpy.ops.render.render(write_still=True)
        picture = bpy.data.images.load(scene.render.filepath)
        picture.colorspace_settings.name = "Non-Color"
        light = np.empty(width * height * 4, np.float32)
        picture.pixels.foreach_get(light)
    return light.reshape(height, width, 4)[::-1, :, :3]


def main():
    path, width, height, samples, out = sys.argv[1:]
    data = json.loads(Path(path).read_text())
    np.save(out, render(data, int(width), int(height), int(samples)))


if __name__ == "__main__":
    main()
