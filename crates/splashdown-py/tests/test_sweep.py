"""Parameter studies on one machine."""

from __future__ import annotations

import hashlib
import os
import signal
import sys
import threading
import time
from pathlib import Path

import pytest
from conftest import column, optional, skip

import splashdown
from splashdown import ParameterError, SceneError, _worker

pandas = optional("pandas")


def digest(frame: splashdown.Frame) -> dict[str, object]:
    """Two numbers, and the bits of all positions."""
    positions = frame.particles.positions
    bits = hashlib.sha256(positions.tobytes()).hexdigest()
    return {"front": positions[:, 0].max(), "height": float(positions[:, 1].max()), "bits": bits}


def digest_slowly(frame: splashdown.Frame) -> dict[str, object]:
    time.sleep(0.05)
    return digest(frame)


def killed_once(frame: splashdown.Frame) -> dict[str, object]:
    """The process is killed in frame 7 of its first attempt."""
    flag = Path(os.environ["SPLASHDOWN_TEST_FLAG"])
    if frame.index == 7 and not flag.exists():
        flag.write_text("")
        os.kill(os.getpid(), signal.SIGKILL if os.name != "nt" else signal.SIGTERM)
    return digest(frame)


def always_killed(frame: splashdown.Frame) -> dict[str, object]:
    os.kill(os.getpid(), signal.SIGTERM)
    raise AssertionError("unreachable")


def broken(frame: splashdown.Frame) -> dict[str, object]:
    return {"mesh": [1, 2, 3]}


OPTIONS = {"device": "cpu", "frames": 10, "workers": 2}


def test_a_grid_with_failures(tmp_path: Path) -> None:
    changes = {"fluid.viscosity": [0.001, 0.1], "fluid.particle_spacing": [0.1, -1]}
    seen: list[tuple[int, int]] = []
    table = splashdown.sweep(
        column(), changes, digest, folder=tmp_path, progress=lambda *now: seen.append(now), **OPTIONS
    )
    assert isinstance(table, pandas.DataFrame) and len(table) == 4
    assert list(table["status"]) == ["finished", "failed", "finished", "failed"]
    assert "fluid.particle_spacing is -1" in table["reason"][1] and table["reason"][0] == ""
    assert list(table["fluid.viscosity"]) == [0.001, 0.001, 0.1, 0.1]
    assert table["front"][0] > 0.4 and table["frame"][0] == 10 and table["time"][0] == pytest.approx(0.2)
    assert seen[-1] == (4, 4)
    assert table["warnings"][0] == ""
    [uneven] = splashdown.sweep(column(), [{"fluid.particle_spacing": 0.07}], folder=tmp_path / "uneven", **OPTIONS)["warnings"]
    assert "volume than the block" in uneven and uneven.count("warning:") >= 1
    frames = pandas.read_csv(Path(table["folder"][0]) / "frames.csv")
    assert list(frames["frame"]) == list(range(11)) and frames["front"].is_monotonic_increasing
    assert frames["front"].iloc[-1] == table["front"][0]
    # A second call computes nothing again.
    before = [path.stat().st_mtime_ns for path in sorted(tmp_path.rglob("frames.csv"))]
    again = splashdown.sweep(column(), changes, digest, folder=tmp_path, **OPTIONS)
    assert [path.stat().st_mtime_ns for path in sorted(tmp_path.rglob("frames.csv"))] == before
    assert list(again["bits"][[0, 2]]) == list(table["bits"][[0, 2]])
    # Another function, or another scene, is another study.
    other = splashdown.sweep(column(), [{"fluid.viscosity": 0.001}], folder=tmp_path, **OPTIONS)
    assert "front" not in other and other["particles"][0] == 120


def test_a_lost_process_continues_from_its_checkpoint(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SPLASHDOWN_TEST_FLAG", str(tmp_path / "killed"))
    options = {**OPTIONS, "checkpoint_every": 5}
    table = splashdown.sweep(column(), [{}], killed_once, folder=tmp_path / "lost", **options)
    whole = splashdown.sweep(column(), [{}], digest, folder=tmp_path / "whole", **options)
    assert (tmp_path / "killed").exists(), "control: the process was killed"
    assert table["status"][0] == "finished", table["reason"][0]
    assert table["resumed_from"][0] == 5 and whole["resumed_from"][0] == 0
    assert table["bits"][0] == whole["bits"][0]
    rows = [(tmp_path / name / "run_0000/frames.csv").read_text() for name in ("lost", "whole")]
    assert rows[0] == rows[1]
    assert not list(tmp_path.rglob("*.splashdown")), "the checkpoint is deleted at the end"


def test_a_run_that_kills_every_process_fails_alone(tmp_path: Path) -> None:
    table = splashdown.sweep(column(), [{}], always_killed, folder=tmp_path, retries=1, **OPTIONS)
    assert table["status"][0] == "failed" and "its process was lost 2 times" in table["reason"][0]


def test_wrong_results_of_the_function(tmp_path: Path) -> None:
    table = splashdown.sweep(column(), [{}], broken, folder=tmp_path, **OPTIONS)
    assert "returned a list as 'mesh'; it must be a number or a text" in table["reason"][0]


def test_wrong_settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def sweep(**options: object) -> None:
        splashdown.sweep(column(), [{}], digest, folder=tmp_path, **options)  # type: ignore[arg-type]

    for options, message in (
        ({"engine": "threads"}, 'it must be "processes" or "ray"'),
        ({"workers": 0}, "workers is 0; it must be at least 1"),
        ({"retries": -1}, "retries is -1"),
        ({"checkpoint_every": -1}, "checkpoint_every is -1"),
        ({"ray_options": {"num_gpus": 1}}, 'ray_options is an option of engine="ray"'),
    ):
        with pytest.raises(ParameterError, match=message):
            sweep(**options)
    simulation = splashdown.Simulation(column(), device="cpu")
    with pytest.raises(ParameterError, match="keep cannot be sent to another process.*and no open files"):
        splashdown.sweep(column(), [{}], lambda frame: {"n": len(simulation)}, folder=tmp_path)
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(splashdown.MissingPackageError, match=r"pip install 'splashdown\[ray\]'"):
        sweep(engine="ray")
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(splashdown.MissingPackageError, match=r"pip install 'splashdown\[sweep\]'"):
        sweep()


def test_workers_with_another_version_or_without_the_files(tmp_path: Path) -> None:
    task = {"version": "0.0.1", "text": "", "keep": digest, "source": None}
    outcome = _worker.compute_run(task)
    assert outcome["status"] == "failed"
    assert "this worker has Splashdown" in outcome["reason"] and "0.0.1" in outcome["reason"]
    assert "install the same version" in outcome["reason"]

    (tmp_path / "points.npy").write_bytes(b"")
    sections = column().to_dict()
    sections["fluid"]["file"] = [{"file": "points.npy"}]
    text = splashdown.Scene(sections).text
    path = tmp_path / "scene.toml"
    task = {
        "version": splashdown.__version__, "text": text, "name": "scene", "source": str(path), "keep": digest,
        "folder": str(tmp_path / "run"), "key": "", "device": "cpu", "frames": 1, "surface": False, "foam": False,
        "checkpoint_every": 0,
    }
    (tmp_path / "points.npy").unlink()
    with pytest.raises(SceneError):
        splashdown.Scene._restore(text, "scene", path)
    outcome = _worker.compute_run(task)
    assert "points.npy" in outcome["reason"] and "under the same paths" in outcome["reason"]


def test_the_frames_of_a_run(tmp_path: Path) -> None:
    splashdown.run(column(), tmp_path / "out", frames=3, formats=["npz"], pictures=[], surface=False, device="cpu")
    # The files contain the particle spacing.
    job = splashdown.ReconstructSurface(tmp_path / "mesh", smoothing=5, device="cpu")
    table = splashdown.map_frames(tmp_path / "out/particles/*.npz", job, workers=2)
    assert list(table["status"]) == ["finished"] * 4
    assert all(splashdown.read_mesh(path).is_watertight for path in table["mesh"])
    (tmp_path / "broken.npz").write_bytes(b"nothing")
    table = splashdown.map_frames([tmp_path / "broken.npz"], job, workers=1)
    assert table["status"][0] == "failed" and "broken.npz" in table["reason"][0]
    last = splashdown.read_particles(tmp_path / "out/particles/particles_0003.npz")
    splashdown.write_particles(tmp_path / "bare.npz", splashdown.Particles(last.positions))
    table = splashdown.map_frames([tmp_path / "bare.npz"], job, workers=1)
    assert table["status"][0] == "failed" and "give particle_spacing" in table["reason"][0]
    given = job._replace(particle_spacing=0.1)
    assert splashdown.map_frames([tmp_path / "bare.npz"], given, workers=1)["status"][0] == "finished"
    with pytest.raises(ParameterError, match="no file matches"):
        splashdown.map_frames(tmp_path / "*.none", job)


def test_the_pictures_of_a_finished_run(tmp_path: Path) -> None:
    """They are those that the run draws, with a floating crate and foam."""
    pyplot = optional("matplotlib.pyplot")
    scene = splashdown.Scene(
        scene={"name": "wave", "duration": 0.4, "frame_rate": 20},
        domain={"min": [0, 0, 0], "max": [1.6, 1.0, 0.5]},
        fluid={"particle_spacing": 0.05, "block": [{"position": [0, 0, 0], "size": [0.4, 0.8, 0.5]}]},
        body=[{"name": "crate", "mesh": "cube", "scale": 0.2, "position": [0.9, 0.15, 0.25], "motion": "dynamic", "density": 400}],
        foam={"enabled": True},
        output={"picture_size": [320, 180]},
    )
    try:
        splashdown.Painter(scene)
    except splashdown.DeviceError as error:
        assert os.environ.get("CI") != "true", error
        skip(f"pictures cannot be drawn, they need a Vulkan driver: {error}")
    out = tmp_path / "out"
    kinds = {"surface": "mesh", "particles": "particles"}
    splashdown.run(scene, out, formats=["ply"], pictures=list(kinds), film=False, device="cpu")

    def draw(kind: str, drawn: splashdown.Scene, frames: str) -> tuple[list[str], list[str], list[object]]:
        """The status and the reason of frames, and their pictures."""
        job = splashdown.DrawPicture(tmp_path / "drawn", drawn, kind)
        table = splashdown.map_frames(out / kinds[kind] / f"{kind}_{frames}.ply", job, workers=1)
        finished = table[table["status"] == "finished"]
        pictures = [pyplot.imread(path) for path in finished["picture"]] if len(finished) else []
        return list(table["status"]), list(table["reason"]), pictures

    def deviation(one: object, other: object) -> float:
        return abs(one - other).mean()

    for kind in kinds:
        status, reasons, drawn = draw(kind, scene, "*")
        assert status == ["finished"] * 9, reasons
        of_run = [pyplot.imread(out / f"pictures/{kind}_{frame:04}.png") for frame in range(9)]
        largest = max(deviation(one, other) for one, other in zip(drawn, of_run))
        # Surfaces are shaded with other normals, which changes colours but no edges.
        frames_differ = deviation(drawn[0], drawn[8])
        assert largest <= (0 if kind == "particles" else frames_differ / 4), (kind, largest, frames_differ)
        # Controls: a picture without the crate, or without foam, is another one.
        sections = scene.to_dict()
        del sections["body"]
        for other in (splashdown.Scene(sections), scene.replace({"foam.enabled": False})):
            assert deviation(draw(kind, other, "0008")[2][0], drawn[8]) > 1e-4

    # The same picture from memory.
    *_, last = splashdown.Run(scene, device="cpu", frames=8, surface=False)
    painter = splashdown.Painter(scene, "particles")
    painter.write(tmp_path / "last.png", last)
    assert (tmp_path / "last.png").read_bytes() == (out / "pictures/particles_0008.png").read_bytes()

    # Files that are missing are the reason of the row.
    for missing, reason in (("bodies/crate.csv", 'the place of body "crate" is unknown'), ("particles/foam_0008.ply", "disable the foam")):
        (out / missing).rename(tmp_path / "away")
        [status], [text], _ = draw("surface", scene, "0008")
        assert status == "failed" and Path(missing).stem in text and reason in text
        (tmp_path / "away").rename(out / missing)

    # Surfaces by the same mechanism.
    job = splashdown.ReconstructSurface(tmp_path / "mesh", 0.05, device="cpu")
    table = splashdown.map_frames(out / "particles/particles_*.ply", job, workers=2)
    assert list(table["status"]) == ["finished"] * 9
    mesh, of_run = (splashdown.read_mesh(path) for path in (table["mesh"][8], out / "mesh/surface_0008.ply"))
    assert mesh.is_watertight and mesh.volume == pytest.approx(of_run.volume, rel=0.05)


def test_wrong_pictures() -> None:
    try:
        painter = splashdown.Painter(column(), "surface")
    except splashdown.DeviceError as error:
        assert os.environ.get("CI") != "true", error
        skip(f"pictures cannot be drawn, they need a Vulkan driver: {error}")
    frame = next(splashdown.Run(column(), device="cpu", surface=False))
    post = {"name": "post", "mesh": "cube", "scale": 0.2, "position": [1, 0.2, 0.25]}
    bodies = splashdown.Simulation(column().replace(body=[post]), device="cpu").bodies
    mesh = splashdown.Simulation(column(), device="cpu").surface()
    for what, options, message in (
        (frame.particles, {}, "this painter draws surfaces"),
        (frame, {}, "this frame has no surface"),
        (mesh, {"bodies": bodies}, r"bodies are \[\"post\"\], and those of the painter's scene are \[\]"),
        (frame, {"bodies": bodies}, r"bodies are .* painter's scene"),
        ("surface_0001.ply", {}, "surface_0001.ply"),
    ):
        with pytest.raises(splashdown.Error, match=message):
            painter.draw(what, **options)
    with pytest.raises(splashdown.ArrayError, match="a painter draws a Frame, a Mesh, Particles or the path of a file, not a int"):
        painter.draw(3)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match='kind has "film"; allowed are'):
        splashdown.Painter(column(), "film")  # type: ignore[arg-type]


def test_a_ray_cluster_that_loses_a_node(tmp_path: Path) -> None:
    """Two nodes compute four runs; one of them is killed in the middle. Its run continues on the other."""
    optional("ray")
    import ray
    from ray.cluster_utils import Cluster

    whole = splashdown.sweep(column(), {"fluid.viscosity": [0.001, 0.1]}, digest, folder=tmp_path / "whole", **OPTIONS)
    # A lost node is detected after a second instead of half a minute.
    health = {"health_check_initial_delay_ms": 500, "health_check_period_ms": 500, "health_check_failure_threshold": 2}
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 0, "_system_config": health})
    nodes = [cluster.add_node(num_cpus=1) for _ in range(2)]
    ray.init(address=cluster.address, log_to_driver=False, runtime_env={"env_vars": {"PYTHONPATH": str(Path(__file__).parent)}})
    killed: list[str] = []

    def kill() -> None:
        """Kills a node as soon as both runs have a checkpoint."""
        deadline = time.monotonic() + 120
        while time.monotonic() < deadline:
            if len(list((tmp_path / "ray").rglob("*.splashdown"))) == 2:
                cluster.remove_node(nodes[0], allow_graceful=False)
                killed.append(nodes[0].node_id)
                return
            time.sleep(0.01)

    try:
        killer = threading.Thread(target=kill)
        killer.start()
        table = splashdown.sweep(
            column(), {"fluid.viscosity": [0.001, 0.1]}, digest_slowly, folder=tmp_path / "ray", engine="ray",
            device="cpu", frames=40, checkpoint_every=2, retries=3,
        )
        killer.join()
    finally:
        ray.shutdown()
        cluster.shutdown()
    assert killed, "control: a node was killed"
    assert list(table["status"]) == ["finished"] * 2, list(table["reason"])
    assert (table["resumed_from"] > 0).sum() == 1, list(table["resumed_from"])
    uninterrupted = splashdown.sweep(
        column(), {"fluid.viscosity": [0.001, 0.1]}, digest, folder=tmp_path / "long", device="cpu", frames=40, workers=2
    )
    assert list(table["bits"]) == list(uninterrupted["bits"])
    assert list(table["bits"]) != list(whole["bits"]), "control: the bits differ at another time"
