"""Times steps of SPlisHSPlasH: its own dam break, with the block and the box twice as long.

usage: splishsplash.py wcsph|dfsph DIVISOR STEPS FOLDER

The block has 40 particles per edge (64,000), divided by DIVISOR for a trial. WCSPH uses the stiffness, exponent and time
step below; DFSPH is as in the scene. FOLDER receives the scene and the volume map of the box. The number of threads comes
from OMP_NUM_THREADS. Prints one line of JSON.
"""

import ctypes
import json
import os
import resource
import statistics
import sys
import tempfile
import time

# The wheel contains part of a GL library. Its import crashes on Debian unless the system's complete library is loaded first.
try:
    ctypes.CDLL("libGL.so.1", mode=ctypes.RTLD_GLOBAL)
except OSError:
    pass

import pysplishsplash as sph  # noqa: E402

STIFFNESS, EXPONENT, DT = 50_000, 7, 1e-4
WARM_UP = 20
SAMPLED = 500


def scene(method, divisor, folder):
    """Writes the scene, based on the one in the wheel."""
    data = os.path.join(sys.prefix, "bin", "data")
    with open(os.path.join(data, "Scenes", "DamBreakModel.json")) as file:
        scene = json.load(file)
    scale = 2.0 / divisor
    configuration = scene["Configuration"]
    if method == "wcsph":
        with open(os.path.join(data, "Scenes", "CompressibleSPH_WCSPH.json")) as file:
            configuration["simulationMethod"] = json.load(file)["Configuration"]["simulationMethod"]
        configuration.update(timeStepSize=DT, cflMethod=0, WCSPH={"stiffness": STIFFNESS, "exponent": EXPONENT})
    [box], [block] = scene["RigidBodies"], scene["FluidBlocks"]
    box["geometryFile"] = os.path.join(data, "models", "UnitBox.obj")
    for owner, keys in ((box, ("translation", "scale")), (block, ("start", "end"))):
        for key in keys:
            owner[key] = [scale * x for x in owner[key]]
    # The block contains one row of particles fewer than its length divided by the spacing.
    block["end"] = [x + 2 * configuration["particleRadius"] for x in block["end"]]
    # A corner of the box, at the distance from the walls that the original scene has.
    gap, [left, floor] = 0.05, [box["translation"][axis] - box["scale"][axis] / 2 for axis in (0, 1)]
    block["translation"] = [left + gap - block["start"][0], floor + gap - block["start"][1], 0]
    path = os.path.join(folder, f"{method}_{divisor}.json")
    with open(path, "w") as file:
        json.dump(scene, file)
    return path


def neighbours(simulation):
    """Mean numbers of fluid and boundary neighbours of some particles."""
    count = simulation.getFluidModel(0).numActiveParticles()
    some = range(0, count, max(1, count // SAMPLED))
    sets = range(simulation.numberOfPointSets())
    near = [[simulation.numberOfNeighbors(0, s, i) for i in some] for s in sets]
    return [statistics.mean(numbers) for numbers in near]


def main():
    method, divisor, steps, place = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4]
    with tempfile.TemporaryDirectory() as folder:
        base = sph.Exec.SimulatorBase()
        base.init(
            sceneFile=scene(method, divisor, place),
            outputDir=os.path.join(folder, "out"),
            initialPause=False,
            useGui=False,
            stopAt=1e6,
        )
        base.initSimulation()
        simulation, clock = sph.Simulation.getCurrent(), sph.TimeManager.getCurrent()
        moments = []

        def after_step():
            moments.append(time.perf_counter())
            if len(moments) == WARM_UP + steps:
                base.setValueFloat(base.STOP_AT, clock.getTime())

        base.setTimeStepCB(after_step)
        base.runSimulation()
        times = [after - before for before, after in zip(moments, moments[1:])]
        times = times[WARM_UP - 1 :]
        answer = {
            "particles": simulation.getFluidModel(0).numActiveParticles(),
            "support_radius": simulation.getSupportRadius(),
            "spacing": 2 * simulation.getParticleRadius(),
            "seconds_per_step": statistics.median(times),
            "simulated": clock.getTime(),
            "dt": clock.getTimeStepSize(),
            "neighbours": neighbours(simulation),
            "peak_memory": 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss,
        }
    # The program logs to stdout, so the result is the last line.
    print("\n" + json.dumps(answer), flush=True)


main()
