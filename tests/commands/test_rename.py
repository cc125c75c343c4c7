"""Former names: programs refuse them and give the present one; `./tress rename` converts them.

test_rename.py PROGRAMS: the folder with the compiled experiments."""

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = Path(sys.argv.pop()) if len(sys.argv) > 1 else ROOT / "build/release/experiments"

SCENE = """title = "a hair of an earlier version"
duration_s = 0.01
{frames} = 100
[model]
id = "super_helix"
{jacobian} = "{elastic}"
[integrator]
id = "{method}"
dt_s = 1e-3
[strand]
length_m = 0.1
elements = 4
[material]
[effects.gravity]
"""
FORMER = {
    "frames": "frames_1_s",
    "jacobian": "tangent",
    "elastic": "stiff",
    "method": "semi_implicit_euler",
}
PRESENT = {
    "frames": "frames_per_s",
    "jacobian": "jacobian",
    "elastic": "elastic",
    "method": "linearly_implicit_euler",
}


def run(*arguments):
    return subprocess.run(
        [str(one) for one in arguments], capture_output=True, text=True, cwd=ROOT, timeout=120
    )


def studies():
    """Experiments with the shared command line."""
    names = (PROGRAMS / "list.txt").read_text(encoding="utf-8").split()
    return [name for name in names if name != "simulate"]


def former_names():
    """Those of contract/renamed.h."""
    text = (ROOT / "contract/renamed.h").read_text(encoding="utf-8")
    return sorted({before for before, _ in re.findall(r'\{"([^"]+)", "([^"]+)"\},', text)})


class FormerNames(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def refused(self, done, present):
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertIn(f"called '{present}' now", done.stderr)

    def test_each_name_of_a_scene_is_refused_with_the_present_one(self):
        for key, present in PRESENT.items():
            words = {**PRESENT, key: FORMER[key]}
            with self.subTest(key):
                scene = self.write("s.toml", SCENE.format(**words))
                done = run(PROGRAMS / "simulate", scene, "--check", "--out", self.folder)
                self.refused(done, present)
                self.assertIn("s.toml:", done.stderr)

    def test_the_tolerance_of_a_run(self):
        text = SCENE.format(**{**PRESENT, "method": "tr_bdf2"})
        scene = self.write("s.toml", text.replace("dt_s = 1e-3", "tolerance = 1e-3"))
        done = run(PROGRAMS / "simulate", scene, "--check", "--out", self.folder)
        self.refused(done, "position_tol_rel")

    def test_options_of_simulate(self):
        scene = self.write("s.toml", SCENE.format(**PRESENT))
        for former, present in (
            (["--bits", "32"], "--precision"),
            (["--lanes", "4"], "--simd-width"),
            (["--as", "head"], "batch"),
        ):
            with self.subTest(former[0]):
                done = run(PROGRAMS / "simulate", scene, *former, "--out", self.folder)
                self.refused(done, present)

    def test_every_study_refuses_the_former_method(self):
        for name in studies():
            done = run(PROGRAMS / name, "--integrators", "semi_implicit_euler", "--dry-run",
                       "--out", self.folder / "t.csv")
            with self.subTest(name):
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                if "has no use for --integrators" not in done.stderr:
                    self.assertIn("called 'linearly_implicit_euler' now", done.stderr)

    def test_every_study_refuses_every_former_name(self):
        refused = 0
        for name in studies():
            for former in former_names():
                given = [former, "1"] if former.startswith("--") else ["--set", f"{former}=1"]
                done = run(PROGRAMS / name, *given, "--dry-run", "--out", self.folder / "t.csv")
                with self.subTest(f"{name} {' '.join(given)}"):
                    if done.returncode == 0 or "is not a number" in done.stderr:
                        continue  # the name of another key of this study
                    self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                    self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
                    self.assertRegex(done.stderr, r"called '\S+.*' now")
                    refused += 1
        self.assertGreater(refused, 30 * len(studies()))

    def test_rename_converts_a_scene_that_then_runs(self):
        scene = self.write("s.toml", SCENE.format(**FORMER))
        done = run(ROOT / "tress", "rename", scene)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("3 lines", done.stdout)
        self.assertEqual(scene.read_text(encoding="utf-8"), SCENE.format(**PRESENT))
        done = run(PROGRAMS / "simulate", scene, "--check", "--out", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        again = run(ROOT / "tress", "rename", scene)
        self.assertIn("no former names", again.stdout)

    def test_rename_converts_a_table(self):
        table = self.write(
            "heads.csv", 'model,bits,lanes,tangent,note,state\nder,32,8,stiff,"a, stiff",5f\n'
        )
        done = run(ROOT / "tress", "rename", table)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(
            table.read_text(encoding="utf-8"),
            'model,precision,simd_width,jacobian,note,state_hash\n'
            'der,32,8,elastic,"a, stiff",5f\n',
        )

    def test_present_scenes_and_tables_stay_as_they_are(self):
        files = sorted((ROOT / "scenes").glob("**/*.toml")) + sorted(
            (ROOT / "results").glob("*.csv"))
        self.assertGreater(len(files), 60)
        for path in files:
            copy = self.write(path.name, path.read_text(encoding="utf-8"))
            done = run(ROOT / "tress", "rename", copy)
            with self.subTest(path.name):
                self.assertIn("no former names", done.stdout, done.stderr)

    def test_what_is_no_scene_or_table_is_refused_and_nothing_is_written(self):
        scene = self.write("s.toml", SCENE.format(**FORMER))
        for bad in (self.write("notes.txt", "stiff"), self.folder / "missing.toml"):
            with self.subTest(bad.name):
                done = run(ROOT / "tress", "rename", scene, bad)
                self.assertEqual(done.returncode, 2)
                self.assertRegex(done.stderr, rf"^tress: rename: .*{re.escape(bad.name)}")
                self.assertEqual(scene.read_text(encoding="utf-8"), SCENE.format(**FORMER))

    def test_former_commands(self):
        self.refused(run(ROOT / "tress", "peers"), "other_simulators")


if __name__ == "__main__":
    unittest.main()
