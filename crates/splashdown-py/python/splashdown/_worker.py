"""What a worker of a study does: one run, from its start or from its last checkpoint.

A task and an outcome are dictionaries of plain values, so that workers with another version of the program can read them
and report that.
"""

from __future__ import annotations

import csv
import json
import os
import pickle
import platform
import time
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeGuard

from splashdown._errors import CheckpointError, Error, ParameterError, SceneError, SimulationWarning, VersionError
from splashdown._splashdown import Checkpoint, Frame, Run, Scene, __version__

Row = dict[str, Any]


def compute_run(task: dict[str, Any]) -> dict[str, Any]:
    """Computes a run and returns its outcome. Errors of the run are outcomes as well."""
    begun = time.perf_counter()
    outcome: dict[str, Any] = {"worker": f"{platform.node()}:{os.getpid()}"}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", SimulationWarning)
        try:
            _prepare(task)
            outcome.update(_compute(task))
            outcome.update(status="finished", reason="")
        # Whatever one run raises, in the program or in the user's function, the study continues.
        except Exception as error:
            outcome.update(status="failed", reason=_reason(task, error))
    ours = [warning for warning in caught if issubclass(warning.category, SimulationWarning)]
    for warning in caught:
        if warning not in ours:
            warnings.warn_explicit(warning.message, warning.category, warning.filename, warning.lineno)
    outcome["warnings"] = "\n".join(dict.fromkeys(str(warning.message) for warning in ours))
    outcome["wall"] = time.perf_counter() - begun
    return outcome


def apply_to_file(task: dict[str, Any]) -> dict[str, Any]:
    """Calls a function for one file of a finished run."""
    begun = time.perf_counter()
    outcome: dict[str, Any] = {"worker": f"{platform.node()}:{os.getpid()}"}
    try:
        _prepare(task)
        outcome["kept"] = plain(_function(task["function"])(Path(task["file"])))
        outcome.update(status="finished", reason="")
    except Exception as error:
        outcome.update(status="failed", reason=_reason(task, error))
    outcome["wall"] = time.perf_counter() - begun
    return outcome


def _prepare(task: dict[str, Any]) -> None:
    if task["version"] != __version__:
        raise VersionError(
            f"this worker has Splashdown {__version__} and the study was started with {task['version']}: install the "
            "same version on all machines"
        )
    threads = task.get("threads")
    if threads is not None:
        # Read when the first computation of this process starts.
        os.environ.setdefault("RAYON_NUM_THREADS", str(threads))


def _function(given: Any) -> Any:
    """A function of the user, which processes receive as bytes."""
    return pickle.loads(given) if isinstance(given, bytes) else given


def _compute(task: dict[str, Any]) -> dict[str, Any]:
    folder = Path(task["folder"])
    folder.mkdir(parents=True, exist_ok=True)
    options = {"device": task["device"], "frames": task["frames"], "surface": task["surface"], "foam": task["foam"]}
    saved = folder / "checkpoint.splashdown"
    keep = _function(task["keep"])
    rows: list[Row] = []
    run: Run | None = None
    if saved.exists():
        run, rows = _resume(saved, task["key"], options)
    if run is None:
        source = task["source"]
        scene = Scene._restore(task["text"], task["name"], None if source is None else Path(source))
        run, rows = Run(scene, **options), []
    resumed = run.first_frame if rows else 0
    every = task["checkpoint_every"]
    for frame in run:
        rows.append({"frame": frame.index, "time": frame.time, **plain(keep(frame))})
        if every and frame.index % every == 0 and 0 < frame.index < run.frames:
            checkpoint = run.checkpoint()
            checkpoint.notes = json.dumps({"key": task["key"], "rows": rows})
            checkpoint.write(saved)
    write_rows(folder / "frames.csv", rows)
    saved.unlink(missing_ok=True)
    return {"kept": rows[-1], "resumed_from": resumed}


def _resume(path: Path, key: str, options: dict[str, Any]) -> tuple[Run | None, list[Row]]:
    """The run that a lost worker has begun. A checkpoint that cannot be used, or that belongs to another run, is ignored:
    the run then starts again."""
    try:
        checkpoint = Checkpoint.read(path)
        notes = json.loads(checkpoint.notes or "{}")
        if notes.get("key") != key:
            return None, []
        return Run.resume(checkpoint, **options), notes["rows"]
    except (CheckpointError, ValueError, KeyError):
        return None, []


def plain(kept: object) -> Row:
    """The values that the function of the user has returned, as plain numbers and texts."""
    if not _is_mapping(kept):
        raise ParameterError(f"the function returned {kept!r}; it must return a dictionary of numbers and texts")
    row: Row = {}
    for name, value in kept.items():
        value = value.item() if hasattr(value, "item") else value
        if not isinstance(value, (bool, int, float, str, type(None))):
            raise ParameterError(
                f"the function returned a {type(value).__name__} as {name!r}; it must be a number or a text (write arrays "
                "into files of your own)"
            )
        row[str(name)] = value
    return row


def _is_mapping(value: object) -> TypeGuard[Mapping[Any, Any]]:
    return isinstance(value, Mapping)


def write_rows(path: Path, rows: list[Row]) -> None:
    """Writes a table as CSV; the file is complete or absent."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    temporary = path.with_suffix(".tmp")
    with temporary.open("w", newline="") as file:
        table = csv.DictWriter(file, names)
        table.writeheader()
        table.writerows(rows)
    temporary.replace(path)


def _reason(task: dict[str, Any], error: Exception) -> str:
    text = str(error) if isinstance(error, Error) else f"{type(error).__name__}: {error}"
    if isinstance(error, SceneError) and task.get("source") is not None:
        text += (
            f"\nThe scene was valid where the study was started. Make its files available to {platform.node()} under the "
            f"same paths, for example in a shared folder (the scene is {task['source']})."
        )
    return text


def frames_of(frame: Frame) -> Row:
    """What a study keeps by default: the statistics that show whether a run is sound."""
    stats = frame.stats
    return {
        "particles": stats.particles,
        "steps": stats.steps,
        "max_speed": stats.max_speed,
        "density_error": stats.density_error,
    }
