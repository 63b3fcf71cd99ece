"""The exceptions of the package. Each is an `Error`, and also the built-in exception that fits best."""

from __future__ import annotations


class Error(Exception):
    """The base class of all exceptions of this package.

    >>> import splashdown
    >>> try:
    ...     splashdown.Scene.load("missing.toml")
    ... except splashdown.Error as error:
    ...     print(type(error).__name__)
    SceneError
    """


class SceneError(Error, ValueError):
    """A scene is invalid, or a file that it names is missing. The text lists all problems at once.

    >>> import splashdown
    >>> try:
    ...     splashdown.Scene.preset("dam-break").replace({"fluid.particle_spacing": -1})
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
    """An array has the wrong shape, type, order or values. The text says how to convert it."""


class ParameterError(Error, ValueError):
    """A number or word is outside the allowed range."""


class SimulationError(Error, RuntimeError):
    """The simulation failed, for example because it became unstable."""


class DeviceError(Error, RuntimeError):
    """The device is missing, too small, or was lost."""


class FileError(Error, OSError):
    """A file or folder cannot be read or written."""


class CheckpointError(Error, ValueError):
    """A checkpoint is damaged, of another version, or does not fit the files of its scene."""


class ClosedError(Error, ValueError):
    """A simulation or a run is used after `close`."""


class VersionError(Error, RuntimeError):
    """A worker of a parameter study has another version of the program."""


class MissingPackageError(Error, ImportError):
    """An optional Python package is needed and missing. The text says how to install it."""


class SimulationWarning(UserWarning):
    """A problem that does not stop a simulation."""
