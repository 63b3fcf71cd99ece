"""The command `splashdown`."""

import os
import signal
import sys
import tempfile

from splashdown._splashdown import run_command


def main() -> None:
    """Runs the command line with the arguments of the process, and ends the process."""
    # Mesa prints a message that looks like an error of this program where the variable is missing.
    os.environ.setdefault("XDG_RUNTIME_DIR", tempfile.gettempdir())
    # The command handles Ctrl-C itself; Python's handler would wait for the end of the command.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(run_command(sys.argv))
