"""The program as a child process with its JSON events. Needs no Blender."""

import atexit
import json
import os
import queue
import shutil
import signal
import subprocess
import threading
import time
from pathlib import Path

INSTALL = (
    "The program splashdown was not found. Install it with Rust from a clone of its repository: "
    "cargo install --path crates/splashdown-cli. "
    "Then restart Blender, or set its path in the preferences of the extension."
)
# Errors beyond this many characters are cut.
ERROR_LIMIT = 4000


class ProgramMissing(RuntimeError):
    """The program is not installed or its path is wrong."""


def find_program(configured=""):
    """The path of the program: the configured one, else that on PATH, else that of `cargo install`.

    Raises ProgramMissing with the way to install it.
    """
    if configured:
        found = shutil.which(configured)
        if found is None:
            raise ProgramMissing(f"{configured} is not a program. {INSTALL}")
        return found
    cargo = Path.home() / ".cargo" / "bin"
    found = shutil.which("splashdown") or shutil.which("splashdown", path=str(cargo))
    if found is None:
        raise ProgramMissing(INSTALL)
    return found


class Run:
    """A running simulation. `poll` never waits."""

    def __init__(self, program, scene, out, device="auto"):
        """Starts `splashdown run`. Raises OSError if the program cannot be started."""
        arguments = [program, "run", str(scene), "--out", str(out), "--device", device]
        arguments += ["--formats", "ply", "--no-pictures", "--no-film", "--json", "--quiet"]
        flags = getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0) | getattr(subprocess, "CREATE_NO_WINDOW", 0)
        self.child = subprocess.Popen(
            arguments,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            encoding="utf-8",
            errors="replace",
            creationflags=flags,
        )
        self.events = queue.SimpleQueue()
        self.frames = None
        self.frame = -1
        self.progress = 0.0
        self.error = None
        self.warnings = []
        self.was_cancelled = False
        self._stderr = []
        self._threads = [
            threading.Thread(target=self._read_events, daemon=True),
            threading.Thread(target=self._read_errors, daemon=True),
        ]
        for thread in self._threads:
            thread.start()
        self._kill_at = None
        # Blender may end during a bake.
        atexit.register(self._kill)

    def _read_events(self):
        for line in self.child.stdout:
            try:
                event = json.loads(line)
            except ValueError:
                continue
            if isinstance(event, dict):
                self.events.put(event)

    def _read_errors(self):
        for line in self.child.stderr:
            if sum(map(len, self._stderr)) < ERROR_LIMIT:
                self._stderr.append(line)

    def poll(self):
        """Handles the events so far. Returns whether the program still runs."""
        is_running = self.child.poll() is None
        if is_running and self._kill_at is not None and time.monotonic() > self._kill_at:
            self._kill()
        if not is_running:
            atexit.unregister(self._kill)
            for thread in self._threads:
                thread.join(timeout=5)
            self.child.stdout.close()
            self.child.stderr.close()
        while True:
            try:
                self._handle(self.events.get_nowait())
            except queue.Empty:
                break
        if not is_running and self.error is None and not self.was_cancelled and self.child.returncode != 0:
            text = "".join(self._stderr).strip()
            self.error = text or f"The program ended with exit code {self.child.returncode}."
        return is_running

    def _handle(self, event):
        kind = event.get("event")
        self.frames = event.get("frames") or self.frames
        if kind == "frame" and event.get("frame") is not None:
            self.frame = max(self.frame, event["frame"])
            self.progress = max(self.frame, 0) / max(self.frames or 1, 1)
        elif kind == "warning":
            self.warnings.append(str(event.get("message")))
        elif kind == "error":
            self.error = str(event.get("message"))[:ERROR_LIMIT]
        elif kind == "interrupted":
            self.was_cancelled = True
        elif kind == "finished":
            self.progress = 1.0

    def cancel(self, timeout=20.0):
        """Stops the program as Ctrl-C does, so that finished frames remain; `poll` kills it after `timeout` seconds."""
        if self.child.poll() is not None or self._kill_at is not None:
            return
        self.was_cancelled = True
        self._kill_at = time.monotonic() + timeout
        self.child.send_signal(signal.CTRL_BREAK_EVENT if os.name == "nt" else signal.SIGINT)

    def _kill(self):
        if self.child.poll() is None:
            self.child.kill()
            self.child.wait()
