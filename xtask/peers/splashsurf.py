"""Measures the time or the memory of a surface reconstruction with splashsurf.

usage: splashsurf.py time PARTICLES RADIUS CELL SMOOTHING REPETITIONS
       splashsurf.py memory PARTICLES.xyz RADIUS CELL SMOOTHING
       splashsurf.py convert PARTICLES PARTICLES.xyz

Particles are .npy, or .npz with an array `positions`; splashsurf's command line reads .xyz. Lengths follow splashsurf's convention:
the radius in the particles' unit, cells in radii. Smoothing includes clean-up, weights and normals. Memory is that of splashsurf's
command line, without that of Python. The number of threads comes from RAYON_NUM_THREADS. Prints one line of JSON.
"""

import json
import os
import statistics
import sys
import tempfile
import time

import numpy
import pysplashsurf

SMOOTHING_LENGTH, THRESHOLD = 2.0, 0.6


def memory(name):
    """A memory figure of this process from the system, in bytes; peaks count from the start of the program."""
    with open("/proc/self/status") as file:
        [line] = [line for line in file if line.startswith(name + ":")]
    return 1024 * int(line.split()[1])


def load(path):
    particles = numpy.load(path)
    if path.endswith(".npz"):
        particles = particles["positions"]
    return numpy.ascontiguousarray(particles, dtype=numpy.float32)


def timed(path, radius, cell, smoothing, repetitions):
    particles = load(path)
    options = {}
    if int(smoothing) > 0:
        options = {"mesh_cleanup": True, "mesh_smoothing_iters": int(smoothing), "compute_normals": True}
    times = []
    for _ in range(int(repetitions)):
        start = time.perf_counter()
        mesh = pysplashsurf.reconstruction_pipeline(
            particles,
            particle_radius=float(radius),
            smoothing_length=SMOOTHING_LENGTH,
            cube_size=float(cell),
            iso_surface_threshold=THRESHOLD,
            **options,
        )
        times.append(time.perf_counter() - start)
    [mesh, *_] = mesh if isinstance(mesh, tuple) else (mesh,)
    vertices = len(mesh.mesh.vertices)
    return {"particles": len(particles), "vertices": vertices, "seconds": statistics.median(times)}


def measured(path, radius, cell, smoothing):
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["splashsurf", "reconstruct", path, "-q", "-o", os.path.join(folder, "mesh.ply")]
        arguments += ["-r", radius, "-l", str(SMOOTHING_LENGTH), "-c", cell, "-t", str(THRESHOLD)]
        if int(smoothing) > 0:
            arguments += ["--mesh-smoothing-iters", smoothing, "--mesh-smoothing-weights=on"]
            arguments += ["--mesh-cleanup=on", "--normals=on"]
        before = memory("VmRSS")
        pysplashsurf.run_splashsurf(arguments)
        return {"start_memory": before, "peak_memory": memory("VmHWM")}


def converted(path, to):
    particles = load(path)
    particles.tofile(to)
    return {"particles": len(particles)}


commands = {"time": timed, "memory": measured, "convert": converted}
print(json.dumps(commands[sys.argv[1]](*sys.argv[2:])))
