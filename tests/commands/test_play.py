"""./tress play without a browser: its server, its commands, and what it refuses."""

import base64
import contextlib
import http.client
import json
import os
import re
import shlex
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from page_commands import page_commands

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/release/experiments/simulate"

MODULUS, RADIUS, LENGTH = 3.9e9, 40e-6, 0.05  # Pa, m, m
BENDING = MODULUS * 3.141592653589793 / 4 * RADIUS**4  # EI, N m^2
SCENE = f"""title = "a cantilever without weight"
duration_s = 0.02
frames_per_s = 500
[model]
id = "der"
[integrator]
id = "backward_euler"
dt_s = 0.002
[material]
name = "custom"
density_kg_m3 = 1300
poisson_ratio = 0.45
radius_m = {RADIUS}
youngs_modulus_pa = {MODULUS}
[strand]
length_m = {LENGTH}
elements = 20
root_tangent = [1, 0, 0]
[effects.linear_drag]
[effects.gravity]
gravity_m_s2 = [0, 0, 0]
"""


def live_frames(scene, commands):
    """The answers of a live run to commands."""
    lines = "".join(json.dumps(command) + "\n" for command in commands)
    run = subprocess.run([PROGRAM, str(scene), "--live"], input=lines, text=True,
                         capture_output=True, check=True, cwd=ROOT)
    return [json.loads(line) for line in run.stdout.splitlines()][-len(commands):]


def heights_of(picture):
    """z of the tips of all lines of a picture with one moment, m."""
    data = base64.b64decode(picture["positions"])
    low, high = picture["low"][2], picture["high"][2]
    tips, point = [], 0
    for count in picture["strand_points"]:
        point += count
        word = int.from_bytes(data[6 * point - 2:6 * point], "little")
        tips.append(low + (high - low) * word / 65535)
    return tips


class Play:
    """The command and a page's requests to it."""

    def __init__(self, scene, command=(str(ROOT / "tress"), "play")):
        self.process = subprocess.Popen(
            [*command, str(scene)], stderr=subprocess.PIPE,
            stdin=subprocess.DEVNULL, text=True, cwd=ROOT)
        lines = []
        self.port = self.token = None
        for line in self.process.stderr:
            lines.append(line)
            if found := re.search(r"http://127\.0\.0\.1:(\d+)/([\w-]+)/", line):
                self.port, self.token = int(found[1]), found[2]
                break
        else:
            raise AssertionError("".join(lines))

    def ask(self, path, body=None, host=None, token=None, **more):
        link = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        headers = {"Host": host or f"127.0.0.1:{self.port}", **more}
        if body is not None:
            headers["Content-Type"] = "application/json"
        link.request("GET" if body is None else "POST", f"/{token or self.token}/{path}",
                     None if body is None else json.dumps(body), headers)
        with contextlib.closing(link):
            answer = link.getresponse()
            return answer.status, answer.read()

    def do(self, **command):
        status, answer = self.ask("command", command)
        assert status == 200, status
        return json.loads(answer)

    def look(self):
        """Opens the pictures; returns a function that waits for the next."""
        link = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        link.request("GET", f"/{self.token}/events", headers={"Host": f"127.0.0.1:{self.port}"})
        stream = link.getresponse()

        def following():
            while True:
                line = stream.readline()
                if line.startswith(b"data: "):
                    return json.loads(line[6:])
                assert line, "the pictures ended"
        return following, stream

    def state(self):
        following, stream = self.look()
        state = following()
        stream.close()
        return state

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        code = self.process.wait(20)
        self.process.stderr.close()
        return code


def series_of(state):
    series = state["picture"]["series"]
    return dict(zip(series["columns"], series["rows"][0]))


class Played(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.scene = Path(cls.folder.name) / "held.toml"
        cls.scene.write_text(SCENE)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.play = Play(self.scene)
        self.addCleanup(self.play.end)

    def test_the_page_comes_with_its_own_address_only(self):
        status, page = self.play.ask("")
        self.assertEqual(status, 200)
        self.assertIn(b"<canvas", page)
        self.assertEqual(self.play.ask("", token="x" * 32)[0], 403)
        self.assertEqual(self.play.ask("", host="evil.example")[0], 403)
        self.assertEqual(self.play.ask("command", {"do": "step"}, host="evil.example")[0], 403)
        self.assertEqual(self.play.ask("command", {"do": "step"}, Origin="http://evil.example")[0],
                         403)
        self.assertEqual(self.play.ask("nothing")[0], 404)
        self.assertEqual(self.play.state()["steps"], 0)

    def test_the_command_of_the_page_prints_an_address_with_the_view(self):
        played = [one.text for one in page_commands(ROOT, "docs/player.md")
                  if one.text.startswith("./tress play ")]
        self.assertEqual(len(played), 1)
        *command, scene = shlex.split(played[0])
        play = Play(scene, command)
        self.addCleanup(play.end)
        status, body = play.ask("")
        self.assertEqual(status, 200)
        self.assertIn(b"live-run", body)

    def test_two_steps_are_those_of_simulate(self):
        scene = ROOT / "scenes/cantilever.toml"
        dt = 0.002
        text = scene.read_text()
        self.assertIn(f"dt_s = {dt}", text)
        own = Path(self.folder.name) / "steps.toml"
        own.write_text(text.replace("duration_s = 3", f"duration_s = {2 * dt}\nframes_per_s = 500"))
        play = Play(own)
        self.addCleanup(play.end)
        for _ in range(2):
            self.assertEqual(play.do(do="step"), {})
        live = series_of(play.state())
        out = Path(self.folder.name) / "out"
        subprocess.run([PROGRAM, own, "--out", out], check=True, capture_output=True)
        rows = [line for line in (out / "steps.csv").read_text().splitlines()
                if not line.startswith("#")]
        simulated = dict(zip(rows[0].split(","), rows[-1].split(",")))
        # The file has numbers of 9 digits or more; the steps are the same.
        for name in ("t_s", "tip_x_m", "tip_z_m", "kinetic_j", "elastic_j"):
            value = float(simulated[name])
            self.assertLessEqual(abs(live[name] - value), 1e-8 * abs(value) + 1e-300, name)

    def test_a_run_goes_on_while_a_page_looks_and_pauses(self):
        following, stream = self.play.look()
        self.assertFalse(following()["playing"])
        self.play.do(do="run")
        while following()["steps"] < 5:
            pass
        stream.close()
        # The page is closed: at the next picture the run rests.
        deadline = time.monotonic() + 60
        before, now = -1, 0
        while before != now and time.monotonic() < deadline:
            before = now
            time.sleep(1)
            now = self.used()
        self.assertEqual(before, now)
        self.play.do(do="pause")
        self.assertFalse(self.play.state()["playing"])

    def used(self):
        """Processor time of the simulation program, in ticks."""
        for line in Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = line.read_text().rpartition(")")[2].split()
            except OSError:
                continue
            if int(fields[1]) == self.play.process.pid:
                return int(fields[11]) + int(fields[12])
        raise AssertionError("the simulation program is not there")

    def test_a_pull_moves_the_tip_to_the_static_value(self):
        # A spring k at the tip of a cantilever of stiffness K = 3 EI/L^3: the tip goes
        # k/(k + K) of the way d. Here k = K: half of it. Errors: large deflection, of the order
        # (y/L)^2 = 1e-4; twenty elements of equal length, at most 1/20^2 of the deflection;
        # the spring turns by at most y/L, of second order as well.
        stiffness = 3 * BENDING / LENGTH**3
        begin = series_of(self.play.state())
        tip = [begin[f"tip_{axis}_m"] for axis in "xyz"]
        along = max(range(3), key=lambda i: abs(tip[i]))
        across = next(i for i in range(3) if i != along)
        d = 0.02 * LENGTH
        target = list(tip)
        target[across] += d
        answer = self.play.do(do="pull", at=1, target=target, stiffness_n_m=stiffness)
        self.assertEqual(answer, {})
        for _ in range(10):
            self.play.do(do="step", steps=500, within_s=30)
        moved = series_of(self.play.state())["tip_" + "xyz"[across] + "_m"] - tip[across]
        self.assertLess(abs(moved / d - 0.5), 0.5 * (1 / 20**2 + 1e-3))
        self.play.do(do="release")
        for _ in range(10):
            self.play.do(do="step", steps=500, within_s=30)
        moved = series_of(self.play.state())["tip_" + "xyz"[across] + "_m"] - tip[across]
        self.assertLess(abs(moved), 1e-3 * d)

    def test_changes_go_on_from_the_state_or_are_refused_in_a_line(self):
        self.play.do(do="step", steps=3)
        self.assertEqual(self.play.do(do="set", key="integrator.dt_s", value=0.001), {})
        state = self.play.state()
        self.assertAlmostEqual(series_of(state)["t_s"], 0.006, 12)
        self.assertEqual(state["keys"]["integrator.dt_s"], 0.001)
        for command, words in (
                ({"key": "strand.elements", "value": 10}, "number of coordinates"),
                ({"key": "strand.length_m", "value": -1}, "length_m"),
                ({"key": "strand.width", "value": 1}, "width"),
                ({"key": "nothing.here", "value": 1}, "no table 'nothing'"),
                ({"key": "integrator.dt_s", "value": None}, "no number")):
            refused = self.play.do(do="set", **command)["refused"]
            self.assertIn(words, refused)
            self.assertNotIn("\n", refused)
            # Lines of the changed scene are not those of the file.
            self.assertNotIn(".toml", refused)
            if words != "number of coordinates":
                self.assertIn(f"({command['key']})", refused)
        self.play.do(do="restart")
        self.assertEqual(self.play.do(do="set", key="guard", value=False), {})
        self.assertEqual(self.play.do(do="set", key="strand.elements", value=10), {})
        self.assertEqual(series_of(self.play.state())["t_s"], 0)
        self.assertIn("refused", self.play.do(do="pull", at=2, target=[0, 0, 0], stiffness_n_m=1))
        self.assertIn("refused", self.play.do(do="fly"))

    def test_a_pull_moves_one_strand_of_several(self):
        for coupling in ("", "lagged", "monolithic"):
            touch = f'[effects.strand_interaction]\ncoupling = "{coupling}"\n' if coupling else ""
            strands = "".join(
                f"[[strand]]\nlength_m = {LENGTH}\nelements = 5\nroot_tangent = [1, 0, 0]\n"
                f"position_m = [0, {0.01 * k}, 0]\n" for k in range(6))
            head, tail = SCENE.split("[strand]")
            scene = head + strands + "[effects.linear_drag]" + tail.split("[effects.linear_drag]")[1]
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "several.toml"
                path.write_text(scene + touch)
                frames = live_frames(path, [
                    {"do": "pull", "strand": 4, "at": 1, "target": [LENGTH, 0.04, 0.02],
                     "stiffness_n_m": 1e-3},
                    {"do": "step", "steps": 20, "within_s": 60},
                    {"do": "pull", "strand": 6, "at": 1, "target": [0, 0, 0],
                     "stiffness_n_m": 1e-3}])
            self.assertIn("6", frames[-1]["refused"])
            picture = frames[-2]["picture"]
            heights = heights_of(picture)
            self.assertGreater(heights[4], 1e-3)
            for k in (0, 1, 2, 3, 5):
                self.assertLess(abs(heights[k]), 1e-5)

    def test_a_run_that_failed_refuses_to_run(self):
        self.play.do(do="set", key="integrator.id", value="explicit_euler")
        self.play.do(do="set", key="integrator.dt_s", value=0.01)
        self.play.do(do="set", key="effects.gravity.gravity_m_s2", value=[0, 0, -9.81])
        self.play.do(do="step", steps=100)
        self.assertTrue(self.play.state()["failed"])
        self.assertIn("restart", self.play.do(do="run")["refused"])
        self.play.do(do="restart")
        self.assertEqual(self.play.state()["failed"], "")

    def test_the_end_of_its_program_is_told(self):
        program, = subprocess.run(["pgrep", "-P", str(self.play.process.pid)],
                                  capture_output=True, text=True, check=True).stdout.split()
        os.kill(int(program), signal.SIGKILL)
        self.assertIn("has ended", self.play.do(do="step")["refused"])
        self.assertEqual(self.play.end(), 3)

    def test_an_end_leaves_no_process(self):
        children = subprocess.run(["pgrep", "-P", str(self.play.process.pid)],
                                  capture_output=True, text=True, check=True).stdout.split()
        self.assertTrue(children)
        self.assertEqual(self.play.end(), 0)
        for child in children:
            self.assertFalse(os.path.exists(f"/proc/{child}"))


class Refused(unittest.TestCase):
    def refused(self, pattern, *words):
        done = subprocess.run([ROOT / "tress", "play", *words], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, cwd=ROOT, check=False)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertRegex(done.stderr, pattern)
        self.assertNotIn("http", done.stderr)

    def test_bad_input_ends_before_a_server_starts(self):
        self.refused("give one scene file")
        self.refused("no file 'nothing.toml'", "nothing.toml")
        self.refused("--port none is no port", "scenes/cantilever.toml", "--port", "none")
        self.refused("unknown option '--out'", "scenes/cantilever.toml", "--out", "x")
        with contextlib.closing(socket.create_server(("127.0.0.1", 0))) as used:
            port = str(used.getsockname()[1])
            self.refused(f"port {port}: Address already in use; give another --port",
                         "scenes/cantilever.toml", "--port", port)
        with tempfile.TemporaryDirectory() as folder:
            bad = Path(folder) / "bad.toml"
            bad.write_text(SCENE.replace("length_m", "lenght_m"))
            self.refused(r"bad\.toml:\d+:\d+.*length_m", str(bad))


if __name__ == "__main__":
    if not PROGRAM.exists():
        sys.exit(77)
    unittest.main()
