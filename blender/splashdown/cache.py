"""Objects that show the frames of a run. A handler loads the files of the current frame."""

from pathlib import Path

import bpy
import numpy as np
from bpy.app.handlers import persistent

from . import materials, ply, run_folder

COLLECTION = "Splashdown run"
# The file and time that a mesh shows now, by the name of the mesh.
_shown = {}
# Files that could not be read, each reported once.
_reported = set()


def points_tree(material):
    """Nodes that turn vertices into points with the attribute radius."""
    name = f"Points, {material.name}"
    tree = bpy.data.node_groups.get(name)
    if tree:
        return tree
    tree = bpy.data.node_groups.new(name, "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    radius = tree.nodes.new("GeometryNodeInputNamedAttribute")
    radius.data_type = "FLOAT"
    radius.inputs["Name"].default_value = "radius"
    points, paint = tree.nodes.new("GeometryNodeMeshToPoints"), tree.nodes.new("GeometryNodeSetMaterial")
    paint.inputs["Material"].default_value = material
    value = next(socket for socket in radius.outputs if socket.enabled and socket.type == "VALUE")
    tree.links.new(start.outputs[0], points.inputs["Mesh"])
    tree.links.new(value, points.inputs["Radius"])
    tree.links.new(points.outputs[0], paint.inputs["Geometry"])
    tree.links.new(paint.outputs[0], end.inputs[0])
    return tree


def load(scene, folder, liquid="water", spacing=None):
    """Shows a run in place of an earlier one. Returns the RunFolder; without frames nothing is changed."""
    run = run_folder.scan(folder)
    if not run.frames:
        return run
    collection = bpy.data.collections.get(COLLECTION)
    if collection is None:
        collection = bpy.data.collections.new(COLLECTION)
    if collection.name not in {child.name for child in scene.collection.children_recursive}:
        scene.collection.children.link(collection)
    for item in list(collection.objects):
        if item.splashdown.kind:
            mesh = item.data
            bpy.data.objects.remove(item)
            if mesh and mesh.users == 0:
                bpy.data.meshes.remove(mesh)
    _shown.clear()
    _reported.clear()
    spacing = run.spacing or spacing or 0.02
    for kind, files in run.files.items():
        if not files:
            continue
        mesh = bpy.data.meshes.new(f"Splashdown {kind}")
        item = bpy.data.objects.new(f"Splashdown {kind}", mesh)
        collection.objects.link(item)
        settings = item.splashdown
        settings.kind, settings.first_frame = kind, scene.frame_start
        settings.folder = str(Path(folder))
        # Foam is drawn smaller than the particles of the liquid.
        settings.point_radius = spacing * (0.5 if kind == "droplets" else 0.08)
        material = materials.liquid(liquid) if kind in ("surface", "droplets") else materials.foam()
        mesh.materials.append(material)
        if kind != "surface":
            modifier = item.modifiers.new("Points", "NODES")
            modifier.node_group = points_tree(material)
    update(scene)
    return run


def file_of(item, frame):
    """The file of an object at a frame of the timeline, or the last one before it; None before the first."""
    settings = item.splashdown
    folder = bpy.path.abspath(settings.folder)
    number = frame - settings.first_frame
    # The nearest earlier frame stands in for missing and truncated ones.
    for candidate in range(number, max(number - 500, -1), -1):
        path = run_folder.path_of(folder, settings.kind, candidate)
        if path.exists() and path not in _reported:
            return path
    return None


def show(item, path):
    """Replaces the mesh of an object by that of a file. Raises ply.PlyError or OSError."""
    mesh = item.data
    arrays = ply.read(path) if path else {}
    vertices = arrays.get("vertex")
    positions = ply.vectors(vertices, "xyz") if vertices is not None else np.zeros((0, 3), np.float32)
    if positions is None:
        raise ply.PlyError("no positions")
    faces = arrays.get("face")
    mesh.clear_geometry()
    mesh.vertices.add(len(positions))
    mesh.vertices.foreach_set("co", positions.ravel())
    if faces is not None and len(faces):
        corners = np.ascontiguousarray(faces["corners"], np.int32)
        mesh.loops.add(corners.size)
        mesh.loops.foreach_set("vertex_index", corners.ravel())
        mesh.polygons.add(len(corners))
        mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, 3, dtype=np.int32))
        mesh.update(calc_edges=True)
        mesh.shade_smooth()
    if len(positions):
        # Cycles blurs the motion of meshes and points that have an attribute of this name, in m/s.
        velocities = ply.vectors(vertices, ("vx", "vy", "vz"))
        if velocities is not None:
            attribute = mesh.attributes.new("velocity", "FLOAT_VECTOR", "POINT")
            attribute.data.foreach_set("vector", np.ascontiguousarray(velocities).ravel())
        if item.splashdown.kind != "surface":
            radii = np.full(len(positions), item.splashdown.point_radius, np.float32)
            if "width" in vertices.dtype.names:
                radii = 0.5 * vertices["width"].astype(np.float32)
            attribute = mesh.attributes.new("radius", "FLOAT", "POINT")
            attribute.data.foreach_set("value", radii)
    mesh.update()


@persistent
def update(scene, _depsgraph=None):
    """Loads the current frame. A file that cannot be read is reported once and the last frame before it is shown."""
    for item in scene.objects:
        if not item.splashdown.kind or item.type != "MESH":
            continue
        while True:
            path = file_of(item, scene.frame_current)
            state = (str(path), path.stat().st_mtime_ns if path else 0, item.splashdown.point_radius)
            if _shown.get(item.data.name) == state:
                break
            try:
                show(item, path)
                _shown[item.data.name] = state
                break
            except (OSError, ply.PlyError) as error:
                _reported.add(path)
                scene.splashdown.report = f"{path}: {error}. The frame before it is shown."
                print(f"Splashdown: {scene.splashdown.report}")


@persistent
def after_load(_file):
    """Forgets what the meshes of the previous file showed."""
    _shown.clear()
    _reported.clear()
    update(bpy.context.scene)


def register():
    bpy.app.handlers.frame_change_post.append(update)
    bpy.app.handlers.load_post.append(after_load)


def unregister():
    bpy.app.handlers.load_post.remove(after_load)
    bpy.app.handlers.frame_change_post.remove(update)
