"""Checks the objects and writes the scene file and its meshes. Blender has z up, Splashdown has y up."""

import json
import re
from pathlib import Path

import bmesh
import bpy
import numpy as np
from mathutils import Matrix

# Turns z up into y up: (x, y, z) becomes (x, z, -y).
TO_Y_UP = Matrix(((1, 0, 0), (0, 0, 1), (0, -1, 0)))


class SceneError(ValueError):
    """A scene that cannot be simulated, with what to change."""


def cache_folder(scene):
    """The absolute folder of the cache. Raises SceneError if it is relative to a file that is not saved."""
    path = scene.splashdown.cache.strip()
    if not path:
        raise SceneError("Choose a cache folder.")
    if path.startswith("//") and not bpy.data.filepath:
        raise SceneError("Save the .blend file first, or choose an absolute cache folder: this one is relative to it.")
    return Path(bpy.path.abspath(path))


def of_role(scene, role):
    return [item for item in scene.objects if item.splashdown.role == role and not item.splashdown.kind]


def mesh_of(item, matrix):
    """The evaluated mesh as a BMesh of triangles, transformed by a matrix. The caller frees it."""
    if item.type not in {"MESH", "CURVE", "SURFACE", "FONT", "META"}:
        raise SceneError(f"{item.name} has no mesh.")
    evaluated = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    built = bmesh.new()
    built.from_mesh(mesh)
    evaluated.to_mesh_clear()
    built.transform(matrix)
    if matrix.determinant() < 0:
        bmesh.ops.reverse_faces(built, faces=built.faces)
    bmesh.ops.triangulate(built, faces=built.faces)
    if not built.faces:
        built.free()
        raise SceneError(f"{item.name} has no faces.")
    return built


def is_closed(built):
    return all(len(edge.link_faces) == 2 for edge in built.edges)


def bounds(built):
    points = np.array([vertex.co for vertex in built.verts])
    return points.min(axis=0), points.max(axis=0)


def domain_bounds(scene):
    """The lower and upper corner of the domain in Blender's axes."""
    domains = of_role(scene, "DOMAIN")
    if not domains:
        raise SceneError("No domain: give one object the role Domain.")
    if len(domains) > 1:
        raise SceneError("Only one object can be the domain: " + ", ".join(item.name for item in domains) + ".")
    built = mesh_of(domains[0], domains[0].matrix_world)
    low, high = bounds(built)
    built.free()
    if (high - low).min() < 2 * scene.splashdown.spacing:
        raise SceneError(f"The domain {domains[0].name} is thinner than two particle spacings.")
    return low, high


def y_up(vector):
    return [float(vector[0]), float(vector[2]), float(-vector[1])]


def write_obj(built, path):
    lines = ["# written by the Blender extension of Splashdown; metres, y is up"]
    built.verts.index_update()
    lines += ["v {:.7g} {:.7g} {:.7g}".format(*(TO_Y_UP @ vertex.co)) for vertex in built.verts]
    lines += ["f " + " ".join(str(vertex.index + 1) for vertex in face.verts) for face in built.faces]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def safe_names(items):
    """Unique names of letters, digits, - and _ for objects."""
    names, used = [], set()
    for item in items:
        base = re.sub(r"[^A-Za-z0-9_-]+", "-", item.name).strip("-")[:50] or "object"
        name, number = base, 1
        while name.lower() in used:
            number += 1
            name = f"{base}-{number}"
        used.add(name.lower())
        names.append(name)
    return names


def poses(scene, items, frames):
    """The world matrices of objects at every frame. The current frame is restored."""
    found = {item.name: [] for item in items}
    current, subframe = scene.frame_current, scene.frame_subframe
    try:
        for frame in frames:
            scene.frame_set(frame)
            for item in items:
                found[item.name].append(item.matrix_world.copy())
    finally:
        scene.frame_set(current, subframe=subframe)
    return found


def differs(a, b, tolerance):
    return max(abs(x - y) for row_a, row_b in zip(a, b) for x, y in zip(row_a, row_b)) > tolerance


def table(name, values):
    """A TOML table. JSON texts, numbers and lists are valid TOML."""
    return "\n".join([name, *(f"{key} = {json.dumps(value)}" for key, value in values.items())]) + "\n"


def export(scene):
    """Writes scene.toml and meshes/ into the cache folder. Returns the path of the scene file.

    Raises SceneError if the scene is invalid and OSError if a file cannot be written.
    """
    settings = scene.splashdown
    folder = cache_folder(scene)
    frames = range(scene.frame_start, scene.frame_end + 1)
    if len(frames) < 2:
        raise SceneError("The timeline needs at least two frames.")
    obstacles, fluids = of_role(scene, "OBSTACLE"), of_role(scene, "FLUID")
    motions = poses(scene, obstacles, frames)
    current, subframe = scene.frame_current, scene.frame_subframe
    scene.frame_set(scene.frame_start)
    try:
        low, high = domain_bounds(scene)
        if not fluids:
            raise SceneError("No fluid: give at least one object the role Fluid.")
        meshes = folder / "meshes"
        meshes.mkdir(parents=True, exist_ok=True)
        rate = scene.render.fps / scene.render.fps_base
        gravity = scene.gravity if scene.use_gravity else (0, 0, 0)
        parts = [
            table(
                "[scene]",
                {
                    "name": "blender",
                    "duration": (len(frames) - 1) / rate,
                    "frame_rate": rate,
                    "gravity": y_up(gravity),
                },
            ),
            table(
                "[domain]",
                {"min": y_up((low[0], high[1], low[2])), "max": y_up((high[0], low[1], high[2]))},
            ),
        ]
        liquid = {"particle_spacing": settings.spacing}
        if settings.liquid == "custom":
            liquid |= {"density": settings.density, "viscosity": settings.viscosity}
        else:
            liquid["material"] = settings.liquid
        parts.append(table("[fluid]", liquid))
        for item, name in zip(fluids, safe_names(fluids)):
            built = mesh_of(item, item.matrix_world)
            try:
                if not is_closed(built):
                    raise SceneError(f"The fluid {item.name} is not closed. Fill its holes or remove loose faces.")
                inside = bounds(built)
                if (inside[1] <= low).any() or (inside[0] >= high).any():
                    raise SceneError(f"The fluid {item.name} is outside the domain.")
                if (inside[0] < low - settings.spacing).any() or (inside[1] > high + settings.spacing).any():
                    raise SceneError(f"The fluid {item.name} extends beyond the domain.")
                if built.calc_volume(signed=True) < 0:
                    bmesh.ops.reverse_faces(built, faces=built.faces)
                write_obj(built, meshes / f"fluid-{name}.obj")
            finally:
                built.free()
            values = {"mesh": f"meshes/fluid-{name}.obj", "velocity": y_up(item.splashdown.velocity)}
            parts.append(table("[[fluid.mesh]]", values))
        for item, name in zip(obstacles, safe_names(obstacles)):
            parts.append(body(item, name, motions[item.name], rate, meshes))
    finally:
        scene.frame_set(current, subframe=subframe)
    if settings.has_foam:
        parts.append(table("[foam]", {"enabled": True}))
    path = folder / "scene.toml"
    path.write_text("\n".join(parts), encoding="utf-8")
    return path


def body(item, name, motion, rate, meshes):
    """The table of an obstacle, with a keyframe per frame if it moves."""
    first = motion[0]
    size = max(max(item.dimensions), 1e-6)
    does_move = any(differs(first, matrix, 1e-6 * max(size, 1)) for matrix in motion)
    _, _, scale = first.decompose()
    # Scale and shear stay in the mesh; the keyframes have the rigid rest.
    rigid = Matrix.Translation(first.translation) @ first.to_quaternion().to_matrix().to_4x4()
    built = mesh_of(item, rigid.inverted() @ first if does_move else first)
    try:
        write_obj(built, meshes / f"body-{name}.obj")
    finally:
        built.free()
    values = {"name": name, "mesh": f"meshes/body-{name}.obj", "friction": item.splashdown.friction}
    if not does_move:
        return table("[[body]]", values)
    keys, euler = [], None
    for number, matrix in enumerate(motion):
        if max(abs(a - b) for a, b in zip(matrix.to_scale(), scale)) > 1e-3 * max(map(abs, scale)):
            raise SceneError(f"The scale of the obstacle {item.name} is animated. Obstacles can only move and turn.")
        turn = TO_Y_UP @ matrix.to_quaternion().to_matrix() @ TO_Y_UP.inverted()
        euler = turn.to_euler("XYZ", euler) if euler else turn.to_euler("XYZ")
        pose = {"position": y_up(matrix.translation), "rotation": [float(np.degrees(angle)) for angle in euler]}
        if not keys:
            values |= pose
        keys.append(table("[[body.keyframe]]", {"time": number / rate, **pose}))
    return "\n".join([table("[[body]]", values), *keys])
