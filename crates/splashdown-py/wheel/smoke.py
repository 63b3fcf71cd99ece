"""Checks the wheel in an environment with NumPy only, and prints the time of `import splashdown` in ms as the last line.

The time is the shortest of ten new interpreters that import NumPy and Splashdown, minus that of NumPy alone, whose import
Splashdown needs in any case; in brackets the time of NumPy. The shortest time depends least on other programs.
"""

import subprocess
import sys
import sysconfig
import time
from pathlib import Path

import splashdown

scene = splashdown.Scene.preset("dam-break-small")
with splashdown.Simulation(scene, device="cpu") as simulation:
    simulation.advance(0.01)
    assert simulation.positions.shape == (len(simulation), 3)
try:
    splashdown.sweep(scene, [{}], folder="unused")
except splashdown.MissingPackageError as error:
    assert "pip install 'splashdown[sweep]'" in str(error)
else:
    raise AssertionError("this environment is not empty: it contains pandas")
program = Path(sysconfig.get_path("scripts")) / "splashdown"
version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
assert version.split() == ["splashdown", splashdown.__version__], version


def seconds(code: str) -> float:
    """The wall time of a new interpreter."""
    begun = time.perf_counter()
    subprocess.run([sys.executable, "-c", code], check=True)
    return time.perf_counter() - begun


codes = ["pass", "import numpy", "import numpy, splashdown"]
rounds = [[seconds(code) for code in codes] for _ in range(10)]
nothing, numpy, both = (min(times) for times in zip(*rounds))
print(f"{1e3 * (both - numpy):.0f} ms ({1e3 * (numpy - nothing):.0f} ms for NumPy)")
