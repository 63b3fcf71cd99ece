"""The program `splashdown`: where it is, and how to install it."""

import os
import shutil
import subprocess
import sys
import tomllib
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
        # A bake starts the program in another folder.
        return [os.path.abspath(os.path.expanduser(given))]
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


def extension_version():
    """The version of this extension."""
    manifest = Path(__file__).resolve().parent.parent / "blender_manifest.toml"
    return tomllib.loads(manifest.read_text("utf-8"))["version"]


def require(path):
    """Raises [`ProgramError`] unless the program belongs to this extension: both have the same first two numbers in their
    versions, so that events and options are known."""
    theirs, ours = version(path), extension_version()
    if theirs.split(".")[:2] != ours.split(".")[:2]:
        raise ProgramError(
            f"`{path}` has version {theirs}, and the extension has version {ours}: install the same version of both."
        )
