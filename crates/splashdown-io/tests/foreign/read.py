"""Opens files with other software and prints sums of their arrays as JSON.

usage: read.py READER FILE [READER FILE ...]

A reader returns a dictionary of arrays by name. For each array the script prints its shape and two sums: that of the
values, and that of the values times their index modulo 97 plus 1, which detects values in a wrong order.
"""

import importlib
import json
import sys


def vtk_arrays(grid):
    from vtk.util.numpy_support import vtk_to_numpy as to_numpy

    data = grid.GetPointData()
    arrays = {data.GetArrayName(n): to_numpy(data.GetArray(n)) for n in range(data.GetNumberOfArrays())}
    arrays["positions"] = to_numpy(grid.GetPoints().GetData())
    if grid.IsA("vtkUnstructuredGrid"):
        cells = grid.GetCells()
    else:
        cells = grid.GetPolys() if grid.GetNumberOfPolys() else grid.GetVerts()
    arrays["cells"] = to_numpy(cells.GetConnectivityArray())
    if data.GetNormals():
        arrays["active normals"] = to_numpy(data.GetNormals())
    field = grid.GetFieldData()
    for n in range(field.GetNumberOfArrays()):
        arrays[f"field {field.GetArrayName(n)}"] = to_numpy(field.GetArray(n))
    return arrays


def vtk_legacy_of(reader, path):
    reader.SetFileName(path)
    reader.ReadAllScalarsOn()
    reader.ReadAllVectorsOn()
    reader.ReadAllNormalsOn()
    reader.ReadAllFieldsOn()
    reader.Update()
    return vtk_arrays(reader.GetOutput())


def vtk_legacy(path):
    import vtk

    return vtk_legacy_of(vtk.vtkUnstructuredGridReader(), path)


def vtk_legacy_surface(path):
    import vtk

    return vtk_legacy_of(vtk.vtkPolyDataReader(), path)


def vtk_xml_of(reader, path):
    import vtk

    reader.SetFileName(path)
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    reader.Update()
    return {**vtk_arrays(reader.GetOutput()), "time steps": times or []}


def vtk_xml(path):
    import vtk

    return vtk_xml_of(vtk.vtkXMLUnstructuredGridReader(), path)


def vtk_xml_surface(path):
    import vtk

    return vtk_xml_of(vtk.vtkXMLPolyDataReader(), path)


def vtk_ply(path):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy as to_numpy

    reader = vtk.vtkPLYReader()
    reader.SetFileName(path)
    reader.Update()
    mesh = reader.GetOutput()
    return {
        "positions": to_numpy(mesh.GetPoints().GetData()),
        "cells": to_numpy(mesh.GetPolys().GetConnectivityArray()),
        "normals": to_numpy(mesh.GetPointData().GetNormals()),
    }


def of_meshio(path):
    import meshio

    mesh = meshio.read(path)
    cells = mesh.cells_dict
    cells = cells.get("triangle", cells.get("vertex"))
    # The properties of PLY particles are separate arrays.
    data = {name: values for name, values in mesh.point_data.items()}
    data.update({f"field {name}": values for name, values in mesh.field_data.items()})
    return {"positions": mesh.points, **({} if cells is None else {"cells": cells}), **data}


def of_trimesh(path):
    import trimesh

    scene = trimesh.load(path, process=False)
    mesh = scene.to_geometry() if isinstance(scene, trimesh.Scene) else scene
    arrays = {"positions": mesh.vertices, "cells": mesh.faces, **mesh.vertex_attributes}
    arrays["volume"] = [mesh.volume]
    # Closed, oriented, and not inside out.
    arrays["is volume"] = [1.0 if mesh.is_volume else 0.0]
    if "vertex_normals" in mesh._cache.cache:
        arrays["normals"] = mesh.vertex_normals
    return arrays


def of_numpy(path):
    import numpy

    with numpy.load(path) as archive:
        return dict(archive)


def of_splashsurf(path):
    """The positions in a VTK file to which the command line of splashsurf has converted the file."""
    import os
    import subprocess
    import tempfile

    import meshio

    with tempfile.TemporaryDirectory() as folder:
        to = os.path.join(folder, "converted.vtk")
        script = "import sys, pysplashsurf; pysplashsurf.run_splashsurf(sys.argv[1:])"
        arguments = ["splashsurf", "convert", "--particles", path, "-o", to]
        done = subprocess.run([sys.executable, "-c", script, *arguments], capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(done.stdout + done.stderr)
        return {"positions": meshio.read(to).points}


def usd(path):
    """Every time sample of every attribute, as `name@time`."""
    import numpy
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.Open(path)
    prim = stage.GetDefaultPrim().GetChildren()[0]
    arrays = {
        "start": [stage.GetStartTimeCode()],
        "end": [stage.GetEndTimeCode()],
        "rate": [stage.GetTimeCodesPerSecond()],
        "metres": [UsdGeom.GetStageMetersPerUnit(stage)],
        "y is up": [1.0 if UsdGeom.GetStageUpAxis(stage) == "Y" else 0.0],
    }
    if prim.IsA(UsdGeom.Mesh):
        for code in prim.GetAttribute("points").GetTimeSamples():
            valid, _ = UsdGeom.Mesh.ValidateTopology(
                prim.GetAttribute("faceVertexIndices").Get(code),
                prim.GetAttribute("faceVertexCounts").Get(code),
                len(prim.GetAttribute("points").Get(code)),
            )
            assert valid, f"triangles of frame {code}"
    for attribute in prim.GetAttributes():
        for code in attribute.GetTimeSamples():
            values = attribute.Get(code)
            arrays[f"{attribute.GetName()}@{code:g}"] = [] if values is None else numpy.array(values)
    return arrays


def blender(path):
    """Points, triangles and the velocity attribute of the first object in Blender's scene, at its first two frames."""
    import bpy
    import numpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    ending = path.rsplit(".", 1)[1]
    if ending.startswith("usd"):
        bpy.ops.wm.usd_import(filepath=path)
    elif ending == "glb":
        bpy.ops.import_scene.gltf(filepath=path)
    elif ending == "ply":
        bpy.ops.wm.ply_import(filepath=path)
    elif ending == "obj":
        bpy.ops.wm.obj_import(filepath=path)
    else:
        bpy.ops.wm.stl_import(filepath=path)
    arrays = {}
    item = next(item for item in bpy.data.objects if item.type in ("MESH", "POINTCLOUD"))
    for frame in [bpy.context.scene.frame_start, bpy.context.scene.frame_start + 1]:
        bpy.context.scene.frame_set(frame)
        shown = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
        data = shown.data
        positions = data.attributes["position"].data
        local = numpy.zeros(3 * len(positions))
        positions.foreach_get("vector", local)
        # In Blender z is up.
        turn = numpy.array(shown.matrix_world)[:3, :3]
        arrays[f"positions@{frame}"] = local.reshape(-1, 3) @ turn.T
        if item.type == "MESH":
            arrays[f"triangles@{frame}"] = [float(len(data.polygons))]
        if "velocity" in data.attributes:
            velocity = data.attributes["velocity"].data
            values = numpy.zeros(3 * len(velocity))
            velocity.foreach_get("vector", values)
            arrays[f"velocity@{frame}"] = values.reshape(-1, 3) @ turn.T
    return arrays


READERS = {
    "vtk": (vtk_legacy, "vtk"),
    "vtk-surface": (vtk_legacy_surface, "vtk"),
    "vtu": (vtk_xml, "vtk"),
    "vtp": (vtk_xml_surface, "vtk"),
    "vtk-ply": (vtk_ply, "vtk"),
    "meshio": (of_meshio, "meshio"),
    "trimesh": (of_trimesh, "trimesh"),
    "numpy": (of_numpy, "numpy"),
    "splashsurf": (of_splashsurf, "pysplashsurf"),
    "usd": (usd, "pxr"),
    "blender": (blender, "bpy"),
}


def summed(values):
    import numpy

    # JSON has only finite numbers. Libraries differ in the shape of arrays with one column.
    values = numpy.nan_to_num(numpy.asarray(values, dtype=float), nan=0.0, posinf=0.0, neginf=0.0)
    if values.ndim == 2 and values.shape[1] == 1:
        values = values[:, 0]
    flat = values.ravel()
    weights = numpy.arange(flat.size) % 97 + 1
    return {"shape": list(values.shape), "sum": float(flat.sum()), "weighted": float((flat * weights).sum())}


def main():
    arguments = sys.argv[1:]
    try:
        importlib.import_module("numpy")
        for name in arguments[0::2]:
            importlib.import_module(READERS[name][1])
    except ImportError as error:
        print(f"missing: {error}", file=sys.stderr)
        sys.exit(77)
    answers = []
    for name, path in zip(arguments[0::2], arguments[1::2]):
        answers.append({key: summed(values) for key, values in READERS[name][0](path).items()})
    # Only the last line is read, because some libraries print messages.
    print(json.dumps(answers))


main()
