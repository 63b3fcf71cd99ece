"""Fast SPH water on any GPU: simulation, surface reconstruction and parameter studies.

Lengths are in m, times in s, masses in kg; y is up. Arrays that the package returns are read-only
views of host memory without a copy. They stay valid and unchanged as long as you hold them, whatever
happens to the simulation; copy one to change it.

>>> import splashdown
>>> scene = splashdown.Scene.preset("dam-break-small")
>>> with splashdown.Simulation(scene, device="cpu") as simulation:
...     stats = simulation.advance(0.01)  # s
...     positions = simulation.positions  # (N, 3) float32, m
>>> positions.shape == (stats.particles, 3)
True
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
