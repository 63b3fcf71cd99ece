"""Readers and writers, surfaces, and runs with files."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import numpy
import pytest

import splashdown
from splashdown import FileError, Particles


def test_every_particle_format(tmp_path: Path, cloud: numpy.ndarray) -> None:
    read, written = splashdown.particle_formats()
    velocities = cloud[::-1].copy()
    ids = numpy.arange(len(cloud))
    particles = Particles(cloud, velocities=velocities, ids=ids, time=0.5, particle_spacing=0.02)
    both = sorted(set(read) & set(written))
    assert {".ply", ".vtk", ".vtu", ".vtp", ".bgeo", ".npz"} <= set(both)
    for ending in both:
        path = tmp_path / f"points{ending}"
        assert splashdown.write_particles(path, particles) == path.stat().st_size
        again = splashdown.read_particles(path)
        assert numpy.array_equal(again.positions, cloud), ending
        assert numpy.array_equal(again.velocities, velocities), ending
        assert (again.ids == ids).all(), ending
        assert (again.time, again.particle_spacing) == (0.5, particles.particle_spacing), ending
        # Control: particles without them.
        splashdown.write_particles(path, Particles(cloud))
        again = splashdown.read_particles(path)
        assert (again.time, again.particle_spacing) == (None, None), ending


def test_files_without_particles(tmp_path: Path) -> None:
    """As those of foam before the first splash."""
    splashdown.write_particles(tmp_path / "none.ply", Particles(numpy.zeros((0, 3), numpy.float32)))
    assert len(splashdown.read_particles(tmp_path / "none.ply")) == 0


def test_every_mesh_format(tmp_path: Path, cloud: numpy.ndarray) -> None:
    mesh = splashdown.surface(cloud, 0.1, device="cpu")
    read, written = splashdown.mesh_formats()
    both = sorted(set(read) & set(written))
    assert {".ply", ".obj", ".stl", ".glb"} <= set(both)
    for ending in both:
        path = tmp_path / f"surface{ending}"
        assert splashdown.write_mesh(path, mesh) == path.stat().st_size
        again = splashdown.read_mesh(path)
        assert again.is_watertight and again.volume == pytest.approx(mesh.volume, rel=1e-5), ending
        assert len(again.triangles) == len(mesh.triangles), ending


def test_wrong_files(tmp_path: Path, cloud: numpy.ndarray) -> None:
    with pytest.raises(FileError, match="missing.ply"):
        splashdown.read_particles(tmp_path / "missing.ply")
    with pytest.raises(OSError, match=r"\.doc"):
        splashdown.write_particles(tmp_path / "points.doc", Particles(cloud))
    (tmp_path / "wrong.ply").write_bytes(b"ply\nnonsense")
    with pytest.raises(FileError, match="wrong.ply"):
        splashdown.read_particles(tmp_path / "wrong.ply")


def test_surface(cloud: numpy.ndarray) -> None:
    plain = splashdown.surface(cloud, 0.1, device="cpu")
    smooth = splashdown.surface(cloud, 0.1, smoothing=20, device="cpu")
    fine = splashdown.surface(cloud, 0.1, cell_size=0.025, device="cpu")
    assert plain.is_watertight and plain.normals.shape == plain.vertices.shape
    assert len(smooth.vertices) == len(plain.vertices) and smooth.area < plain.area
    assert len(fine.triangles) > 3 * len(plain.triangles)
    assert 0.5 < plain.volume < 2
    stretched = splashdown.surface(cloud, 0.1, kernels="anisotropic", device="cpu")
    assert stretched.is_watertight and stretched.volume != plain.volume
    with pytest.raises(splashdown.ParameterError, match="allowed are isotropic, anisotropic"):
        splashdown.surface(cloud, 0.1, kernels="round", device="cpu")  # type: ignore[arg-type]
    empty = splashdown.surface(numpy.zeros((0, 3), numpy.float32), 0.1, device="cpu")
    assert empty.vertices.shape == empty.triangles.shape == (0, 3)


def test_wrong_surfaces(cloud: numpy.ndarray) -> None:
    for arguments in (
        {"particle_spacing": -1.0},
        {"particle_spacing": 0.1, "iso_level": 0.0},
        {"particle_spacing": 0.1, "smoothing": -1},
    ):
        with pytest.raises(splashdown.ParameterError, match="it must be"):
            splashdown.surface(cloud, device="cpu", **arguments)
    with pytest.raises(splashdown.ArrayError, match="points has dtype int64"):
        splashdown.surface(numpy.zeros((4, 3), numpy.int64), 0.1)  # type: ignore[arg-type]


def test_a_run_with_files_and_its_continuation(scene: splashdown.Scene, tmp_path: Path) -> None:
    seen: list[float] = []
    crate = {"name": "crate", "mesh": "cube", "scale": 0.2, "position": [1, 0.5, 0.25], "motion": "dynamic"}
    scene = scene.replace(body=[crate])
    options = {"formats": ["npz"], "pictures": [], "device": "cpu"}
    first = splashdown.run(
        scene, tmp_path / "out", frames=2, checkpoint_every=1, progress=lambda now: seen.append(now.time), **options
    )
    assert first["frames"] == 3 and first["steps"] > 0
    splashdown.run(tmp_path / "out", frames=4)
    whole = splashdown.run(scene, tmp_path / "whole", frames=4, **options)
    assert whole["frames"] == 5
    name = "particles/particles_0004.npz"
    resumed, uninterrupted = ((tmp_path / folder / name).read_bytes() for folder in ("out", "whole"))
    assert resumed == uninterrupted
    assert resumed != (tmp_path / "whole/particles/particles_0003.npz").read_bytes()
    # The table of the body, whose last row has the state that a `Run` returns.
    resumed, uninterrupted = ((tmp_path / folder / "bodies/crate.csv").read_text() for folder in ("out", "whole"))
    assert resumed == uninterrupted and len(resumed.splitlines()) == 6
    *_, last = splashdown.Run(scene, device="cpu", frames=4, surface=False)
    row = [float(word) for word in resumed.splitlines()[-1].split(",")]
    assert row[0] == last.time and tuple(numpy.float32(row[1:4])) == last.bodies[0].position
    assert row[2] < 0.5 and tuple(numpy.float32(row[8:11])) == last.bodies[0].velocity, "control: it falls"


def test_an_interrupted_run_with_files_can_be_resumed(scene: splashdown.Scene, tmp_path: Path) -> None:
    # Short steps, so that the run does not end before it is interrupted.
    fine = scene.replace({"fluid.particle_spacing": 0.05, "scene.frame_rate": 100, "solver.method": "wcsph"})
    options = {"frames": 20, "formats": ["npz"], "pictures": [], "surface": False, "device": "cpu"}
    calls = 0

    def interrupt(now: splashdown.Progress) -> None:
        nonlocal calls
        calls += 1
        if calls == 1:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        splashdown.run(fine, tmp_path / "out", progress=interrupt, **options)
    done = len(list((tmp_path / "out/particles").glob("*.npz")))
    assert 0 < done < 21 and calls >= 1
    assert splashdown.run(tmp_path / "out")["frames"] == 21
    splashdown.run(fine, tmp_path / "whole", **options)
    resumed, whole = ((tmp_path / name / "particles/particles_0020.npz").read_bytes() for name in ("out", "whole"))
    assert resumed == whole


def test_wrong_runs_with_files(scene: splashdown.Scene, tmp_path: Path) -> None:
    with pytest.raises(splashdown.ParameterError, match=r'give splashdown.Scene.preset\("dam-break"\)'):
        splashdown.run("dam-break")
    with pytest.raises(splashdown.ParameterError, match=r'my.toml` is a scene .* give splashdown.Scene.load\('):
        splashdown.run(tmp_path / "my.toml")
    with pytest.raises(splashdown.ParameterError, match="frames is 0; it must be a whole number from 1"):
        splashdown.run(scene, tmp_path, frames=0)
    with pytest.raises(splashdown.ParameterError, match="checkpoint_every is -1; it must be"):
        splashdown.run(scene, tmp_path, checkpoint_every=-1)
    with pytest.raises(splashdown.ParameterError, match='formats has "doc"; allowed are ply'):
        splashdown.run(scene, tmp_path, formats="ply, doc")
    with pytest.raises(splashdown.ParameterError, match='formats has "doc"; allowed are ply'):
        splashdown.run(scene, tmp_path, formats=["doc"])
    with pytest.raises(splashdown.CheckpointError, match="there is no"):
        splashdown.run(tmp_path / "nothing")
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError):
        splashdown.run(scene, tmp_path / "file" / "out", device="cpu", pictures=[])
