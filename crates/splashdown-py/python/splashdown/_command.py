"""The command `splashdown`."""

import signal
import sys

from splashdown._splashdown import run_command


def main() -> None:
    """Runs the command line with the arguments of the process, and ends the process."""
    # The command handles Ctrl-C itself; Python's handler would wait for the end of the command.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(run_command(sys.argv))
