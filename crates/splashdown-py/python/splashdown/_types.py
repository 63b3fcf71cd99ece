"""Types of results."""

from __future__ import annotations

import os
from typing import TypedDict


class RunFiles(TypedDict, total=False):
    """What `splashdown.run` returns: a dictionary. The values from `steps` on are absent if the run was stopped.

    >>> result: splashdown.RunFiles = splashdown.run(scene, folder / "out", frames=1, pictures=[], device="cpu")
    >>> result["frames"], result["density_error"] < 0.1
    (2, True)
    """

    #: The output folder.
    folder: os.PathLike[str]
    #: The number of complete frames, including the initial one.
    frames: int
    #: All files of the run.
    files: list[os.PathLike[str]]
    #: Steps of this run.
    steps: int
    #: Wall time in s.
    wall: float
    #: The largest density error of all frames, relative to the rest density: the larger of the two below.
    density_error: float
    #: The largest excess of the density.
    density_excess: float
    #: The largest deficit of the density.
    density_deficit: float
