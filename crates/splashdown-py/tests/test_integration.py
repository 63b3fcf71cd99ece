"""Arrays in other packages."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy
import pytest
from conftest import optional, skip

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
    # Long enough that the progress is shown.
    fine = scene.replace({"fluid.particle_spacing": 0.025, "solver.method": "wcsph"})
    with splashdown.Simulation(fine, device="cpu") as simulation:
        simulation.advance(0.1, progress=True)
    assert "0.100/0.100 s" in capfd.readouterr().err


SIDE_BY_SIDE = Path(__file__).parent / "side_by_side"


def fronts(name: str, folder: Path, **environment: str) -> list[tuple[float, float]]:
    """The times (s) and fronts (m) that a script prints."""
    script, env = [sys.executable, SIDE_BY_SIDE / name], {**os.environ, **environment}
    done = subprocess.run(script, capture_output=True, text=True, cwd=folder, env=env, check=False)
    assert done.returncode == 0, f"{name}: {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}"
    # pySPlisHSPlasH also prints its timings.
    rows = re.findall(r"^([\d.e-]+) ([\d.]+)$", done.stdout, re.MULTILINE)
    return [(float(time), float(front)) for time, front in rows]


def test_side_by_side(tmp_path: Path) -> None:
    """The scripts in the guide: the same dam break here and in pySPlisHSPlasH, in the same number of lines or fewer."""
    ours = fronts("splashdown_front.py", tmp_path)
    assert len(ours) == 11 and ours[-1][0] == pytest.approx(0.2) and ours[-1][1] > ours[0][1] + 0.1

    def lines(name: str) -> int:
        return sum(bool(line.strip()) for line in (SIDE_BY_SIDE / name).read_text().splitlines())

    assert lines("splashdown_front.py") <= lines("splishsplash_front.py")
    # Its import ends the process on some systems, unless the system's GL library is loaded first.
    preload = {"LD_PRELOAD": "libGL.so.1"} if sys.platform == "linux" else {}
    code = [sys.executable, "-c", "import pysplishsplash"]
    imported = subprocess.run(code, capture_output=True, text=True, env={**os.environ, **preload}, check=False)
    if imported.returncode != 0:
        reason = imported.stderr.strip().splitlines()[-1:] or [f"exit code {imported.returncode}"]
        skip(f"the script of pySPlisHSPlasH cannot run: {reason[0]}")
    theirs = fronts("splishsplash_front.py", tmp_path, **preload)
    assert len(theirs) == 11
    # Two particle spacings: at 8 particles per block length both fronts are a particle's centre.
    for (time, front), (their_time, their_front) in zip(ours, theirs):
        assert their_time == pytest.approx(time, abs=0.01) and their_front == pytest.approx(front, abs=0.1)
    # Control: the fronts move further than that.
    assert theirs[-1][1] > theirs[0][1] + 0.2 and ours[-1][1] > ours[0][1] + 0.2


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
