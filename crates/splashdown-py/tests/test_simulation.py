"""Simulations and runs."""

from __future__ import annotations

import gc
import os
import signal
import sys
import threading
import time
import weakref
from pathlib import Path

import numpy
import pytest
from conftest import column, skip

import splashdown
from splashdown import ArrayError, ClosedError, ParameterError, Run, Simulation


def test_arrays_are_views_without_a_copy(simulation: Simulation) -> None:
    simulation.advance(0.01)
    positions = simulation.positions
    n = simulation.stats.particles
    assert positions.shape == (n, 3) and positions.dtype == numpy.float32 and positions.flags.c_contiguous
    assert not positions.flags.owndata and not positions.flags.writeable
    # The same memory, not equal copies.
    again = simulation.positions
    assert numpy.shares_memory(positions, again)
    assert (simulation.ids == numpy.arange(n)).all()
    assert simulation.densities.shape == simulation.pressures.shape == (n,)
    assert abs(simulation.densities.mean() / 1000 - 1) < 0.1


def test_implicit_pressure_reports_its_iterations() -> None:
    explicit = Simulation(column(solver={"method": "wcsph"}), device="cpu").advance(0.05)
    implicit = Simulation(column(solver={"method": "dfsph"}), device="cpu").advance(0.05)
    assert 0 < implicit.steps < explicit.steps / 4, (implicit, explicit)
    assert explicit.iterations == 0 < implicit.most_iterations <= implicit.iterations
    assert implicit.unconverged == 0 <= implicit.residual <= 1e-3, implicit
    assert 0 < implicit.mean_compression < 0.01, implicit


def test_implicit_viscosity_reports_its_iterations() -> None:
    scene = column(solver={"method": "dfsph"})
    thin = Simulation(scene, device="cpu").advance(0.05)
    thick = Simulation(scene.replace({"fluid.viscosity": 1.0}), device="cpu").advance(0.05)
    assert thin.viscous_iterations == 0 < thick.most_viscous_iterations <= thick.viscous_iterations
    assert thick.viscous_unconverged == 0 <= thick.viscous_residual <= 0.02, thick


def test_arrays_outlive_the_simulation(simulation: Simulation) -> None:
    before = simulation.positions
    copy = before.copy()
    simulation.advance(0.1)
    assert not numpy.array_equal(simulation.positions, copy), "control: the particles move"
    particles = simulation.particles
    alive = weakref.ref(before)
    simulation.close()
    del simulation
    gc.collect()
    assert numpy.array_equal(before, copy) and len(particles) == len(copy)
    assert alive() is before


@pytest.mark.parametrize("device", ["cpu", "llvmpipe"])
def test_writing_motion(device: str) -> None:
    # With short steps, so that the fall is accurate.
    scene = column(solver={"method": "wcsph"})
    try:
        simulation = Simulation(scene, device=device)
    except splashdown.DeviceError as error:
        assert os.environ.get("CI") != "true", error
        skip(f"there is no device {device!r}: {error}")
    simulation.advance(0.01)
    moved = simulation.positions + numpy.float32([0.5, 0.2, 0])
    simulation.positions = moved
    assert numpy.array_equal(simulation.positions, moved)
    velocities = numpy.zeros_like(moved)
    velocities[:, 0] = 0.3
    simulation.velocities = velocities.astype(numpy.float64)
    assert numpy.array_equal(simulation.velocities, velocities)
    simulation.advance(0.05)
    fall = moved[:, 1].mean() - simulation.positions[:, 1].mean()
    assert fall == pytest.approx(0.5 * 9.81 * 0.05**2, abs=2e-3)
    assert simulation.positions[:, 0].mean() - moved[:, 0].mean() == pytest.approx(0.015, abs=2e-3)
    # Writing back what was read is allowed.
    simulation.positions = simulation.positions


N = 120


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (numpy.zeros((N - 1, 3), numpy.float32), "119 positions are given, but there are 120 particles"),
        (numpy.zeros((3, N), numpy.float32), "positions has shape (3, 120); (N, 3) is needed: use numpy.ascontiguous"),
        (numpy.zeros(3 * N, numpy.float32), "use positions.reshape(-1, 3)"),
        (numpy.zeros((N, 3), numpy.int64), "positions has dtype int64; float32 (or float64) is needed"),
        (numpy.zeros((N, 3), numpy.complex64), "positions has dtype complex64"),
        (numpy.zeros((N, 3), ">f4"), "positions has dtype >f4"),
        (numpy.full((N, 3), None), "positions has dtype object"),
        (numpy.zeros((N, 3), numpy.float32, order="F"), "not C-contiguous"),
        (numpy.zeros((2 * N, 3), numpy.float32)[::2], "not C-contiguous"),
        (numpy.broadcast_to(numpy.float32([0.1, 0.1, 0.1]), (N, 3)), "its elements share memory"),
        (numpy.full((N, 3), numpy.nan, numpy.float32), "positions[0, 0] is not a finite 32-bit number"),
        (numpy.full((N, 3), 1e300), "positions[0, 0] is not a finite 32-bit number"),
        (numpy.full((N, 3), 9, numpy.float32), "position 0 is (9, 9, 9) m, outside the domain"),
        ([[0.0, 0.0, 0.0]] * N, "positions is a list; a NumPy array of shape (N, 3) is needed"),
        (None, "positions is a NoneType"),
    ],
)
def test_wrong_arrays(simulation: Simulation, value: object, message: str) -> None:
    before = simulation.positions
    with pytest.raises(ArrayError) as error:
        simulation.positions = value  # type: ignore[assignment]
    assert message in str(error.value)
    assert numpy.array_equal(simulation.positions, before)


def test_arrays_that_share_memory(simulation: Simulation) -> None:
    with pytest.raises(ArrayError, match="velocities and the positions of this simulation share memory"):
        simulation.velocities = simulation.positions
    simulation.velocities = numpy.zeros_like(simulation.positions)
    array = numpy.zeros((10, 3), numpy.float32)
    with pytest.raises(ArrayError, match="velocities and positions share memory.*velocities.copy()"):
        splashdown.Particles(array, velocities=array)
    with pytest.raises(ArrayError, match="share memory"):
        splashdown.Particles(array[:6], velocities=array[4:])
    splashdown.Particles(array[:5], velocities=array[5:])
    faces = numpy.zeros((1, 3), numpy.uint32)
    with pytest.raises(ArrayError, match="normals and vertices share memory"):
        splashdown.Mesh(array, faces, normals=array)


def test_wrong_meshes_and_particles(cloud: numpy.ndarray) -> None:
    with pytest.raises(ArrayError, match="velocities"):
        splashdown.Particles(cloud, velocities=cloud[:5].copy())
    with pytest.raises(ArrayError, match=r"ids has dtype float32; integers are needed"):
        splashdown.Particles(cloud, ids=cloud[:, 0].copy())  # type: ignore[arg-type]
    with pytest.raises(ArrayError, match=r"ids.flat\[0\] is -1: give integers from 0"):
        splashdown.Particles(cloud[:1], ids=numpy.array([-1]))
    with pytest.raises(ArrayError, match="vertex 3"):
        splashdown.Mesh(cloud[:3], numpy.array([[0, 1, 3]]))


def test_closed(scene: splashdown.Scene) -> None:
    with Simulation(scene, device="cpu") as simulation:
        assert not simulation.closed
    assert simulation.closed and repr(simulation) == "Simulation(closed)"
    simulation.close()
    for use in (lambda: simulation.advance(0.1), lambda: simulation.positions, simulation.checkpoint):
        with pytest.raises(ClosedError, match="this simulation is closed: create another one"):
            use()
    with Run(scene, device="cpu", frames=1) as run:
        pass
    with pytest.raises(ClosedError, match="this run is closed"):
        next(run)


def test_wrong_parameters(scene: splashdown.Scene, simulation: Simulation) -> None:
    for dt in (-1.0, float("nan"), float("inf")):
        with pytest.raises(ParameterError, match="give a finite number of seconds"):
            simulation.advance(dt)
    with pytest.raises(TypeError):
        simulation.advance("1")  # type: ignore[arg-type]
    with pytest.raises(splashdown.DeviceError, match="no-such-adapter"):
        Simulation(scene, device="no-such-adapter")
    with pytest.raises(ParameterError, match="device is empty"):
        Simulation(scene, device="")
    with pytest.raises(TypeError, match="progress is 3"):
        simulation.advance(0.1, progress=3)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="frames is -1; it must be a whole number from 0"):
        Run(scene, device="cpu", frames=-1)
    with pytest.raises(ParameterError, match="the scene has no body"):
        simulation.body_mesh("ship")


def slow() -> splashdown.Scene:
    """14,000 particles: a second of simulated time takes minutes."""
    return column(**{"fluid.particle_spacing": 0.02})


def test_an_interrupt_ends_a_frame_cleanly() -> None:
    simulation = Simulation(slow(), device="cpu")
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        simulation.advance(100)
    assert time.monotonic() - begun < 20
    assert 0 < simulation.time < 100 and simulation.stats.steps > 0
    assert numpy.isfinite(simulation.positions).all()
    stopped = simulation.time
    simulation.advance(0.001)
    assert simulation.time == pytest.approx(stopped + 0.001, abs=1e-5)


def test_a_callback_may_raise_and_must_not_reenter() -> None:
    simulation = Simulation(slow(), device="cpu")

    def reenter(progress: splashdown.Progress) -> None:
        assert 0 <= progress.time <= progress.duration == 100
        with pytest.raises(RuntimeError, match="this simulation is in use"):
            simulation.advance(1)
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        simulation.advance(100, progress=reenter)
    assert simulation.time > 0


def test_the_interpreter_lock_is_released() -> None:
    simulation = Simulation(slow(), device="cpu")
    other = threading.Thread(target=simulation.advance, args=(0.02,))
    counted, longest, last = 0, 0.0, time.monotonic()
    other.start()
    while other.is_alive():
        counted += 1
        now = time.monotonic()
        longest, last = max(longest, now - last), now
        time.sleep(0.001)
    assert counted > 10 and longest < 1.0, (counted, longest)


def test_a_run(scene: splashdown.Scene) -> None:
    gauge = {"name": "gauge", "quantity": "pressure", "position": [0.0, 0.05, 0.25]}
    scene = scene.replace(probe=[gauge])
    frames = list(Run(scene, device="cpu", frames=3))
    assert [frame.index for frame in frames] == [0, 1, 2, 3]
    assert frames[3].time == pytest.approx(0.06)
    assert all(frame.mesh is not None and frame.mesh.is_watertight for frame in frames)
    assert frames[2].probes["gauge"].shape[1] == len(scene.probe_columns["gauge"]) == 2
    volume = frames[0].volume
    assert volume is not None and volume == pytest.approx(0.4 * 0.6 * 0.5, rel=0.4)


def test_the_probe_of_a_body(scene: splashdown.Scene) -> None:
    ball = {"name": "ball", "mesh": "sphere", "scale": 0.3, "position": [0.8, 0.8, 0.25]}
    ball |= {"motion": "dynamic", "density": 500}
    probe = {"name": "motion", "quantity": "body", "body": "ball"}
    scene = scene.replace(body=[ball], probe=[probe])
    simulation = Simulation(scene, device="cpu")
    simulation.advance(0.02)
    rows = simulation.take_probes()["motion"]
    columns = scene.probe_columns["motion"]
    assert rows.shape[1] == len(columns) == 20 and len(rows) > 0
    # It falls freely, and the last row is its state.
    speed = rows[-1][columns.index("velocity y (m/s)")]
    assert speed == pytest.approx(-9.81 * rows[-1][0], rel=1e-3)
    assert rows[-1][1:4] == pytest.approx(simulation.bodies[0].position, abs=1e-6)


def test_a_resumed_run_has_the_same_bits(scene: splashdown.Scene, tmp_path: Path) -> None:
    whole = list(Run(scene, device="cpu", frames=4, surface=False))
    run = Run(scene, device="cpu", frames=4, surface=False)
    for frame in run:
        if frame.index == 2:
            break
    run.checkpoint().write(tmp_path / "state.splashdown")
    rest = list(Run.resume(tmp_path / "state.splashdown", device="cpu", frames=4, surface=False))
    assert [frame.index for frame in rest] == [3, 4]
    assert rest[-1].particles.positions.tobytes() == whole[-1].particles.positions.tobytes()
    assert whole[-1].particles.positions.tobytes() != whole[-2].particles.positions.tobytes()


def test_wrong_checkpoints(tmp_path: Path) -> None:
    with pytest.raises(splashdown.CheckpointError):
        Simulation.resume(tmp_path / "missing.splashdown")
    (tmp_path / "wrong.splashdown").write_bytes(b"text")
    with pytest.raises(splashdown.CheckpointError, match="not a usable checkpoint"):
        splashdown.Checkpoint.read(tmp_path / "wrong.splashdown")
    with pytest.raises(TypeError):
        Simulation.resume(3)  # type: ignore[arg-type]


def test_particles_replace_the_fluid(scene: splashdown.Scene) -> None:
    points = numpy.float32([[0.5, 0.5, 0.25], [0.6, 0.5, 0.25]])
    simulation = Simulation(scene, device="cpu", particles=splashdown.Particles(points))
    assert len(simulation) == 2 and numpy.array_equal(simulation.positions, points)
    with pytest.raises(ArrayError, match=r"position 1 is \(0.5, 9, 0.25\) m, outside the domain"):
        points[1] = [0.5, 9, 0.25]
        Simulation(scene, device="cpu", particles=splashdown.Particles(points))
    with pytest.raises(ArrayError, match="there are no particles"):
        Simulation(scene, device="cpu", particles=splashdown.Particles(points[:0]))
