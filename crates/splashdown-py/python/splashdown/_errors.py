"""The exceptions of the package. Each is an `Error`, and also the built-in exception that fits best."""

from __future__ import annotations


class Error(Exception):
    """The base class of all exceptions of this package.

    >>> try:
    ...     splashdown.Scene.load("missing.toml")
    ... except splashdown.Error as error:
    ...     print(type(error).__name__)
    SceneError
    """


class SceneError(Error, ValueError):
    """A scene is invalid, or a file that it names is missing. The text lists all problems at once.

    >>> try:
    ...     scene.replace({"fluid.particle_spacing": -1})
    ... except splashdown.SceneError as error:
    ...     print(error.problems[0])
    fluid.particle_spacing is -1, which is out of range
    """

    def __init__(self, message: str, problems: list[str] | None = None) -> None:
        super().__init__(message, problems if problems is not None else [message])
        #: One text per problem.
        self.problems: list[str] = self.args[1]

    def __str__(self) -> str:
        return str(self.args[0])


class ArrayError(Error, ValueError):
    """An array has the wrong shape, type, order or values. The text says how to convert it.

    >>> try:
    ...     splashdown.Particles(numpy.zeros((3, 100), numpy.float32))
    ... except splashdown.ArrayError as error:
    ...     print(error)
    positions has shape (3, 100); (N, 3) is needed: use numpy.ascontiguousarray(positions.T)
    """


class ParameterError(Error, ValueError):
    """A number or word is outside the allowed range.

    >>> try:
    ...     splashdown.Simulation(scene, device="")
    ... except splashdown.ParameterError as error:
    ...     print(str(error)[:15])
    device is empty
    """


class SimulationError(Error, RuntimeError):
    """The simulation failed, for example because it became unstable.

    >>> issubclass(splashdown.SimulationError, (splashdown.Error, RuntimeError))
    True
    """


class DeviceError(Error, RuntimeError):
    """The device is missing, too small, or was lost.

    >>> try:
    ...     splashdown.Simulation(scene, device="no such adapter")
    ... except splashdown.DeviceError as error:
    ...     print("no such adapter" in str(error))
    True
    """


class FileError(Error, OSError):
    """A file or folder cannot be read or written.

    >>> try:
    ...     splashdown.read_mesh("missing.ply")
    ... except splashdown.FileError as error:
    ...     print("missing.ply" in str(error))
    True
    """


class CheckpointError(Error, ValueError):
    """A checkpoint is damaged, of another version, or does not fit the files of its scene.

    >>> try:
    ...     splashdown.Checkpoint.from_bytes(b"text")
    ... except splashdown.CheckpointError as error:
    ...     print(type(error).__name__)
    CheckpointError
    """


class ClosedError(Error, ValueError):
    """A simulation or a run is used after `close`.

    >>> simulation.close()
    >>> try:
    ...     simulation.advance(0.01)  # s
    ... except splashdown.ClosedError as error:
    ...     print(error)
    this simulation is closed: create another one
    """


class VersionError(Error, RuntimeError):
    """A worker of a parameter study has another version of the program.

    It is the `reason` of a run in the table of a study, and not raised there.
    
    >>> issubclass(splashdown.VersionError, splashdown.Error)
    True
    """


class MissingPackageError(Error, ImportError):
    """An optional Python package is needed and missing. The text says how to install it.

    >>> import sys, unittest.mock
    >>> with unittest.mock.patch.dict(sys.modules, {"pandas": None}):
    ...     try:
    ...         splashdown.map_frames([], str)
    ...     except splashdown.MissingPackageError as error:
    ...         print(error)
    parameter studies need the package pandas: pip install 'splashdown[sweep]'
    """


class SimulationWarning(UserWarning):
    """A problem that does not stop a simulation.

    >>> import warnings
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("error", splashdown.SimulationWarning)  # stop at the first one
    ...     simulation = splashdown.Simulation(scene, device="cpu")
    """
