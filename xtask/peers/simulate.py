"""Times a case of `xtask/src/peers/cases.rs` with SPlisHSPlasH's DFSPH.

usage: simulate.py CASE FOLDER

CASE is the case as JSON. Solver, viscosity and tolerances are those of the program's own dam break; honey has the viscosity of
Weiler et al. (2018). FOLDER receives the scene and the volume maps. The number of threads comes from OMP_NUM_THREADS. Prints
one line of JSON; the compression is the mean of max(0, rho/rho0 - 1) over a sample of the particles in every tenth step.
"""

import ctypes
import json
import os
import sys
import tempfile
import time

import numpy as np

# The wheel contains part of a GL library. Its import crashes on Debian unless the system's complete library is loaded first.
try:
    ctypes.CDLL("libGL.so.1", mode=ctypes.RTLD_GLOBAL)
except OSError:
    pass

import pysplishsplash as sph  # noqa: E402
from state import measure  # noqa: E402

SAMPLED = 500
# Distance between blocks and walls in spacings.
GAP = 1.0


def solid(box, size, centre, spacing):
    """A box of this size."""
    return {
        "geometryFile": box,
        "translation": centre,
        "scale": size,
        "rotationAxis": [1, 0, 0],
        "rotationAngle": 0,
        "collisionObjectType": 2,
        "collisionObjectScale": size,
        "mapThickness": 0.0,
        "mapResolution": [max(10, round(length / spacing / 2)) for length in size],
    }


def scene(case, folder):
    """Writes the scene, based on the one in the wheel."""
    data = os.path.join(sys.prefix, "bin", "data")
    with open(os.path.join(data, "Scenes", "DamBreakModel.json")) as file:
        scene = json.load(file)
    spacing = case["spacing"]
    scene["Configuration"]["particleRadius"] = spacing / 2
    box, domain = os.path.join(data, "models", "UnitBox.obj"), case["domain"]
    # Water that touches the walls bursts: a block must keep a distance from them, as in the program's own scenes. The box is
    # larger by this distance on every side, so that the block has the particles of ours.
    walls = solid(box, [length + 2 * GAP * spacing for length in domain], [length / 2 for length in domain], spacing)
    walls.update(id=1, isDynamic=False, isWall=True, mapInvert=True, invertSDF=True)
    scene["RigidBodies"] = [walls]
    if case["cube"]:
        cube = solid(box, [case["cube"]["edge"]] * 3, case["cube"]["centre"], spacing)
        cube.update(id=2, isDynamic=True, isWall=False, mapInvert=False, density=case["cube"]["density"])
        # As its scene with floating bodies.
        scene["Configuration"]["cflFactor"] = 0.5
        scene["RigidBodies"].append(cube)
    if case["viscosity"]:
        [material] = scene["Materials"]
        del material["Standard viscosity"]
        weiler = {"viscosity": case["viscosity"], "viscosityBoundary": case["viscosity"], "viscoMaxIter": 200, "viscoMaxError": 0.05}
        material.update({"viscosityMethod": 6, "Weiler et al. 2018": weiler})
    # The first particle is a spacing from the start, and the block contains one row of particles fewer than its length
    # divided by the spacing.
    [block] = scene["FluidBlocks"]
    block["start"] = case["position"]
    block["end"] = [start + length + spacing for start, length in zip(case["position"], case["size"])]
    block["translation"] = [-spacing / 2] * 3
    path = os.path.join(folder, f"{case['name']}_{spacing}.json")
    with open(path, "w") as file:
        json.dump(scene, file)
    return path


def particles(model):
    """Positions and velocities."""
    some = range(model.numActiveParticles())
    return np.array([model.getPosition(i) for i in some]), np.array([model.getVelocity(i) for i in some])


def main():
    case, place = json.loads(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        base = sph.Exec.SimulatorBase()
        base.init(
            sceneFile=scene(case, place),
            outputDir=os.path.join(folder, "out"),
            initialPause=False,
            useGui=False,
            stopAt=case["seconds"],
        )
        base.initSimulation()
        simulation, clock = sph.Simulation.getCurrent(), sph.TimeManager.getCurrent()
        model = simulation.getFluidModel(0)
        first, rest = particles(model), model.getDensity0()
        some = range(0, len(first[0]), max(1, len(first[0]) // SAMPLED))
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
            "steps": steps,
            "wall": wall,
            "simulated_per_wall": clock.getTime() / wall,
            "compression": sum(means) / max(1, len(means)),
            **measure(first, particles(model)),
        }
    # The program logs to stdout, so the result is the last line.
    print("\n" + json.dumps(answer), flush=True)


main()
