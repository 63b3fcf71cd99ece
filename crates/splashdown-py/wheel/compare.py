"""Compares `splashdown.surface` with pysplashsurf: both alternately in one process, from an array to a mesh in memory.

usage: compare.py PARTICLES SPACING PAGE

PARTICLES is a .npy file of float32 (N, 3); SPACING is the distance of the particles in m. Writes the table into PAGE, a file
of Markdown. The number of threads of both comes from RAYON_NUM_THREADS.
"""

import datetime
import os
import statistics
import sys
import time
from pathlib import Path

import numpy
import pysplashsurf

import splashdown

#: Cell sizes in particle radii, and numbers of smoothing iterations: those of `cargo xtask bench --peers`.
CASES = [(1.0, 0), (1.0, 25), (0.5, 0), (0.5, 25)]
REPETITIONS = 7
#: Our speed over that of splashsurf may not be lower.
BAR = 1.5


def timed(function):
    """Seconds of a call, and its result."""
    begun = time.perf_counter()
    result = function()
    return time.perf_counter() - begun, result


def compare(points, radius, cell, smoothing):
    """The medians of both in s, and the numbers of vertices."""
    options = {}
    if smoothing:
        options = {"mesh_cleanup": True, "mesh_smoothing_iters": smoothing, "compute_normals": True}

    def ours():
        return len(
            splashdown.surface(
                points, 2 * radius, support_radius=4 * radius, cell_size=cell * radius, smoothing=smoothing, device="cpu"
            ).vertices
        )

    def theirs():
        found = pysplashsurf.reconstruction_pipeline(
            points,
            particle_radius=radius,
            smoothing_length=2.0,
            cube_size=cell,
            iso_surface_threshold=0.6,
            **options,
        )
        found = found[0] if isinstance(found, tuple) else found
        return len(found.mesh.vertices)

    times, vertices = ([], []), [0, 0]
    for _ in range(REPETITIONS):
        for side, function in enumerate((ours, theirs)):
            seconds, vertices[side] = timed(function)
            times[side].append(seconds)
    return [statistics.median(side) for side in times], vertices


def main():
    path, spacing, page = Path(sys.argv[1]), float(sys.argv[2]), Path(sys.argv[3])
    points = numpy.ascontiguousarray(numpy.load(path), dtype=numpy.float32)
    threads = os.environ.get("RAYON_NUM_THREADS", str(os.cpu_count()))
    lines = [
        "# Surface reconstruction from Python",
        "",
        f"Written by `cargo xtask wheel --compare`, {datetime.date.today()}, with {threads} threads. Both packages run",
        f"alternately in one process, {REPETITIONS} times each; the figures are medians from an array to the mesh in memory.",
        f"Particles: `{path.name}`, {len(points)} of them, radius {spacing / 2} m. [Comparison with other programs](peers.md)",
        "has the same cases with the command line.",
        "",
        "<!-- ANCHOR: surface -->",
        "| cells, smoothing | vertices, ours / pysplashsurf | ms, ours / pysplashsurf | speed, ours over theirs |",
        "|---|---:|---:|---:|",
    ]
    for cell, smoothing in CASES:
        (ours, theirs), vertices = compare(points, spacing / 2, cell, smoothing)
        name = f"{cell} r, " + (f"{smoothing} rounds" if smoothing else "plain")
        met = "met" if theirs / ours >= BAR else "**missed**"
        lines.append(
            f"| {name} | {vertices[0]} / {vertices[1]} | {1e3 * ours:.1f} / {1e3 * theirs:.1f} | "
            f"{theirs / ours:.2f} (bar {BAR}: {met}) |"
        )
        print(lines[-1], flush=True)
    lines += ["<!-- ANCHOR_END: surface -->", ""]
    page.write_text("\n".join(lines))


main()
