"""Progress of simulations and runs: a function, or a bar of `tqdm` if it is installed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from splashdown._splashdown import Progress


class _Bar:
    """A bar of `tqdm` over the simulated time."""

    def __init__(self, tqdm: Any) -> None:
        self._tqdm = tqdm
        self._bar: Any = None
        self._start = 0.0

    def __call__(self, progress: Progress) -> None:
        if self._bar is None:
            self._start = progress.time
            layout = "{l_bar}{bar}| {n:.3f}/{total:.3f} s [{elapsed}<{remaining}]"
            self._bar = self._tqdm(total=progress.duration, initial=progress.time, bar_format=layout)
        self._bar.n = min(progress.time, self._bar.total)
        self._bar.refresh()

    def close(self) -> None:
        if self._bar is not None:
            self._bar.n = self._bar.total
            self._bar.close()
            self._bar = None


def function(given: object) -> Callable[[Progress], object] | None:
    """The function that receives the progress, for the argument `progress`."""
    if given is None or given is False:
        return None
    if given is True:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            return None
        return _Bar(tqdm)
    if callable(given):
        return given
    raise TypeError(f"progress is {given!r}; it must be a function, True (a bar of tqdm) or None")
