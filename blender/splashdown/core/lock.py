"""Whether the program writes into the folder of a run. It locks the folder, or a file where folders cannot be locked."""

import os

try:
    import fcntl
except ImportError:
    fcntl = None
    import msvcrt


def is_locked(run):
    """True while a program holds the lock of the folder `run`. False where the file system has no locks."""
    return any(_is_held(path) for path in ([run] if fcntl else []) + [os.path.join(run, ".lock")])


def _is_held(path):
    try:
        descriptor = os.open(path, os.O_RDONLY if fcntl else os.O_RDWR)
    except OSError:
        return False
    try:
        if fcntl:
            # Shared, so that two that look at the same time do not see each other.
            fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
        else:
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
            msvcrt.locking(descriptor, msvcrt.LK_UNLCK, 1)
    except (BlockingIOError, PermissionError):
        return True
    except OSError:
        return False
    finally:
        os.close(descriptor)
    return False
