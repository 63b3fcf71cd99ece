"""A child process that prints JSON lines. Reading them never waits."""

import json
import os
import queue
import subprocess
import sys
import threading
from collections import deque

LONGEST_TAIL = 40
# Replaces itself by the program, which Linux then ends when Blender ends, even if Blender crashes or is killed. The call is
# not made between fork and exec, where code of Python may deadlock in a process with threads.
LAUNCHER = """
import os, signal, sys
try:
    import ctypes
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
except Exception:
    # A Python without ctypes; the simulation is more important.
    pass
# Python ignores this signal, and a program inherits that.
signal.signal(signal.SIGPIPE, signal.SIG_DFL)
if os.getppid() == int(sys.argv[1]):
    os.execv(sys.argv[2], sys.argv[2:])
"""


def bound_to_parent(command):
    """A command that runs `command` and, on Linux, ends with this process. Elsewhere `command` itself."""
    python = sys.executable or ""
    # The signal comes when the thread that started the program ends.
    is_safe = threading.current_thread() is threading.main_thread()
    is_python = os.path.basename(python).startswith("python") and os.path.isfile(python)
    if sys.platform != "linux" or not is_safe or not is_python:
        return command
    return [python, "-I", "-S", "-c", LAUNCHER, str(os.getpid()), *command]


class Job:
    """A running program. `poll` returns its events; `stop` asks it to end after its frame; `kill` ends it at once."""

    def __init__(self, command, folder):
        """Starts `command` (a list of words) in a folder. Raises `OSError` if it cannot be started."""
        flags = {"creationflags": subprocess.CREATE_NO_WINDOW} if sys.platform == "win32" else {}
        # The launcher would report a missing program as its own failure.
        if os.path.dirname(command[0]) and not os.path.isfile(command[0]):
            raise FileNotFoundError(f"{command[0]} is not a file")
        self._process = subprocess.Popen(
            bound_to_parent(command),
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            errors="replace",
            **flags,
        )
        self._events = queue.SimpleQueue()
        self._tail = deque(maxlen=LONGEST_TAIL)
        self._readers = [
            threading.Thread(target=self._read_events, name="splashdown output", daemon=True),
            threading.Thread(target=self._read_errors, name="splashdown errors", daemon=True),
        ]
        for reader in self._readers:
            reader.start()

    def _read_events(self):
        with self._process.stdout as lines:
            for line in lines:
                try:
                    event = json.loads(line)
                except ValueError:
                    event = None
                if isinstance(event, dict) and isinstance(event.get("event"), str):
                    self._events.put(event)
                else:
                    self._tail.append(line.rstrip())

    def _read_errors(self):
        with self._process.stderr as lines:
            for line in lines:
                self._tail.append(line.rstrip())

    @property
    def pid(self):
        return self._process.pid

    def poll(self):
        """The events since the last call, and the exit code, or `None` while the program runs. With the exit code all
        events have been returned."""
        code = self._process.poll()
        if code is not None:
            # Both pipes are at their ends; another process could only hold them open if the program had started one.
            for reader in self._readers:
                reader.join(5)
        events = []
        while not self._events.empty():
            events.append(self._events.get())
        return events, code

    def stop(self):
        """Asks the program to end: after its frame, with a checkpoint. On Windows it ends at once; complete frames and the
        last checkpoint remain."""
        if self._process.poll() is None:
            # SIGTERM, not SIGINT: a shell may have started Blender with SIGINT ignored, which children inherit.
            self._process.terminate()

    def kill(self):
        """Ends the program at once. Complete frames remain."""
        if self._process.poll() is None:
            self._process.kill()

    def wait(self, seconds):
        """Waits for the end. Raises `subprocess.TimeoutExpired`."""
        self._process.wait(seconds)

    def try_wait(self, seconds):
        """Waits for the end. Returns whether it came in time."""
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            return False
        return True

    def tail(self):
        """The last lines that are not events, as one text."""
        return "\n".join(line for line in self._tail if line).strip()
