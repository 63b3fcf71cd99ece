"""The package as it is installed: command, version, import, types."""

from __future__ import annotations

import ast
import importlib.metadata
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest
from conftest import REPOSITORY, optional, skip

import splashdown

PACKAGE = Path(splashdown.__file__).parent


def command(*arguments: str) -> subprocess.CompletedProcess[str]:
    program = Path(sysconfig.get_path("scripts")) / ("splashdown.exe" if os.name == "nt" else "splashdown")
    return subprocess.run([program, *arguments], capture_output=True, text=True, timeout=300, check=False)


def test_the_command_is_installed(tmp_path: Path) -> None:
    assert command("--version").stdout.split() == ["splashdown", splashdown.__version__]
    listed = command("scenes").stdout
    assert all(name in listed for name in splashdown.Scene.presets())
    wrong = command("run", str(tmp_path / "missing.toml"))
    assert wrong.returncode == 3 and "cannot open the scene file" in wrong.stderr
    assert command("no-such-command").returncode == 2
    out = tmp_path / "out"
    arguments = ["--frames", "1", "--no-pictures", "--device", "cpu", "--json", "--out", str(out)]
    done = command("run", "dam-break-small", *arguments)
    assert done.returncode == 0, done.stderr
    assert all(json.loads(line) for line in done.stdout.splitlines())
    assert (out / "run.json").exists()


def test_versions_agree() -> None:
    assert importlib.metadata.version("splashdown") == splashdown.__version__


def test_the_metadata_of_the_wheel() -> None:
    distribution = importlib.metadata.distribution("splashdown")
    metadata = distribution.metadata
    assert metadata["License-Expression"] == "MIT OR Apache-2.0" and metadata["Requires-Python"] == ">=3.10"
    urls = dict(url.split(", ") for url in metadata.get_all("Project-URL") or [])
    assert {"Repository", "Documentation", "Changelog", "Issues"} <= urls.keys()
    linked = [REPOSITORY / url.split("/blob/main/")[1] for url in urls.values() if "/blob/main/" in url]
    assert len(linked) == 2 and all(path.exists() for path in linked)
    assert metadata["Description-Content-Type"].startswith("text/markdown")
    assert "splashdown.Simulation" in str(metadata.get_payload()), "the readme is missing"
    files = [str(file) for file in distribution.files or []]
    licences = {file.rsplit("/", 1)[-1] for file in files if ".dist-info/licenses/" in file}
    assert licences == {"LICENSE-APACHE", "LICENSE-MIT"}
    # Nothing is installed beside the package, its description and the command.
    places = {file.split("/", 1)[0] for file in files if not file.startswith("..")}
    assert places == {"splashdown", f"splashdown-{splashdown.__version__}.dist-info"}
    assert "splashdown/py.typed" in files and "splashdown/_splashdown.pyi" in files


def test_importing_needs_no_optional_package() -> None:
    code = "import sys, splashdown; print(sorted({'pandas', 'ray', 'tqdm', 'trimesh'} & sys.modules.keys()))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_every_exception_is_an_error() -> None:
    classes = [getattr(splashdown, name) for name in splashdown.__all__ if name.endswith("Error")]
    assert len(classes) > 8
    assert all(issubclass(kind, splashdown.Error) for kind in classes)


@pytest.mark.parametrize("page", ["docs/guide/src/python.md", "docs/guide/src/parameter-studies.md", "README.md"])
def test_the_code_in_the_guide_uses_names_that_exist(page: str) -> None:
    text = (REPOSITORY / page).read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    names: set[str] = set()
    for block in blocks:
        if block.startswith("{{#include"):
            continue
        for node in ast.walk(ast.parse(block)):
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "splashdown":
                names.add(node.attr)
            if isinstance(node, ast.ImportFrom) and node.module == "splashdown":
                names.update(alias.name for alias in node.names)
    assert names, "control: the page uses the package"
    assert names <= set(splashdown.__all__), names - set(splashdown.__all__)


USE = '''
import numpy
from numpy.typing import NDArray

import splashdown

scene: splashdown.Scene = splashdown.Scene(scene={"name": "a"})
with splashdown.Simulation(scene) as simulation:
    stats: splashdown.Stats = simulation.advance(0.1)
    positions: NDArray[numpy.float32] = simulation.positions
    simulation.velocities = positions * numpy.float32(2)
for frame in splashdown.Run(scene, progress=lambda now: print(now.time)):
    if frame.mesh is not None:
        volume: float = frame.mesh.volume
'''
WRONG = '''
import splashdown

splashdown.Simulation("dam-break")
'''


@pytest.mark.parametrize("checker", ["mypy", "pyright"])
def test_types(checker: str, tmp_path: Path) -> None:
    """The files of the package and a use of it, strictly; as controls a wrong use and an error in the package."""
    optional(checker)
    copy = tmp_path / "splashdown"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__", "*.so", "*.pyd"))
    # The settings of both programs.
    shutil.copy(REPOSITORY / "crates/splashdown-py/pyproject.toml", tmp_path)
    (tmp_path / "use.py").write_text(USE)
    (tmp_path / "wrong.py").write_text(WRONG)

    def check(*paths: str) -> subprocess.CompletedProcess[str]:
        arguments = [sys.executable, "-m", checker, *paths]
        if checker == "pyright":
            arguments += ["--pythonpath", sys.executable]
        return subprocess.run(arguments, capture_output=True, text=True, cwd=tmp_path, check=False, timeout=300)

    right = check("use.py", "splashdown")
    if checker == "pyright" and "node" in right.stderr.lower() and right.returncode not in (0, 1):
        skip(f"pyright cannot start, it needs Node.js: {right.stderr.strip().splitlines()[-1]}")
    assert right.returncode == 0, right.stdout + right.stderr
    with (copy / "_types.py").open("a") as file:
        file.write('\nNUMBER: int = "text"\n')
    wrong = check("wrong.py", "splashdown")
    assert wrong.returncode == 1 and all(name in wrong.stdout for name in ("wrong.py", "_types.py")), wrong.stdout + wrong.stderr


def test_the_stubs_match_the_module() -> None:
    """mypy's stubtest compares names, arguments and defaults at run time."""
    optional("mypy")
    done = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "splashdown._splashdown", "--ignore-disjoint-bases"],
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr
