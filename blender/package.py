"""Packs the extension: `python blender/package.py FOLDER` writes FOLDER/splashdown-VERSION.zip and prints its path."""

import re
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent


def pack(folder):
    """Packs the extension with the version of the workspace. Raises OSError if a file cannot be read or written."""
    cargo = (ROOT.parent / "Cargo.toml").read_text(encoding="utf-8")
    version = re.search(r'^version = "([^"]+)"', cargo, re.MULTILINE)[1]
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"splashdown-{version}.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted((ROOT / "splashdown").glob("*")):
            if file.suffix not in {".py", ".toml"}:
                continue
            text = file.read_text(encoding="utf-8")
            if file.name == "blender_manifest.toml":
                text = re.sub(r'^version = "[^"]*"', f'version = "{version}"', text, flags=re.MULTILINE)
            archive.writestr(f"splashdown/{file.name}", text)
        for licence in ("LICENSE-MIT", "LICENSE-APACHE"):
            archive.write(ROOT.parent / licence, f"splashdown/{licence}")
    return path


if __name__ == "__main__":
    print(pack(Path(sys.argv[1])))
