"""Reconstructs particles with splashsurf and compares a mesh with the result.

usage: splashsurf.py PARTICLES SPACING CELL ITERATIONS LEVEL MESH

Prints JSON: the Hausdorff distance of the two meshes in cells, and their volumes. VTK computes both.
"""

import json
import os
import subprocess
import sys
import tempfile

try:
    import pysplashsurf  # noqa: F401
    import vtk
except ImportError as error:
    print(f"missing: {error}", file=sys.stderr)
    sys.exit(77)


def read(path):
    reader = vtk.vtkPLYReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def volume(mesh):
    properties = vtk.vtkMassProperties()
    properties.SetInputData(mesh)
    properties.Update()
    return properties.GetVolume()


def main():
    particles, spacing, cell, iterations, level, path = sys.argv[1:]
    radius = float(spacing) / 2
    with tempfile.TemporaryDirectory() as folder:
        theirs = os.path.join(folder, "theirs.ply")
        script = "import sys, pysplashsurf; pysplashsurf.run_splashsurf(sys.argv[1:])"
        arguments = ["splashsurf", "reconstruct", particles, "-o", theirs, "-q"]
        # The support radius is twice the smoothing length: two spacings.
        arguments += ["-r", str(radius), "-l", "2.0", "-c", str(float(cell) / radius), "-t", level]
        if int(iterations) > 0:
            arguments += [f"--mesh-smoothing-iters={iterations}", "--mesh-smoothing-weights=on", "--mesh-cleanup=off"]
        done = subprocess.run([sys.executable, "-c", script, *arguments], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(done.stdout + done.stderr)
        theirs = read(theirs)
    ours = read(path)
    distance = vtk.vtkHausdorffDistancePointSetFilter()
    distance.SetInputData(0, ours)
    distance.SetInputData(1, theirs)
    distance.SetTargetDistanceMethodToPointToCell()
    distance.Update()
    answer = {
        "distance": distance.GetHausdorffDistance() / float(cell),
        "ours": volume(ours),
        "theirs": volume(theirs),
        "vertices": [ours.GetNumberOfPoints(), theirs.GetNumberOfPoints()],
    }
    print(json.dumps(answer))


main()
