"""A child process that prints JSON lines. Reading them never waits."""

import json
import queue
import subprocess
import sys
import threading
from collections import deque

LONGEST_TAIL = 40


class Job:
    """A running program. `poll` returns its events; `stop` asks it to end after its frame; `kill` ends it at once."""

    def __init__(self, command, folder):
        """Starts `command` (a list of words) in a folder. Raises `OSError` if it cannot be started."""
        flags = {"creationflags": subprocess.CREATE_NO_WINDOW} if sys.platform == "win32" else {}
        self._process = subprocess.Popen(
            command,
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

    def tail(self):
        """The last lines that are not events, as one text."""
        return "\n".join(line for line in self._tail if line).strip()
