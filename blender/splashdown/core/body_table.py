"""The table of a body in the folder of a run: its place in every frame."""

import csv

# The start of the first line, without units.
COLUMNS = ("time", "position x")


def read(path, frames):
    """The rows (time, position, quaternion) of the table of a body, and problems as texts.

    `frames`: the number of frames of the run, for each of which there should be a row.
    """
    try:
        with open(path, newline="", encoding="utf-8", errors="replace") as file:
            lines = list(csv.reader(file))
    except FileNotFoundError:
        return [], [f"{path.name} is missing in bodies: the body does not move"]
    except (OSError, csv.Error) as error:
        return [], [f"{path.name} cannot be read ({error}): the body does not move"]
    header = [name.split(" (")[0] for name in lines[0]] if lines else []
    if tuple(header[: len(COLUMNS)]) != COLUMNS:
        return [], [f"{path.name} is not the table of a body: the body does not move"]
    rows = [row for row in (_row(line, len(header)) for line in lines[1:]) if row is not None]
    found = []
    broken = len(lines) - 1 - len(rows)
    if broken:
        found.append(f"{path.name} has {broken} incomplete row" + ("s" if broken > 1 else ""))
    if len(rows) + broken < frames:
        end = f"the body stops at {rows[-1][0]:.4g} s" if rows else "the body does not move"
        found.append(f"{path.name} has {len(rows) + broken} rows for {frames} frames: {end}")
    return rows, found


def _row(line, width):
    """Time, position and quaternion of a line; `None` if it cannot be used."""
    try:
        values = [float(word) for word in line[:8]]
    except ValueError:
        return None
    norm = sum(value * value for value in values[4:8])
    if len(values) != 8 or len(line) != width or not 0.9 < norm < 1.1:
        return None
    if not all(abs(value) < 1e9 for value in values):
        return None
    return values[0], tuple(values[1:4]), tuple(values[4:8])
