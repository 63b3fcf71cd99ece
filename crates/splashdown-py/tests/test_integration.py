"""Arrays in other packages."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy
import pytest
from conftest import optional

import splashdown


@pytest.fixture
def mesh(cloud: numpy.ndarray) -> splashdown.Mesh:
    return splashdown.surface(cloud, 0.1, smoothing=5, device="cpu")


def test_trimesh(mesh: splashdown.Mesh) -> None:
    trimesh = optional("trimesh")
    theirs = trimesh.Trimesh(mesh.vertices, mesh.triangles, vertex_normals=mesh.normals, process=False)
    assert theirs.is_watertight and theirs.is_winding_consistent
    assert theirs.volume == pytest.approx(mesh.volume, rel=1e-5)
    assert theirs.area == pytest.approx(mesh.area, rel=1e-5)
    # And back: trimesh has float64 and int64.
    again = splashdown.Mesh(numpy.ascontiguousarray(theirs.vertices), numpy.ascontiguousarray(theirs.faces))
    assert again.volume == pytest.approx(mesh.volume, rel=1e-5)


def test_pyvista(mesh: splashdown.Mesh, simulation: splashdown.Simulation) -> None:
    pyvista = optional("pyvista")
    simulation.advance(0.02)
    points = pyvista.PolyData(simulation.positions)
    points["velocity"] = simulation.velocities
    assert points.n_points == len(simulation) and points["velocity"].shape == (len(simulation), 3)
    assert numpy.shares_memory(points.points, simulation.positions), "pyvista copies the positions"
    theirs = pyvista.PolyData.from_regular_faces(mesh.vertices, mesh.triangles)
    assert theirs.is_manifold and theirs.volume == pytest.approx(mesh.volume, rel=1e-4)


def test_meshio(mesh: splashdown.Mesh, tmp_path: Path) -> None:
    meshio = optional("meshio")
    theirs = meshio.Mesh(mesh.vertices, [("triangle", mesh.triangles)], point_data={"normals": mesh.normals})
    theirs.write(tmp_path / "mesh.stl")
    again = splashdown.read_mesh(tmp_path / "mesh.stl")
    assert again.volume == pytest.approx(mesh.volume, rel=1e-4)
    # And what this package writes.
    splashdown.write_mesh(tmp_path / "mesh.ply", mesh)
    read = meshio.read(tmp_path / "mesh.ply")
    assert numpy.array_equal(read.points.astype(numpy.float32), mesh.vertices)


def test_pandas(scene: splashdown.Scene) -> None:
    pandas = optional("pandas")
    frames = list(splashdown.Run(scene, device="cpu", frames=3, surface=False))
    table = pandas.DataFrame([frame.stats.to_dict() for frame in frames])
    assert list(table["steps"])[0] == 0 and table["steps"].is_monotonic_increasing
    particles = frames[-1].particles
    positions = pandas.DataFrame(particles.positions, columns=["x", "y", "z"], index=particles.ids, copy=False)
    assert positions["y"].max() == particles.positions[:, 1].max()
    gauge = {"name": "gauge", "quantity": "pressure", "position": [0.0, 0.05, 0.25]}
    scene = scene.replace(probe=[gauge])
    run = list(splashdown.Run(scene, device="cpu", frames=2, surface=False))
    probe = pandas.DataFrame(run[-1].probes["gauge"], columns=scene.probe_columns["gauge"])
    assert list(probe.columns) == ["time (s)", "pressure (Pa)"] and len(probe) > 0


def test_tqdm(scene: splashdown.Scene, capfd: pytest.CaptureFixture[str]) -> None:
    optional("tqdm")
    fine = scene.replace({"fluid.particle_spacing": 0.025})
    with splashdown.Simulation(fine, device="cpu") as simulation:
        simulation.advance(0.03, progress=True)
    assert "0.030/0.030 s" in capfd.readouterr().err


def test_side_by_side() -> None:
    """The script in the guide runs, and needs no more lines than that of pySPlisHSPlasH beside it."""
    scripts = Path(__file__).parent / "side_by_side"
    ours = scripts / "splashdown_front.py"
    done = subprocess.run([sys.executable, ours], capture_output=True, text=True, check=True)
    rows = [[float(word) for word in line.split()] for line in done.stdout.splitlines()]
    assert len(rows) == 11 and rows[-1][0] == pytest.approx(0.2) and rows[-1][1] > rows[0][1] + 0.1

    def lines(path: Path) -> int:
        return sum(bool(line.strip()) for line in path.read_text().splitlines())

    assert lines(ours) <= lines(scripts / "splishsplash_front.py")


def test_pysplashsurf(simulation: splashdown.Simulation) -> None:
    """The same surface as splashsurf with the same parameters: the same number of vertices."""
    optional("pysplashsurf")
    import pysplashsurf

    simulation.advance(0.2)
    points, radius = numpy.array(simulation.positions), 0.05
    ours = splashdown.surface(points, 2 * radius, support_radius=4 * radius, cell_size=radius, device="cpu")
    theirs = pysplashsurf.reconstruct_surface(
        points, particle_radius=radius, smoothing_length=2.0, cube_size=1.0, iso_surface_threshold=0.6
    )
    assert len(theirs.mesh.vertices) == pytest.approx(len(ours.vertices), rel=0.01)
    # Control: with other cells the number differs.
    finer = splashdown.surface(points, 2 * radius, support_radius=4 * radius, cell_size=0.8 * radius, device="cpu")
    assert len(finer.vertices) > 1.2 * len(ours.vertices)
