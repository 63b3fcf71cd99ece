"""Packs the extension: `package.py OUT.zip`. The same sources give the same bytes on every system."""

import sys
import zipfile
from pathlib import Path

FOLDER = Path(__file__).resolve().parent / "splashdown"
# The earliest time that a ZIP archive can store.
TIME = (1980, 1, 1, 0, 0, 0)


def sources():
    """Paths of the files of the extension, sorted by their names in the archive."""
    files = [path for path in FOLDER.rglob("*") if path.is_file() and path.suffix in (".py", ".toml")]
    return sorted(files, key=lambda path: path.relative_to(FOLDER).as_posix())


def pack(path):
    """Writes the archive. Nothing is compressed: the result of compression depends on the version of zlib."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        for source in sources():
            entry = zipfile.ZipInfo(source.relative_to(FOLDER).as_posix(), TIME)
            entry.external_attr = 0o644 << 16
            entry.create_system = 3
            # Git may convert the ends of lines.
            archive.writestr(entry, source.read_bytes().replace(b"\r\n", b"\n"))


if __name__ == "__main__":
    pack(sys.argv[1])
