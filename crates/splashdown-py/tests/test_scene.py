"""Scenes: from files, texts, dictionaries and keyword arguments, with the same messages."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy
import pytest
from conftest import column

import splashdown
from splashdown import Scene, SceneError


def test_every_source_gives_the_same_scene(tmp_path: Path) -> None:
    scene = column()
    path = tmp_path / "column.toml"
    path.write_text(scene.text)
    same = [Scene.parse(scene.text), Scene(scene.to_dict()), Scene(**scene.to_dict()), pickle.loads(pickle.dumps(scene))]
    assert all(other == scene and hash(other) == hash(scene) for other in same)
    loaded = Scene.load(path)
    assert loaded.to_dict() == scene.to_dict() and loaded.path == path
    # Control: a changed scene differs.
    assert column(**{"scene.duration": 1.0}) != scene


def test_messages_are_those_of_files(tmp_path: Path) -> None:
    text = column().text.replace("particle_spacing = 0.1", "particle_spacing = -0.1\nviscosty = 3")
    path = tmp_path / "column.toml"
    path.write_text(text)
    with pytest.raises(SceneError) as of_file:
        Scene.load(path)
    with pytest.raises(SceneError) as of_text:
        Scene.parse(text, name=str(path))
    sections = column().to_dict()
    sections["fluid"].update(particle_spacing=-0.1, viscosty=3)
    with pytest.raises(SceneError) as of_dictionary:
        Scene(sections)
    assert str(of_file.value) == str(of_text.value)
    assert sorted(of_file.value.problems) == sorted(of_dictionary.value.problems)
    assert len(of_file.value.problems) == 2
    assert "fluid.particle_spacing is -0.1" in str(of_file.value) and "did you mean" in str(of_file.value)
    assert isinstance(of_file.value, ValueError) and isinstance(of_file.value, splashdown.Error)


def test_numpy_values_and_paths_are_values_of_scenes() -> None:
    scene = column(**{
        "fluid.particle_spacing": numpy.float64(0.05),
        "domain.max": numpy.array([1.6, 1.2, 0.5]),
        "surface.enabled": numpy.bool_(False),
    })
    assert scene.to_dict()["domain"]["max"] == [1.6, 1.2, 0.5]
    assert scene.to_dict()["surface"]["enabled"] is False


def test_changes_of_paths() -> None:
    scene = column(**{"fluid.block[0].size": [0.3, 0.3, 0.5], "solver.cfl_factor": 0.2})
    assert scene.to_dict()["fluid"]["block"][0]["size"] == [0.3, 0.3, 0.5]
    assert scene.replace(solver={"max_dt": 0.001}).to_dict()["solver"] == {"cfl_factor": 0.2, "max_dt": 0.001}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"fluid.block[1].size": [1, 1, 1]}, "the scene has 1 elements in block, counted from 0"),
        ({"fluid.block.size": [1, 1, 1]}, "elements of a list have an index, as in block[0]"),
        ({"fluid.block[x]": 1}, "has no index such as [0]"),
        ({"fluid..viscosity": 1}, "it has an empty name"),
        ({"fluid.viscosity": None}, "fluid.viscosity is None: leave the key out"),
        ({"fluid.viscosity": object()}, "fluid.viscosity is a object; a number, text"),
        ({"fluid.viscosity": 2**70}, "beyond 64 bits"),
        ({"fluid": {1: 2}}, "fluid has the key 1; keys are texts"),
        ({"fluid.viscosity": "thick"}, "fluid.viscosity"),
        ({"fluid.viscosity": float("nan")}, "fluid.viscosity"),
    ],
)
def test_wrong_changes(changes: dict[str, object], message: str) -> None:
    with pytest.raises(SceneError) as error:
        column().replace(changes)
    assert message in str(error.value)


def test_wrong_sources(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="there is no built-in scene 'dam'|there is no built-in scene \"dam\""):
        Scene.preset("dam")
    with pytest.raises(SceneError, match="cannot open the scene file"):
        Scene.load(tmp_path / "missing.toml")
    with pytest.raises(TypeError, match="given twice"):
        Scene({"scene": {}}, scene={})
    with pytest.raises(TypeError):
        Scene(3)  # type: ignore[arg-type]


def test_files_are_searched_in_the_folder(tmp_path: Path) -> None:
    numpy.save(tmp_path / "points.npy", numpy.full((5, 3), 0.3, numpy.float32) + numpy.arange(5)[:, None] * 0.1)
    sections = column().to_dict()
    sections["fluid"]["file"] = [{"file": "points.npy"}]
    del sections["fluid"]["block"]
    assert "points.npy" in Scene(sections, folder=tmp_path).text
    with pytest.raises(SceneError, match="points.npy"):
        Scene(sections, folder=tmp_path / "elsewhere")
