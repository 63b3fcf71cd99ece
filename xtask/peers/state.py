"""Energy and front of fluid, by one formula for both programs.

usage: state.py FOLDER

FOLDER contains the particles of all frames as NPZ files of Splashdown. Prints one line of JSON. `simulate.py` imports `measure`.
"""

import json
import sys
from pathlib import Path

import numpy as np

GRAVITY = 9.81
REST_DENSITY = 1000.0


def energy(positions, velocities):
    """Kinetic plus potential energy per mass, in J/kg, above y = 0."""
    return 0.5 * np.mean(np.sum(velocities**2, axis=1)) + GRAVITY * np.mean(positions[:, 1])


def measure(first, last):
    """The numbers of the table, from (positions, velocities) at the start and at the end."""
    return {
        "particles": len(last[0]),
        "energy": float(energy(*last) / energy(*first)),
        "front": float(np.percentile(last[0][:, 0], 98)),
    }


def main():
    files = sorted(Path(sys.argv[1]).glob("*.npz"))
    frames = [np.load(file) for file in (files[0], files[-1])]
    result = measure(*((frame["positions"], frame["velocities"]) for frame in frames))
    excess = [np.mean(np.maximum(0, np.load(file)["densities"] / REST_DENSITY - 1)) for file in files]
    result["compression"] = float(np.mean(excess))
    print(json.dumps(result))


if __name__ == "__main__":
    main()
