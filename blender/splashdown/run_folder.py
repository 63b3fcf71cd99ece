"""The frames in the output folder of a run. Needs no Blender."""

import json
import re
from dataclasses import dataclass, field
from pathlib import Path

from . import ply

# Kinds of data and where `splashdown run` writes them.
KINDS = {
    "surface": ("mesh", "surface"),
    "droplets": ("droplets", "droplets"),
    "spray": ("particles", "spray"),
    "foam": ("particles", "foam"),
    "bubbles": ("particles", "bubbles"),
}


@dataclass
class RunFolder:
    """Usable files by kind and frame, and what is wrong with the others."""

    path: Path
    files: dict = field(default_factory=dict)
    problems: list = field(default_factory=list)
    # Distance of the particles in m, if run.json has it.
    spacing: float | None = None

    @property
    def frames(self):
        """The numbers of the frames that have a usable file."""
        return sorted({frame for files in self.files.values() for frame in files})

    def report(self):
        """One line on the frames and one for each problem."""
        frames = self.frames
        if not frames:
            return "\n".join([f"{self.path} has no frames that can be loaded.", *self.problems])
        return "\n".join([f"Frames {frames[0]} to {frames[-1]}, {len(frames)} usable.", *self.problems])


def path_of(folder, kind, frame):
    """The file of a frame, which need not exist."""
    directory, stem = KINDS[kind]
    return Path(folder) / directory / f"{stem}_{frame:04}.ply"


def listed(numbers, limit=8):
    """Numbers in words, with the first few of many."""
    numbers = sorted(numbers)
    text = ", ".join(str(number) for number in numbers[:limit])
    return text if len(numbers) <= limit else f"{text} and {len(numbers) - limit} more"


def scan(path):
    """The usable frames of a folder. Truncated, missing and foreign files are problems, not errors."""
    run = RunFolder(Path(path))
    if not run.path.is_dir():
        run.problems.append(f"{run.path} is not a folder.")
        return run
    others = {}
    for kind, (directory, stem) in KINDS.items():
        usable, truncated = {}, []
        pattern = re.compile(rf"{stem}_(\d+)\.(\w+)")
        folder = run.path / directory
        for file in sorted(folder.iterdir()) if folder.is_dir() else []:
            match = pattern.fullmatch(file.name)
            if not match:
                continue
            number, extension = int(match[1]), match[2]
            if extension != "ply":
                others.setdefault((kind, extension), set()).add(number)
            elif ply.is_complete(file):
                usable[number] = file
            else:
                truncated.append(number)
        run.files[kind] = usable
        if truncated:
            run.problems.append(f"Truncated or invalid {kind} files, not used: frames {listed(truncated)}.")
        if usable:
            missing = set(range(min(usable), max(usable) + 1)) - set(usable) - set(truncated)
            if missing:
                run.problems.append(f"Missing {kind} files: frames {listed(missing)}.")
    for (kind, extension), numbers in others.items():
        without = numbers - set(run.files[kind])
        if without:
            run.problems.append(
                f"{kind} files in another format (.{extension}), not used: frames {listed(without)}. "
                "Run with --formats ply."
            )
    try:
        spacing = json.loads((run.path / "run.json").read_text(encoding="utf-8")).get("particle_spacing")
        run.spacing = float(spacing) if spacing else None
    except (OSError, ValueError, TypeError, AttributeError):
        pass
    return run
