"""Where the tasks of a study run: processes of this machine, or a Ray cluster.

An engine calls one function for each task and yields the outcomes in the order in which they end. It starts a task again
if its worker is lost. Scheduling, placement and back-pressure are left to `concurrent.futures` and to Ray.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from splashdown._errors import MissingPackageError, ParameterError

if TYPE_CHECKING:
    from concurrent.futures import Future

Task = dict[str, Any]
Function = Callable[[Task], dict[str, Any]]


class Lost(NamedTuple):
    """The worker of a task was lost more often than it may be."""

    reason: str


Outcome = tuple[int, "dict[str, Any] | Lost"]


class Engine(NamedTuple):
    """The name of an engine and its settings."""

    name: str
    workers: int | None
    threads: int | None
    retries: int
    ray_options: Mapping[str, Any]

    def check(self) -> None:
        """Raises the exceptions of wrong settings, before anything is computed."""
        if self.name not in ("processes", "ray"):
            raise ParameterError(f'engine is {self.name!r}; it must be "processes" or "ray"')
        for name, value in (("workers", self.workers), ("threads", self.threads)):
            if value is not None and value < 1:
                raise ParameterError(f"{name} is {value}; it must be at least 1")
        if self.retries < 0:
            raise ParameterError(f"retries is {self.retries}; it must be 0 or more")
        if self.name == "ray":
            _import_ray()
            if self.workers is not None:
                raise ParameterError(
                    "workers is an option of engine=\"processes\"; Ray starts as many runs as the cluster has "
                    "resources for: set threads, or ray_options such as {'num_gpus': 1}"
                )
        elif self.ray_options:
            raise ParameterError('ray_options is an option of engine="ray"')

    def run(self, function: Function, tasks: Sequence[Task]) -> Iterator[Outcome]:
        """Calls the function for all tasks."""
        if self.name == "ray":
            return _with_ray(function, tasks, self)
        return _with_processes(function, tasks, self)


def _with_processes(function: Function, tasks: Sequence[Task], engine: Engine) -> Iterator[Outcome]:
    # Imported here, because these modules take a third of the time of `import splashdown`.
    import multiprocessing
    from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
    from concurrent.futures.process import BrokenProcessPool

    cores = os.cpu_count() or 1
    workers = min(engine.workers or max(1, cores // (engine.threads or 1)), max(1, len(tasks)))
    threads = engine.threads or max(1, cores // workers)
    losses = [0] * len(tasks)
    left = list(range(len(tasks)))
    while left:
        # A fork would copy the threads and devices of this process.
        context = multiprocessing.get_context("spawn")
        pool = ProcessPoolExecutor(workers, mp_context=context, initializer=_limit_threads, initargs=(threads,))
        futures: dict[Future[dict[str, Any]], int] = {}
        try:
            waiting = list(left)
            # No more than one task per worker, so that a broken pool does not count against tasks that only waited.
            while waiting or futures:
                while waiting and len(futures) < workers:
                    index = waiting.pop(0)
                    futures[pool.submit(function, tasks[index])] = index
                done, _ = wait(futures, return_when=FIRST_COMPLETED)
                for future in done:
                    outcome = future.result()
                    index = futures.pop(future)
                    left.remove(index)
                    yield index, outcome
        except BrokenProcessPool as error:
            # The pool does not tell which of its processes has died: all tasks that were running start again.
            for index in futures.values():
                losses[index] += 1
                if losses[index] > engine.retries:
                    left.remove(index)
                    yield index, Lost(f"its process was lost {losses[index]} times: {error}")
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _limit_threads(threads: int) -> None:
    """Called in a new worker, before its first computation reads the variable."""
    os.environ["RAYON_NUM_THREADS"] = str(threads)


def _import_ray() -> Any:
    try:
        import ray
    except ImportError:
        message = "engine=\"ray\" needs the package ray: pip install 'splashdown[ray]'"
        raise MissingPackageError(message) from None
    return ray


def _with_ray(function: Function, tasks: Sequence[Task], engine: Engine) -> Iterator[Outcome]:
    ray = _import_ray()
    if not ray.is_initialized():
        ray.init()
    threads = engine.threads or 1
    options = {"num_cpus": threads, "max_retries": engine.retries, **engine.ray_options}
    remote = ray.remote(**options)(function)
    pending = {remote.remote({**task, "threads": threads}): index for index, task in enumerate(tasks)}
    while pending:
        done, _ = ray.wait(list(pending), num_returns=1)
        for reference in done:
            index = pending.pop(reference)
            try:
                yield index, ray.get(reference)
            except ray.exceptions.RayError as error:
                yield index, Lost(_first_lines(error))


def _first_lines(error: BaseException) -> str:
    """The type of an error and the essential part of its text."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    # Ray puts the traceback of the worker first and the exception last.
    text = lines[-1] if lines else ""
    return f"{type(error).__name__}: {text}"
