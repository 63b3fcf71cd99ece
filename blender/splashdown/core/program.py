"""The program `splashdown`: where it is, and how to install it."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

INSTALL = (
    "Install Rust (https://rustup.rs) and clone the repository of Splashdown.",
    "In the clone, run: cargo install --path crates/splashdown-cli",
    "Or, with Python 3.10 or newer: pip install ./crates/splashdown-py",
    "Then restart Blender, or set the path of the program in the preferences of the extension.",
)
NAME = "splashdown.exe" if sys.platform == "win32" else "splashdown"
# A program of a few hundred kilobytes starts in much less; a folder on the network may be slow.
START_LIMIT = 20.0


class ProgramError(Exception):
    """The program is missing or cannot be used. The text says what to do."""


def candidates(given=""):
    """Paths to try, first that of the preferences. Blender that is started from a desktop often lacks the user's PATH."""
    if given:
        return [given]
    found = shutil.which(NAME)
    home = Path.home()
    places = [home / ".cargo/bin" / NAME, home / ".local/bin" / NAME, Path("/usr/local/bin") / NAME]
    return ([found] if found else []) + [str(place) for place in places]


def find(given=""):
    """The path of the program. Raises [`ProgramError`] with the commands that install it."""
    for path in candidates(given):
        if os.path.isfile(path) and os.access(path, os.X_OK):
            return path
    where = f"`{given}`, which the preferences name, is not a program." if given else "The program `splashdown` is not installed."
    raise ProgramError("\n".join([where, *INSTALL]))


def version(path):
    """The version of the program, such as `0.1.0`. Raises [`ProgramError`] if another program is found."""
    try:
        output = subprocess.run(
            [path, "--version"], capture_output=True, text=True, timeout=START_LIMIT, stdin=subprocess.DEVNULL, check=False
        )
    except (OSError, subprocess.SubprocessError) as error:
        raise ProgramError(f"`{path}` cannot be started: {error}") from error
    words = output.stdout.split()
    if output.returncode != 0 or len(words) != 2 or words[0] != "splashdown":
        raise ProgramError(f"`{path}` is not the program `splashdown`: `--version` prints {output.stdout.strip()[:60]!r}.")
    return words[1]
