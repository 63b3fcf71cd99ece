"""Parameter studies: many variants of a scene, on one machine or on a cluster."""

from __future__ import annotations

import functools
import glob
import hashlib
import importlib
import itertools
import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Union

from splashdown import _worker
from splashdown._engines import Engine, Lost, Task
from splashdown._errors import MissingPackageError, ParameterError
from splashdown._splashdown import (
    Frame,
    Painter,
    Scene,
    __version__,
    read_particles,
    surface,
    write_mesh,
)

if TYPE_CHECKING:
    import pandas

Change = Mapping[str, Any]
Value = Union[bool, int, float, str, None]
PathLike = Union[str, "os.PathLike[str]"]


def grid(values: Mapping[str, Iterable[Any]]) -> list[dict[str, Any]]:
    """All combinations of the values of several keys, the last key varying fastest.

    >>> import splashdown
    >>> splashdown.grid({"fluid.viscosity": [0.001, 0.01], "scene.duration": [1, 2]})[1]
    {'fluid.viscosity': 0.001, 'scene.duration': 2}
    """
    combinations = itertools.product(*(list(column) for column in values.values()))
    return [dict(zip(values, combination)) for combination in combinations]


def sweep(
    scene: Scene,
    changes: Mapping[str, Iterable[Any]] | Sequence[Change],
    keep: Callable[[Frame], Mapping[str, Any]] | None = None,
    *,
    folder: PathLike,
    engine: str = "processes",
    workers: int | None = None,
    threads: int | None = None,
    device: str = "auto",
    frames: int | None = None,
    surface: bool | None = False,
    foam: bool | None = False,
    checkpoint_every: int = 10,
    retries: int = 2,
    ray_options: Mapping[str, Any] | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> pandas.DataFrame:
    """Runs variants of a scene and returns a table with one row per run, in the order of the variants.

    `changes` is a grid (a dictionary from the path of a key to its values, see `grid`) or a list of dictionaries, each
    for one run (see `Scene.replace`). `keep` is called with every frame and returns numbers and texts. Those of the last
    frame are in the table; those of all frames are in `frames.csv` in the folder of the run.

    The columns are those of `changes`, then `status` ("finished" or "failed"), `reason` (of a failure), those of `keep`
    with `frame` and `time` (s), `warnings` (texts), `wall` (s), `worker`, `resumed_from` (the frame from which a lost run
    continued, 0 if it was not lost) and `folder`.

    All workers must see `folder` under this path. A run writes a checkpoint there every `checkpoint_every` frames (0:
    none) and deletes it at its end. If its worker is lost, it continues from the checkpoint on another one, up to
    `retries` times, with the same bits on a device of the same kind. Runs that the folder already contains are not
    computed again, so a study that was interrupted continues when it is started again.

    With `engine="processes"` there are `workers` processes with `threads` each. With `engine="ray"` each run takes
    `threads` cores (1 by default) and `ray_options`, for example `{"num_gpus": 1}`; call `ray.init` before to use a
    cluster. `progress` is called with the number of runs that have ended and the number of all.
    A script that is not a notebook must call `sweep` below `if __name__ == "__main__":`, because new processes read it.

    >>> changes = {"fluid.viscosity": [0.001, 0.1]}  # m^2/s
    >>> table = splashdown.sweep(scene, changes, folder=folder / "study", frames=1, workers=1, device="cpu")
    >>> list(table["status"])
    ['finished', 'finished']
    """
    settings = Engine(engine, workers, threads, retries, dict(ray_options or {}))
    settings.check()
    _optional("pandas")
    if checkpoint_every < 0:
        raise ParameterError(f"checkpoint_every is {checkpoint_every}; it must be 0 or more")
    variants = grid(changes) if isinstance(changes, Mapping) else [dict(change) for change in changes]
    function = _worker.frames_of if keep is None else keep
    portable = _portable(function, "keep", engine)
    root = Path(os.path.abspath(folder))
    options = {"device": device, "frames": frames, "surface": surface, "foam": foam}
    tasks: list[Task] = []
    outcomes: dict[int, dict[str, Any]] = {}
    for index, change in enumerate(variants):
        where = root / f"run_{index:04}"
        try:
            changed = scene.replace(change)
        except ValueError as error:
            outcomes[index] = {"status": "failed", "reason": str(error)}
            continue
        source = None if changed.path is None else os.path.abspath(changed.path)
        task: Task = {"index": index, "text": changed.text, "name": changed.name, "source": source, **options}
        task["key"] = _key(task, function)
        known = _known(where, task["key"])
        if known is not None:
            outcomes[index] = known
            continue
        task.update(
            version=__version__, folder=str(where), keep=portable, checkpoint_every=checkpoint_every
        )
        tasks.append(task)
    if progress is not None:
        progress(len(outcomes), len(variants))
    for place, outcome in settings.run(_worker.compute_run, tasks):
        task = tasks[place]
        if isinstance(outcome, Lost):
            outcome = {"status": "failed", "reason": outcome.reason}
        outcomes[task["index"]] = outcome
        _remember(Path(task["folder"]), task["key"], outcome)
        if progress is not None:
            progress(len(outcomes), len(variants))
    rows: list[dict[str, Any]] = []
    for index, change in enumerate(variants):
        rows.append({**change, **_columns(outcomes[index]), "folder": str(root / f"run_{index:04}")})
    return _table(rows)


def map_frames(
    files: PathLike | Sequence[PathLike],
    function: Callable[[Path], Mapping[str, Any]],
    *,
    engine: str = "processes",
    workers: int | None = None,
    threads: int | None = None,
    retries: int = 2,
    ray_options: Mapping[str, Any] | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> pandas.DataFrame:
    """Calls a function for the files of a finished run, distributed as in `sweep`, and returns a table with one row per
    file. `files` is a pattern such as `"out/dam-break/particles/*.npz"` or a list; `function` receives a path and
    returns numbers and texts, which are columns of the table. `ReconstructSurface` and `DrawPicture` are such functions.

    >>> import numpy, splashdown, tempfile
    >>> from pathlib import Path
    >>> points = numpy.random.default_rng(1).random((500, 3), dtype=numpy.float32)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder) / "particles_0001.npz"
    ...     size = splashdown.write_particles(path, splashdown.Particles(points))
    ...     job = splashdown.ReconstructSurface(folder, particle_spacing=0.1)
    ...     table = splashdown.map_frames([path], job, workers=1)
    ...     Path(table["mesh"][0]).name
    'particles_0001.ply'
    """
    settings = Engine(engine, workers, threads, retries, dict(ray_options or {}))
    settings.check()
    _optional("pandas")
    portable = _portable(function, "function", engine)
    if isinstance(files, (str, os.PathLike)):
        paths = sorted(glob.glob(os.fspath(files)))
        if not paths:
            raise ParameterError(f"no file matches {os.fspath(files)!r}: give the pattern of the files of a run")
    else:
        paths = [os.fspath(path) for path in files]
    tasks: list[Task] = [
        {"version": __version__, "file": os.path.abspath(path), "function": portable} for path in paths
    ]
    outcomes: dict[int, dict[str, Any]] = {}
    for place, outcome in settings.run(_worker.apply_to_file, tasks):
        outcomes[place] = {"status": "failed", "reason": outcome.reason} if isinstance(outcome, Lost) else outcome
        if progress is not None:
            progress(len(outcomes), len(tasks))
    return _table([{"file": task["file"], **_columns(outcomes[place])} for place, task in enumerate(tasks)])


class ReconstructSurface(NamedTuple):
    """Reconstructs the surface of a file of particles and writes the mesh into a folder: a function for `map_frames`.

    `particle_spacing` and `cell_size` are in m. Files of runs contain their spacing, which is used if none is given.
    `format` is the ending of the meshes. `kernels` is "isotropic" or "anisotropic" as in `surface`.

    >>> import splashdown
    >>> job = splashdown.ReconstructSurface(
    ...     folder="meshes",
    ...     particle_spacing=0.02,
    ...     cell_size=0.01,
    ...     smoothing=15,
    ...     format="obj",
    ...     kernels="anisotropic",
    ...     device="cpu",
    ... )
    >>> job.smoothing
    15
    """

    folder: PathLike
    particle_spacing: float | None = None
    cell_size: float | None = None
    smoothing: int = 0
    format: str = "ply"
    device: str = "auto"
    kernels: Literal["isotropic", "anisotropic"] = "isotropic"

    def __call__(self, path: Path) -> dict[str, Any]:
        """Reconstructs one file; returns the file of the mesh and its numbers of vertices and triangles."""
        particles = read_particles(path)
        spacing = particles.particle_spacing if self.particle_spacing is None else self.particle_spacing
        if spacing is None:
            raise ParameterError(f"{path.name!r} does not contain its particle spacing: give particle_spacing")
        mesh = surface(
            particles.positions,
            spacing,
            cell_size=self.cell_size,
            smoothing=self.smoothing,
            kernels=self.kernels,
            device=self.device,
        )
        Path(self.folder).mkdir(parents=True, exist_ok=True)
        target = Path(self.folder) / f"{path.stem}.{self.format}"
        write_mesh(target, mesh)
        return {"mesh": str(target), "vertices": len(mesh.vertices), "triangles": len(mesh.triangles)}


class DrawPicture(NamedTuple):
    """Draws a file of a finished run as PNG into a folder, as the run draws it: a function for `map_frames`.

    `kind` is "surface" for files of meshes and "particles" for those of particles. The number at the end of the file name
    is the frame. Bodies and foam of the frame are read from the output folder of the file; if one is missing, the row of
    the table has the reason. Surfaces are shaded with the normals of their triangles, because readers drop normals.

    >>> import splashdown
    >>> job = splashdown.DrawPicture(
    ...     folder="pictures", scene=splashdown.Scene.preset("dam-break-small"), kind="particles"
    ... )
    >>> job.scene.name
    'dam-break-small'
    """

    folder: PathLike
    scene: Scene
    kind: Literal["particles", "surface"] = "surface"

    def __call__(self, path: Path) -> dict[str, Any]:
        """Draws one file; returns the file of the picture."""
        Path(self.folder).mkdir(parents=True, exist_ok=True)
        target = Path(self.folder) / f"{path.stem}.png"
        _painter(self.scene, self.kind).write(target, path)
        return {"picture": str(target)}


@functools.lru_cache(maxsize=1)
def _painter(scene: Scene, kind: Literal["particles", "surface"]) -> Painter:
    """Opening a device takes longer than drawing a picture."""
    return Painter(scene, kind)


def _key(task: Task, function: Callable[..., Any]) -> str:
    """What determines the result of a run."""
    name = f"{getattr(function, '__module__', '')}.{getattr(function, '__qualname__', repr(function))}"
    code = getattr(function, "__code__", None)
    parts = [__version__, name, code.co_code.hex() if code else ""]
    parts += [str(task[name]) for name in ("text", "source", "device", "frames", "surface", "foam")]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()


def _known(folder: Path, key: str) -> dict[str, Any] | None:
    """The outcome of a run that an earlier call has finished."""
    try:
        saved: Any = json.loads((folder / "result.json").read_text())
        is_same = saved["key"] == key and saved["status"] == "finished"
    # Also if the file contains something else.
    except (OSError, ValueError, LookupError, TypeError):
        return None
    return saved if is_same else None


def _remember(folder: Path, key: str, outcome: dict[str, Any]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    temporary = folder / "result.tmp"
    temporary.write_text(json.dumps({"key": key, **outcome}, indent=1))
    temporary.replace(folder / "result.json")


def _columns(outcome: dict[str, Any]) -> dict[str, Any]:
    kept = outcome.get("kept", {})
    shown = {"status": outcome["status"], "reason": outcome["reason"], **kept}
    for name in ("warnings", "wall", "worker", "resumed_from"):
        if name in outcome:
            shown[name] = outcome[name]
    return shown


def _table(rows: list[dict[str, Any]]) -> pandas.DataFrame:
    return _optional("pandas").DataFrame(rows)


def _optional(name: str) -> Any:
    """A package of the extra `sweep`."""
    try:
        return importlib.import_module(name)
    except ImportError:
        message = f"parameter studies need the package {name}: pip install 'splashdown[sweep]'"
        raise MissingPackageError(message) from None


def _portable(function: object, name: str, engine: str) -> object:
    """The function in a form that another process can read. Ray converts functions itself."""
    cloudpickle = _optional("cloudpickle")
    if engine == "ray":
        return function
    try:
        # Functions of notebooks and lambdas are sent with their code, others by name.
        return cloudpickle.dumps(function)
    except Exception as error:
        raise ParameterError(
            f"{name} cannot be sent to another process ({error}): let it use numbers, texts and modules, and no open files, "
            "devices or simulations"
        ) from None
