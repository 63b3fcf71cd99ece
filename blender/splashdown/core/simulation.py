"""The check and the run of a scene by the program, as a state machine that needs no Blender.

`CHECKING`, then `RUNNING`; `STOPPING` after a cancel. It ends as `CHECKED`, `FINISHED`, `STOPPED` or `FAILED`.
"""

import re
import signal
import tempfile
import traceback
from pathlib import Path

from .job import Job
from .lock import is_locked
from .run_folder import RunFolder, newest_checkpoint
from .scene import HEADER

# Warnings that are shown.
MOST_WARNINGS = 8
# How long a killed program may take to disappear, in seconds.
KILL_LIMIT = 5


class Failed(Exception):
    """A simulation that cannot start or has failed. The text is for the user."""


class Simulation:
    """One check, run or resumed run. A front end overrides `on_started`, `on_frame` and `on_end`, and calls `update`."""

    # What starts the program; tests replace it.
    job_type = Job

    def __init__(self, program, folder, *, device, checkpoint_every, limit, spacing, frame_rate, names=None):
        """`folder`: of the scene file and the run, a path; `None` for a check only. `limit`: of the number of particles.
        `spacing`: m. `frame_rate`: frames per simulated second. `names`: the user's names of parts of the scene, by the
        names that the program prints."""
        self.program, self.folder = program, folder
        self.run = None if folder is None else folder / "run"
        self.device, self.checkpoint_every = device, checkpoint_every
        self.limit, self.spacing, self.frame_rate = limit, spacing, frame_rate
        self.names = names or {}
        self.errors, self.warnings, self.estimate = [], [], ""
        self.frame, self.frames, self.fraction = None, None, 0.0
        self.job, self.state = None, "FAILED"
        self._is_checked, self._is_started, self._phase = False, False, "check"
        self._files, self._temporary = {}, None

    def on_started(self):
        """The run has started: `frames` is known."""

    def on_frame(self):
        """A frame has been written."""

    def on_end(self):
        """A run that had started has ended, successfully or not."""

    def check(self, files):
        """Checks the scene in a temporary folder, and then runs it in `folder` if there is one. `files`: contents by
        paths. Raises [`Failed`]."""
        if self.folder is not None:
            self._refuse_taken_folder()
        self._files = files
        # A check must not change the scene of the run that the cache folder contains.
        self._temporary = tempfile.TemporaryDirectory(prefix="splashdown-check-", ignore_cleanup_errors=True)
        try:
            _write(Path(self._temporary.name), files)
            self._start("CHECKING", ["check", "scene.toml", "--json", "--device", self.device], self._temporary.name)
        except Failed:
            self._clean()
            raise

    def resume(self):
        """Continues the run in `folder`. Raises [`Failed`]."""
        refuse_resume(self.run)
        self._start("RUNNING", ["run", "--resume", "run", *self._output()], self.folder)

    def refuse_too_many(self, particles):
        """Raises [`Failed`] if a number of particles is above the limit."""
        if particles > self.limit:
            raise Failed(
                f"About {particles:,} particles at a spacing of {self.spacing:g} m are more than the "
                f"limit of {int(self.limit):,}. Increase the spacing, or the limit if the device has the memory."
            )

    def _refuse_taken_folder(self):
        if is_locked(self.run):
            raise Failed(f"Another simulation writes into {self.run}. Wait for its end, or choose another cache folder.")
        path = self.folder / "scene.toml"
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise _unwritable(self.folder, error) from error
        try:
            with open(path, encoding="utf-8", errors="replace") as file:
                is_ours = file.readline().startswith(HEADER)
        except FileNotFoundError:
            return
        except OSError as error:
            raise Failed(f"{path} cannot be read: {error.strerror}. Choose another cache folder.") from error
        if not is_ours:
            raise Failed(f"{path} was not written by this extension and is not overwritten. Choose another cache folder.")

    def _output(self):
        every = str(self.checkpoint_every)
        return ["--json", "--formats", "ply", "--no-pictures", "--no-film", "--checkpoint-every", every]

    def _run(self):
        self._refuse_taken_folder()
        _write(self.folder, self._files)
        self._files = {}
        # Frames of the earlier bake are removed by the program.
        arguments = ["run", "scene.toml", "--out", "run", "--device", self.device, *self._output()]
        self._start("RUNNING", arguments, self.folder)

    def _start(self, state, arguments, folder):
        try:
            self.job = self.job_type([self.program, *arguments], folder)
        except OSError as error:
            raise Failed(f"`{self.program}` cannot be started: {error}") from error
        self.state, self._phase = state, "check" if state == "CHECKING" else "run"

    @property
    def is_active(self):
        return self.state in ("CHECKING", "RUNNING", "STOPPING")

    @property
    def messages(self):
        """Errors, then warnings."""
        return self.errors + self.warnings

    def warn(self, text):
        """Adds a warning unless it is known."""
        if text not in self.warnings and len(self.warnings) < MOST_WARNINGS:
            self.warnings.append(text)

    def update(self):
        """Handles what the program has printed. Returns whether the simulation goes on. Raises nothing: a timer that
        raises is removed, and nobody would watch the program any more."""
        if not self.is_active:
            return False
        try:
            events, code = self.job.poll()
            for event in events:
                if self.is_active:
                    self._handle(event)
            if code is not None:
                self._ended(code)
        except Failed as error:
            self.fail(str(error))
        except Exception as error:
            traceback.print_exc()
            self.fail(f"{type(error).__name__}: {error}")
        if not self.is_active:
            self._clean()
        return self.is_active

    def _handle(self, event):
        kind = event["event"]
        if kind == "check":
            self._checked(event)
        elif kind == "started":
            self._is_started = True
            self.frames, self.frame = event.get("frames"), event.get("frame")
            self.on_started()
        elif kind in ("progress", "frame"):
            if self.frames and isinstance(event.get("time"), (int, float)):
                self.fraction = min(event["time"] * self.frame_rate / self.frames, 1.0)
            if kind == "frame":
                self.frame = event.get("frame")
                self.on_frame()
        elif kind == "warning":
            self.warn(self._renamed(plain(str(event.get("message")))))
        elif kind == "error":
            self.errors += [self._renamed(text) for text in error_texts(event)]

    def _checked(self, event):
        self._is_checked = True
        speed = event.get("speed") or {}
        particles = (event.get("particles") or 0) + (event.get("emitted") or 0)
        self.estimate = (
            f"{particles:,} particles, {(event.get('memory_forecast') or 0) / 1e6:,.0f} MB, about "
            f"{duration(speed.get('expected_seconds') or 0)} on {speed.get('device', 'this machine')}"
        )
        for warning in event.get("warnings") or []:
            self.warn(self._renamed(problem_text(warning)))
        self.refuse_too_many(particles)

    def _renamed(self, text):
        for theirs, ours in self.names.items():
            text = text.replace(theirs, ours)
        return text

    def _ended(self, code):
        if not self.is_active:
            return
        if self._phase == "check":
            self._check_ended(code)
            return
        if code == 0 and self._is_started:
            self.state, self.fraction = "FINISHED", 1.0
        elif self.state == "STOPPING" or code == 130:
            self.state = "STOPPED"
        else:
            self._failed_with(code)
        if self._is_started:
            self.on_end()

    def _check_ended(self, code):
        if self.state == "STOPPING" or code == 130:
            self.state = "STOPPED"
        elif code != 0 or not self._is_checked:
            self._failed_with(code)
        elif self.folder is None:
            self.state = "CHECKED"
        else:
            self._run()

    def _failed_with(self, code):
        self.state = "FAILED"
        tail = plain(self.job.tail())
        if not self.errors and tail:
            self.errors.append(self._renamed(tail.removeprefix("error: ")))
        self.errors.append(exit_text(code))

    def fail(self, text):
        """Ends the program at once and reports `text`."""
        self.state = "FAILED"
        self.errors.append(text)
        self._end_job()

    def _end_job(self):
        if self.job is not None:
            self.job.kill()
            self.job.try_wait(KILL_LIMIT)

    def _clean(self):
        if self._temporary is not None:
            self._temporary.cleanup()
            self._temporary = None

    def cancel(self):
        """Ends the simulation after its frame; the second call ends it at once. Complete frames remain."""
        if self.state == "STOPPING":
            self.job.kill()
        elif self.is_active:
            self.job.stop()
            self.state = "STOPPING"

    def abandon(self, seconds=0.0):
        """Asks the program to end, and does not watch it any more. With `seconds`, waits so long and then ends it."""
        if not self.is_active:
            return
        self.job.stop()
        self.state = "STOPPED"
        if seconds > 0 and not self.job.try_wait(seconds):
            self._end_job()
        self._clean()

    def text(self):
        """The state in words."""
        if self.state == "CHECKING":
            return "Checking the scene"
        if self.state == "CHECKED":
            return self.estimate
        frames = f"frame {self.frame} of {self.frames}" if self.frames else "starting"
        words = {
            "RUNNING": f"Simulating: {frames}",
            "STOPPING": f"Stopping after this frame ({frames})" if self.frames else "Stopping",
            "FINISHED": f"Finished: {self.frames} frames",
            "STOPPED": f"Stopped at {frames}" if self.frames else "Stopped before the first frame",
            "FAILED": "Failed",
        }
        return words[self.state]


def _write(folder, files):
    for name, data in files.items():
        path = folder / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        except OSError as error:
            raise _unwritable(path, error) from error


def _unwritable(path, error):
    return Failed(f"{path} cannot be written: {error.strerror}. Choose another cache folder.")


def refuse_resume(run):
    """Raises [`Failed`] if the run in a folder cannot be resumed."""
    if is_locked(run):
        raise Failed(f"Another simulation writes into {run}. Wait for its end.")
    if RunFolder(run).report.get("status") == "finished":
        raise Failed(f"The run in {run} is finished: there is nothing to resume. For another duration, bake again.")
    if newest_checkpoint(run) is None:
        raise Failed(f"There is nothing to resume in {run}: it has no checkpoint. Bake instead.")


def plain(text):
    """A message of the program without the lines of the scene file, which the user has not written."""
    lines = []
    for line in text.splitlines():
        if re.match(r"\s*(-->|\d+ \||\||\d+ (error|warning)s? in )", line):
            continue
        found = re.match(r"\s*= (?:help: )?(.*)", line)
        lines.append(found[1] if found else line.removeprefix("error: "))
    return "\n".join(line for line in lines if line.strip())


def problem_text(problem):
    """A problem or warning of a check: what is wrong, what is allowed, and what to do."""
    if not isinstance(problem, dict):
        return str(problem)
    allowed = problem.get("allowed")
    parts = (problem.get("message"), f"allowed: {allowed}" if allowed else None, problem.get("hint"))
    return "\n".join(str(part) for part in parts if part)


def error_texts(event):
    """The problems of the scene, or the message of the program if it names none."""
    problems = [problem_text(problem) for problem in event.get("problems") or []]
    return problems or [plain(str(event.get("message")))]


def exit_text(code):
    """How a program ended, in words."""
    if code >= 0:
        return f"The program ended with exit code {code}."
    try:
        name = signal.Signals(-code).name
    except ValueError:
        name = f"signal {-code}"
    more = " The system may have run out of memory." if name == "SIGKILL" else ""
    return f"The program was ended by {name}.{more}"


def duration(seconds):
    """A duration in s in words."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
