"""Tests of the state machine of a bake, with a program that plays a script. They need no Blender."""

import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import zipfile
from pathlib import Path
from contextlib import redirect_stderr
from io import StringIO

BLENDER = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(BLENDER), str(BLENDER / "splashdown")]

from core import job, lock, program, run_folder, scene, simulation
from core.simulation import Failed, Simulation

CHECK = {"event": "check", "particles": 10}
STARTED = {"event": "started", "frames": 4, "frame": 0}
FRAME = {"event": "frame", "frame": 1, "time": 0.1}
FILES = {"scene.toml": f"{scene.HEADER} SI units\n".encode(), "meshes/a.ply": b"ply"}


class FakeJob:
    """Plays one script for each start: a list of events, an exit code, and what it prints besides."""

    scripts = []

    def __init__(self, command, folder):
        self.command, self.folder = command, Path(folder)
        self.events, self.code, self.words = FakeJob.scripts.pop(0)
        self.written = {path.name for path in self.folder.iterdir()}
        self.calls = []

    def poll(self):
        events, self.events = self.events, []
        return events, self.code

    def stop(self):
        self.calls.append("stop")

    def kill(self):
        self.calls.append("kill")

    def try_wait(self, _seconds):
        return True

    def tail(self):
        return self.words


class Recorded(Simulation):
    """Counts the calls of the front end; one of them may raise."""

    job_type = FakeJob
    raises = None

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        self.calls = []

    def _call(self, name):
        self.calls.append(name)
        if self.raises == name:
            raise RuntimeError("Cannot add vertices in edit mode")

    def on_started(self):
        self._call("started")

    def on_frame(self):
        self._call("frame")

    def on_end(self):
        self._call("end")


class Machine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def start(self, *scripts, only_check=False, names=None, limit=1000, raises=None):
        FakeJob.scripts = [(events, code, words) for events, code, words in scripts]
        made = Recorded(
            "splashdown",
            None if only_check else self.folder,
            device="cpu",
            checkpoint_every=10,
            limit=limit,
            spacing=0.1,
            frame_rate=24,
            names=names,
        )
        made.raises = raises
        made.check(FILES)
        return made

    def finish(self, made):
        for _ in range(10):
            if not made.update():
                return made
        self.fail("the simulation does not end")

    def test_a_bake_checks_and_then_runs(self):
        made = self.finish(self.start(([CHECK], 0, ""), ([STARTED, FRAME], 0, "")))
        self.assertEqual((made.state, made.fraction, made.messages), ("FINISHED", 1.0, []))
        self.assertEqual(made.calls, ["started", "frame", "end"])
        self.assertEqual((self.folder / "scene.toml").read_bytes(), FILES["scene.toml"])
        self.assertEqual((self.folder / "meshes/a.ply").read_bytes(), b"ply")

    def test_a_check_does_not_touch_the_cache(self):
        made = self.start(([CHECK], 0, ""), only_check=True)
        checked = made.job.folder
        self.assertIn("scene.toml", made.job.written)
        self.assertEqual(self.finish(made).state, "CHECKED")
        self.assertEqual(list(self.folder.iterdir()), [])
        self.assertFalse(checked.exists())

    def test_a_failed_check_does_not_touch_the_cache(self):
        made = self.finish(self.start(([], 3, "no")))
        self.assertEqual((made.state, list(self.folder.iterdir())), ("FAILED", []))

    def test_success_needs_the_events_of_a_check_and_a_run(self):
        self.assertEqual(self.finish(self.start(([], 0, ""))).state, "FAILED")
        made = self.finish(self.start(([CHECK], 0, ""), ([], 0, "")))
        self.assertEqual((made.state, made.calls), ("FAILED", []))

    def test_a_refused_number_of_particles_stays_a_failure(self):
        made = self.finish(self.start(([{**CHECK, "emitted": 5000}], 0, ""), limit=1000))
        self.assertEqual(made.state, "FAILED")
        self.assertIn("5,010 particles", made.errors[0])
        self.assertEqual(made.job.calls, ["kill"])

    def test_a_cancel_when_the_check_has_just_ended_stops(self):
        made = self.start(([CHECK], 0, ""), only_check=False)
        made.cancel()
        self.assertEqual(self.finish(made).state, "STOPPED")
        self.assertEqual(made.text(), "Stopped before the first frame")

    def test_a_cancelled_run_stops_and_a_complete_one_is_finished(self):
        for code, state in ((130, "STOPPED"), (0, "FINISHED"), (-signal.SIGTERM, "STOPPED")):
            made = self.start(([CHECK], 0, ""), ([STARTED], None, ""))
            made.update()
            made.update()
            made.cancel()
            self.assertEqual((made.state, made.job.calls), ("STOPPING", ["stop"]))
            made.cancel()
            self.assertEqual(made.job.calls, ["stop", "kill"])
            made.job.code = code
            self.assertEqual(self.finish(made).state, state)
            self.assertEqual(made.calls, ["started", "end"])

    def test_an_exception_of_the_front_end_ends_the_program(self):
        for name in ("started", "frame", "end"):
            made = self.start(([CHECK], 0, ""), ([STARTED, FRAME], 0, ""), raises=name)
            output = StringIO()
            with redirect_stderr(output):
                self.finish(made)
            self.assertEqual((made.state, made.job.calls), ("FAILED", ["kill"]))
            self.assertIn("Cannot add vertices in edit mode", made.errors[-1])
            self.assertIn("Traceback", output.getvalue())
            self.assertEqual(made.calls[-1], name)

    def test_a_failed_run_is_shown_and_its_error_is_not_hidden_by_a_warning(self):
        warning = {"event": "warning", "message": "small"}
        made = self.finish(self.start(([CHECK], 0, ""), ([STARTED, warning], 5, "error: the device is lost")))
        self.assertEqual(made.errors, ["the device is lost", "The program ended with exit code 5."])
        self.assertEqual(made.warnings, ["small"])
        self.assertEqual(made.calls, ["started", "end"])

    def test_the_signal_of_a_killed_program_is_named(self):
        made = self.finish(self.start(([CHECK], 0, ""), ([STARTED], -9, "")))
        self.assertIn("SIGKILL", made.errors[-1])
        self.assertIn("memory", made.errors[-1])

    def test_messages_name_the_users_objects_once(self):
        text = "fluid.block[0] is 1.5 spacings long"
        checked = {"message": text, "given": "0.1", "allowed": None, "hint": "use multiples", "text": "x = 1"}
        printed = f"{text}\n --> scene.toml:9:20\n9 | x = 1\n  |     ^\n  = help: use multiples"
        events = [STARTED, {"event": "warning", "message": printed}]
        made = self.start(([{**CHECK, "warnings": [checked]}], 0, ""), (events, 0, ""), names={"fluid.block[0]": 'fluid "Pool"'})
        self.finish(made)
        self.assertEqual(made.warnings, ['fluid "Pool" is 1.5 spacings long\nuse multiples'])

    def test_problems_of_a_scene_are_shown_without_its_lines(self):
        problem = {"message": "it is outside", "allowed": "0 to 1 m", "hint": "move it"}
        event = {"event": "error", "message": "error: it is outside\n --> scene.toml:1:2", "problems": [problem]}
        made = self.finish(self.start(([event], 3, "error: it is outside")))
        self.assertEqual(made.errors[0], "it is outside\nallowed: 0 to 1 m\nmove it")
        self.assertEqual(len(made.errors), 2)

    def test_a_scene_of_the_user_is_not_overwritten(self):
        path = self.folder / "scene.toml"
        path.write_text("# mine\n")
        with self.assertRaisesRegex(Failed, "not written by this extension"):
            self.start(([CHECK], 0, ""))
        self.assertEqual(path.read_text(), "# mine\n")
        # That of an earlier bake is.
        path.write_text(f"{scene.HEADER}\n")
        self.assertEqual(self.finish(self.start(([CHECK], 0, ""), ([STARTED], 0, ""))).state, "FINISHED")
        # One that appears during the check is not, either.
        made = self.start(([CHECK], 0, ""), ([STARTED], 0, ""))
        path.write_text("# mine\n")
        self.assertEqual(self.finish(made).state, "FAILED")
        self.assertEqual(path.read_text(), "# mine\n")

    @unittest.skipUnless(lock.fcntl, "this test takes the lock as the program does on Unix")
    def test_the_scene_of_a_running_bake_is_not_overwritten(self):
        run = self.folder / "run"
        run.mkdir()
        path = self.folder / "scene.toml"
        path.write_text(f"{scene.HEADER}\n# the other one\n")
        descriptor = os.open(run, os.O_RDONLY)
        try:
            lock.fcntl.flock(descriptor, lock.fcntl.LOCK_EX)
            with self.assertRaisesRegex(Failed, "Another simulation writes"):
                self.start(([CHECK], 0, ""))
            with self.assertRaisesRegex(Failed, "Another simulation writes"):
                simulation.refuse_resume(run)
        finally:
            os.close(descriptor)
        self.assertFalse(lock.is_locked(run))
        self.assertIn("the other one", path.read_text())

    def test_a_run_without_a_checkpoint_and_a_finished_one_cannot_be_resumed(self):
        run = self.folder / "run"
        with self.assertRaisesRegex(Failed, "no checkpoint"):
            simulation.refuse_resume(run)
        (run / "checkpoints").mkdir(parents=True)
        for number in (8, 10):
            with zipfile.ZipFile(run / f"checkpoints/checkpoint_{number:04}.splashdown", "w") as archive:
                archive.writestr("scene.toml", f"[scene]\nframe_rate = {number}\n")
        simulation.refuse_resume(run)
        self.assertEqual(run_folder.scene_of(run), {"scene": {"frame_rate": 10}})
        (run / "run.json").write_text('{"status": "finished"}')
        with self.assertRaisesRegex(Failed, "is finished"):
            simulation.refuse_resume(run)


class Program(unittest.TestCase):
    def test_the_version_of_the_program_must_fit(self):
        original = program.version
        self.addCleanup(setattr, program, "version", original)
        ours = program.extension_version()
        major, minor, _ = ours.split(".")
        for version, fits in ((ours, True), (f"{major}.{minor}.99", True), (f"{major}.{int(minor) + 1}.0", False)):
            program.version = lambda _path, version=version: version
            if fits:
                program.require("splashdown")
            else:
                with self.assertRaisesRegex(program.ProgramError, "install the same version"):
                    program.require("splashdown")

    def test_paths_are_absolute(self):
        self.assertEqual(program.candidates("~/x")[0], os.path.join(os.path.expanduser("~"), "x"))
        self.assertTrue(os.path.isabs(program.candidates("bin/x")[0]))

    @unittest.skipUnless(sys.platform == "linux", "only Linux ends a program with its parent")
    def test_the_program_ends_when_its_parent_is_killed(self):
        code = (
            f"import sys, time; sys.path[:0] = [{str(BLENDER / 'splashdown')!r}]\n"
            "from core.job import Job\n"
            "job = Job([sys.executable, '-c', 'import time; time.sleep(60)'], '.')\n"
            "print(job.pid, flush=True); time.sleep(60)"
        )
        parent = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        child = int(parent.stdout.readline())
        self.addCleanup(parent.stdout.close)
        # The launcher is Python as well: it becomes the program in a moment.
        end = time.monotonic() + 10
        while b"PDEATHSIG" in Path(f"/proc/{child}/cmdline").read_bytes():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)
        parent.kill()
        parent.wait()
        end = time.monotonic() + 10
        while self.is_running(child):
            self.assertLess(time.monotonic(), end, "the program goes on")
            time.sleep(0.02)

    def is_running(self, pid):
        try:
            return Path(f"/proc/{pid}/stat").read_text().split()[2] != "Z"
        except FileNotFoundError:
            return False

    def test_elsewhere_the_program_is_started_directly(self):
        original = job.sys.platform
        self.addCleanup(setattr, job.sys, "platform", original)
        job.sys.platform = "darwin"
        self.assertEqual(job.bound_to_parent(["a", "b"]), ["a", "b"])


if __name__ == "__main__":
    unittest.main()
