"""What the tests share: a small scene, and names for the examples of the documentation."""

from __future__ import annotations

import importlib
import signal
import sys
import typing
from pathlib import Path

import numpy
import pytest

import splashdown

REPOSITORY = Path(__file__).resolve().parents[3]


def column(**changes: object) -> splashdown.Scene:
    """120 particles that collapse."""
    scene = splashdown.Scene(
        scene={"name": "column", "duration": 0.5},
        domain={"min": [0, 0, 0], "max": [1.6, 1.0, 0.5]},
        fluid={"particle_spacing": 0.1, "block": [{"position": [0, 0, 0], "size": [0.4, 0.6, 0.5]}]},
    )
    return scene.replace(changes) if changes else scene


@pytest.fixture(name="scene")
def scene_fixture() -> splashdown.Scene:
    return column()


@pytest.fixture
def simulation(scene: splashdown.Scene) -> splashdown.Simulation:
    return splashdown.Simulation(scene, device="cpu")


@pytest.fixture
def cloud() -> numpy.ndarray:
    """1,000 points in a unit cube."""
    return numpy.random.default_rng(1).random((1000, 3), dtype=numpy.float32)


@pytest.fixture(autouse=True)
def interrupts() -> typing.Iterator[None]:
    """Ctrl-C raises `KeyboardInterrupt`, also where a shell has started the tests in the background, which ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def skip(reason: str) -> typing.NoReturn:
    """Skips a test; `cargo xtask test` shows and counts the line."""
    print(f"SKIPPED: {reason}", file=sys.__stderr__)
    pytest.skip(reason, allow_module_level=True)


def optional(name: str) -> typing.Any:
    """An optional package. A test without it is skipped."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        skip(f"{name} is not installed ({error}); `cargo xtask wheel` installs it")
