"""The folder of a run: which frames exist, and what is wrong with them."""

import json
import re
import tomllib
import zipfile
from pathlib import Path

from . import body_table, ply

# Folder and stem of the files of each series.
SERIES = {
    "surface": ("mesh", "surface"),
    "droplets": ("droplets", "droplets"),
    "particles": ("particles", "particles"),
    "spray": ("particles", "spray"),
    "foam": ("particles", "foam"),
    "bubbles": ("particles", "bubbles"),
}
DIFFUSE = ("spray", "foam", "bubbles")
# Other formats of frames, which this extension does not read.
OTHERS = ("obj", "stl", "vtk", "vtu", "vtp", "glb", "npz", "bgeo")


def listed(numbers):
    """Numbers of frames in words, such as `frames 3, 7 to 9`."""
    ranges = []
    for number in sorted(numbers):
        if ranges and number == ranges[-1][1] + 1:
            ranges[-1][1] = number
        else:
            ranges.append([number, number])
    words = [str(first) if first == last else f"{first} to {last}" for first, last in ranges[:4]]
    more = ", ..." if len(ranges) > 4 else ""
    one = len(ranges) == 1 and ranges[0][0] == ranges[0][1]
    return f"frame{'' if one else 's'} " + ", ".join(words) + more


def unreadable(numbers, series, cause):
    """Says that frames of a series cannot be read."""
    return f"{listed(numbers)} of {series} cannot be read ({cause}): the frame before is shown"


def three_numbers(value):
    """A list of three finite numbers, or `None`."""
    good = isinstance(value, list) and len(value) == 3 and all(type(part) in (int, float) for part in value)
    return value if good and all(abs(part) < 1e9 for part in value) else None


class RunFolder:
    """The files in the folder of a run, as they are when it is created."""

    def __init__(self, path):
        self.path = Path(path)
        self.report, self._report_problem = self._read_report()
        self.frames, self._doubled = {}, set()
        self._other = {}
        self._damage = {}
        for series in SERIES:
            self.frames[series] = self._find(series)

    def _read_report(self):
        path = self.path / "run.json"
        try:
            report = json.loads(path.read_text("utf-8"))
        except FileNotFoundError:
            return {}, "run.json is missing: the run was ended before its end"
        except (OSError, ValueError) as error:
            return {}, f"run.json cannot be read ({error})"
        return (report, None) if isinstance(report, dict) else ({}, "run.json is not an object")

    def _find(self, series):
        folder, stem = SERIES[series]
        pattern = re.compile(rf"{stem}_(\d{{1,9}})\.(ply|{'|'.join(OTHERS)})")
        found, others = {}, {}
        try:
            entries = sorted((self.path / folder).iterdir())
        except OSError:
            return {}
        for entry in entries:
            match = pattern.fullmatch(entry.name)
            if not match:
                continue
            number, ending = int(match[1]), match[2]
            if ending != "ply":
                others[number] = ending
            elif number in found:
                # The same number with another count of digits belongs to another run; the newer file wins.
                self._doubled.add(number)
                found[number] = max(found[number], entry, key=lambda path: path.stat().st_mtime_ns)
            else:
                found[number] = entry
        self._other[series] = {number: ending for number, ending in others.items() if number not in found}
        return found

    def main_series(self):
        """`surface`, or `particles` for a run without a surface; `None` if the folder has no frames in PLY files."""
        return next((series for series in ("surface", "particles") if self.frames[series]), None)

    def present(self):
        """The series to show: the surface or the particles, and what exists of droplets and foam."""
        main = self.main_series()
        if main is None:
            return []
        return [main] + [s for s in ("droplets", *DIFFUSE) if self.frames[s]]

    def last(self):
        """The number of the last frame."""
        return max(self.frames[self.main_series()])

    def at_or_before(self, series, number):
        """Number and path of a frame, or of the last one before it; `None` if there is none."""
        frames = self.frames[series]
        if number in frames:
            return number, frames[number]
        earlier = [existing for existing in frames if existing < number]
        return (max(earlier), frames[max(earlier)]) if earlier else None

    def _real(self, *keys):
        value = self.report
        for key in keys:
            value = value.get(key) if isinstance(value, dict) else None
        good = isinstance(value, (int, float)) and not isinstance(value, bool) and 0 < value < 1e9
        return float(value) if good else None

    def frame_interval(self):
        """Simulated time between frames in s; `None` if the report does not say."""
        rate = self._real("frame_rate")
        if rate is not None:
            return 1 / rate
        frames, time = self._real("complete_frames"), self._real("end", "time")
        return time / (frames - 1) if frames and time and frames > 1 else None

    def gravity(self):
        """In m/s^2, three numbers; `None` if the report does not say."""
        return three_numbers(self.report.get("gravity"))

    def particle_spacing(self):
        """In m; `None` if the report does not say."""
        return self._real("particle_spacing")

    def problems(self):
        """What is missing, mixed or truncated, as texts. Reads the start of each file."""
        main = self.main_series()
        if main is None:
            return [self._nothing()]
        numbers = self.frames[main]
        found = [self._report_problem] if self._report_problem else []
        missing = set(range(min(numbers), max(numbers) + 1)) - set(numbers)
        if missing:
            found.append(f"{listed(missing)} missing: the frame before is shown")
        for series in self.present()[1:]:
            without = set(numbers) - set(self.frames[series])
            if without:
                found.append(f"{listed(without)} without {series}")
        if main == "surface" and (more := set(self.frames["particles"]) - set(numbers) - missing):
            found.append(f"{listed(more)} without a surface")
        for series, others in self._other.items():
            if others and self.frames[series]:
                formats = ", ".join(sorted(set(others.values())))
                found.append(f"{listed(others)} of {series} only as {formats}, which is not read")
        if self._doubled:
            found.append(f"{listed(self._doubled)} exist twice: the folder mixes two runs, and the newer files are shown")
        complete = self._real("complete_frames")
        later = {number for number in numbers if complete and number >= complete}
        if later:
            found.append(f"{listed(later)} are later than the last one in run.json: they may belong to another run")
        for series in self.present():
            found += dict.fromkeys(self.damage(series).values())
        return found

    def damage(self, series):
        """A text for each frame of a series that cannot be read, by number. Frames with the same cause have the same text.
        Reads the start of each file, once."""
        if series not in self._damage:
            self._damage[series] = self._find_damage(series)
        return self._damage[series]

    def _find_damage(self, series):
        causes = {}
        for number, path in self.frames[series].items():
            try:
                ply.check(path)
            except ply.FrameError as error:
                # The sizes of truncated files differ.
                causes.setdefault(str(error).split(":")[0], {})[number] = str(error)
        texts = {}
        for cause, frames in causes.items():
            cause = next(iter(frames.values())) if len(frames) == 1 else cause
            texts.update(dict.fromkeys(frames, unreadable(frames, series, cause)))
        return texts

    def _nothing(self):
        formats = sorted({ending for others in self._other.values() for ending in others.values()})
        usd = sorted(path.name for path in self.path.glob("*.usdc")) if self.path.is_dir() else []
        if not self.path.is_dir():
            reason = "it is not a folder"
        elif formats:
            reason = f"its frames are {', '.join(formats)} files; simulate with `--formats ply`"
        elif usd:
            reason = f"it has only {usd[0]}; open that with File > Import > Universal Scene Description"
        else:
            reason = "choose the folder with `run.json` and `mesh`"
        return f"`{self.path}` has no frames in PLY files: {reason}"

    def body_names(self):
        """The names of the bodies according to the report; `None` if it does not say."""
        names = self.report.get("bodies")
        return names if isinstance(names, list) and all(isinstance(name, str) for name in names) else None

    def bodies(self, names=()):
        """The places of the bodies, by name: rows of time (s), position (m) and quaternion x, y, z, w. And problems.

        `names`: bodies of which a table must exist, in addition to those of the report.
        """
        places, found = {}, []
        folder = self.path / "bodies"
        names = {*names, *(self.body_names() or ()), *(path.stem for path in folder.glob("*.csv"))}
        frames = self.last() + 1 if self.main_series() else 0
        for name in sorted(names):
            rows, problems = body_table.read(folder / f"{name}.csv", frames)
            found += problems
            if rows:
                places[name] = rows
        return places, found

    def body_mesh(self, name):
        """The path of the mesh of a body, in its own frame."""
        return self.path / "bodies" / f"{name}.ply"


def newest_checkpoint(run):
    """The path of the last checkpoint of a run; `None` if it has none."""
    found = []
    for path in Path(run).glob("checkpoints/*.splashdown"):
        digits = re.search(r"(\d+)$", path.stem)
        found.append((int(digits[1]) if digits else -1, path))
    return max(found)[1] if found else None


def scene_of(run):
    """The scene of a run as a dictionary, from its last checkpoint; empty if there is none that can be read."""
    path = newest_checkpoint(run)
    if path is None:
        return {}
    try:
        with zipfile.ZipFile(path) as archive:
            return tomllib.loads(archive.read("scene.toml").decode("utf-8"))
    except (OSError, KeyError, ValueError, zipfile.BadZipFile):
        return {}
