"""Times a block of 2 m x 2 m x 2 m that collapses in a box of 6.4 m x 4 m x 2 m with SPlisHSPlasH's DFSPH.

usage: collapse.py SPACING SECONDS FOLDER

Solver, viscosity and tolerances are those of its own dam break. FOLDER receives the scene and the volume map of the box. The
number of threads comes from OMP_NUM_THREADS. Prints one line of JSON; the compression is the mean of max(0, rho/rho0 - 1)
over a sample of the particles in every tenth step.
"""

import ctypes
import json
import os
import sys
import tempfile
import time

# The wheel contains part of a GL library. Its import crashes on Debian unless the system's complete library is loaded first.
try:
    ctypes.CDLL("libGL.so.1", mode=ctypes.RTLD_GLOBAL)
except OSError:
    pass

import pysplishsplash as sph  # noqa: E402

SAMPLED = 500
BOX = [6.4, 4.0, 2.0]
BLOCK = 2.0


def scene(spacing, folder):
    """Writes the scene, based on the one in the wheel."""
    data = os.path.join(sys.prefix, "bin", "data")
    with open(os.path.join(data, "Scenes", "DamBreakModel.json")) as file:
        scene = json.load(file)
    scene["Configuration"]["particleRadius"] = spacing / 2
    [box], [block] = scene["RigidBodies"], scene["FluidBlocks"]
    box["geometryFile"] = os.path.join(data, "models", "UnitBox.obj")
    box["scale"] = BOX
    box["translation"] = [length / 2 for length in BOX]
    box["mapResolution"] = [round(length / spacing / 2) for length in BOX]
    # The first particle is a spacing from the start, and the block contains one row of particles fewer than its length
    # divided by the spacing.
    block["start"] = [0, 0, 0]
    block["end"] = [BLOCK + spacing] * 3
    block["translation"] = [-spacing / 2] * 3
    path = os.path.join(folder, f"collapse_{spacing}.json")
    with open(path, "w") as file:
        json.dump(scene, file)
    return path


def main():
    spacing, seconds, place = float(sys.argv[1]), float(sys.argv[2]), sys.argv[3]
    with tempfile.TemporaryDirectory() as folder:
        base = sph.Exec.SimulatorBase()
        base.init(
            sceneFile=scene(spacing, place),
            outputDir=os.path.join(folder, "out"),
            initialPause=False,
            useGui=False,
            stopAt=seconds,
        )
        base.initSimulation()
        simulation, clock = sph.Simulation.getCurrent(), sph.TimeManager.getCurrent()
        model = simulation.getFluidModel(0)
        count, rest = model.numActiveParticles(), model.getDensity0()
        some = range(0, count, max(1, count // SAMPLED))
        steps, means, sampling = 0, [], 0.0

        def after_step():
            nonlocal steps, sampling
            steps += 1
            if steps % 10 == 0:
                begun = time.perf_counter()
                excess = (max(0.0, model.getDensity(i) / rest - 1) for i in some)
                means.append(sum(excess) / len(some))
                sampling += time.perf_counter() - begun

        base.setTimeStepCB(after_step)
        begun = time.perf_counter()
        base.runSimulation()
        wall = time.perf_counter() - begun - sampling
        answer = {
            "particles": count,
            "steps": steps,
            "wall": wall,
            "simulated_per_wall": clock.getTime() / wall,
            "compression": sum(means) / max(1, len(means)),
        }
    # The program logs to stdout, so the result is the last line.
    print("\n" + json.dumps(answer), flush=True)


main()
