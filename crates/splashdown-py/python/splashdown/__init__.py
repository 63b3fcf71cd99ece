"""Fast SPH water on any GPU: simulation, surface reconstruction and parameter studies.

Lengths are in m, times in s, masses in kg; y is up. Arrays that the package returns are read-only
views of host memory without a copy. They stay valid and unchanged as long as you hold them, whatever
happens to the simulation; copy one to change it.

Every item has an example that the tests run. The examples use this scene, a column of water beside a crate that falls,
and what follows:

>>> import numpy, pathlib, splashdown, tempfile
>>> scene = splashdown.Scene(
...     scene={"name": "column", "duration": 0.5},  # s
...     domain={"min": [0, 0, 0], "max": [1.6, 1.0, 0.5]},  # m
...     fluid={"particle_spacing": 0.1, "block": [{"position": [0, 0, 0], "size": [0.4, 0.6, 0.5]}]},
...     body=[{"name": "crate", "mesh": "cube", "scale": 0.2, "position": [1, 0.5, 0.25], "motion": "dynamic"}],
...     probe=[{"name": "gauge", "quantity": "height", "position": [0.2, 0, 0.25]}],
...     foam={"enabled": True},
...     output={"picture_size": [320, 180]},
... )
>>> with splashdown.Simulation(scene, device="cpu") as simulation:
...     stats = simulation.advance(0.01)  # s
...     positions = simulation.positions  # (N, 3) float32, m
>>> positions.shape == (stats.particles, 3)
True
>>> simulation = splashdown.Simulation(scene, device="cpu")
>>> frame = next(splashdown.Run(scene, device="cpu"))
>>> folder = pathlib.Path(tempfile.mkdtemp())
"""

import os as _os
import sys as _sys
import tempfile as _tempfile

from splashdown._errors import (
    ArrayError,
    CheckpointError,
    ClosedError,
    DeviceError,
    Error,
    FileError,
    MissingPackageError,
    ParameterError,
    SceneError,
    SimulationError,
    SimulationWarning,
    VersionError,
)
from splashdown._splashdown import (
    Body,
    Checkpoint,
    Foam,
    Frame,
    Mesh,
    Painter,
    Particles,
    Progress,
    Run,
    Scene,
    Simulation,
    Stats,
    __version__,
    mesh_formats,
    particle_formats,
    read_mesh,
    read_particles,
    run,
    surface,
    write_mesh,
    write_particles,
)
from splashdown._sweep import DrawPicture, ReconstructSurface, grid, map_frames, sweep
from splashdown._types import RunFiles

if _sys.platform == "linux":
    # Mesa prints a message that looks like an error of this program where the variable is missing. Any folder prevents it.
    _os.environ.setdefault("XDG_RUNTIME_DIR", _tempfile.gettempdir())

__all__ = [
    "ArrayError",
    "Body",
    "Checkpoint",
    "CheckpointError",
    "ClosedError",
    "DeviceError",
    "DrawPicture",
    "Error",
    "FileError",
    "Foam",
    "Frame",
    "Mesh",
    "MissingPackageError",
    "Painter",
    "ParameterError",
    "Particles",
    "Progress",
    "ReconstructSurface",
    "Run",
    "RunFiles",
    "Scene",
    "SceneError",
    "Simulation",
    "SimulationError",
    "SimulationWarning",
    "Stats",
    "VersionError",
    "__version__",
    "grid",
    "map_frames",
    "mesh_formats",
    "particle_formats",
    "read_mesh",
    "read_particles",
    "run",
    "surface",
    "sweep",
    "write_mesh",
    "write_particles",
]

# Tracebacks and `help` name the classes where they are public.
for _name in __all__:
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = __name__
