"""Verdicts on rows of a reproduced table, and the watch of the machine's load."""

import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from toy_release import IDS, Reproduce  # noqa: E402
from tress_command.reproduce import archive, judge, load, recipes  # noqa: E402


class Choice(Reproduce):
    def test_a_choice_by_time_is_no_change(self):
        before, after = (judge.Table.read(folder, "damping") for folder in
                         (self.results, self.toy))
        after.rows[0]["model"] = "other"
        for name, verdicts in (("damping", ["changed value"]),
                               ("cost_of_accuracy", ["other choice"])):
            judged = judge.judge_table(name, before, after)
            self.assertEqual([one["verdict"] for one in judged.found], verdicts)
            self.assertEqual(judged.bad(), name == "damping")
        # So is the number of the further rows of a search, but not that of searches.
        for key, verdict in ((f"{IDS[0]}.001", "other choice"), (IDS[0], "missing")):
            before.rows[0]["run_id"] = key
            after.rows[:] = before.rows[1:]
            (one,) = judge.judge_table("head_accuracy", before, after).found
            self.assertEqual(one["verdict"], verdict)


class Parts(unittest.TestCase):
    def test_waiting_ends_when_the_machine_is_idle_or_the_time_is_over(self):
        now, told = [0.0], []

        def wait(loads, limit):
            found = iter(loads)
            now[0] = 0

            def look(seconds):
                now[0] += seconds
                return next(found)

            return load.wait_for_idle(limit, told.append, look, lambda: now[0])

        self.assertEqual(wait([0.1], 60), (0.1, 5))
        self.assertEqual(told, [])
        self.assertEqual(wait([1.5, 0.7, 0.2], 60), (0.2, 15))
        self.assertEqual(wait([1.5] * 9, 10), (1.5, 10))
        self.assertEqual(len(told), 2)
        self.assertRegex(told[0], "use 1.5 processors; waiting up to 60 s")
        self.assertEqual(wait([None], 60), (None, 5))

    def test_a_busy_loop_is_load(self):
        with subprocess.Popen(["bash", "-c", "while :; do :; done"]) as busy:
            try:
                # Of one loop about 1; the clock of /proc/stat ticks a hundred times a second.
                self.assertGreater(load.load_of_others(0.5), 0.2)
            finally:
                busy.kill()
        self.assertIsNone(load.busy_s("/none"))

    def test_times_under_load_are_uncertain(self):
        for machine, pattern in (
                ({"cpus": 2, "load_before": [1.5, 0, 0]}, "^$"),
                ({"cpus": 2, "load_before": [2.5, 0, 0]}, "load average 2.5 on 2 processors"),
                ({"cpus": 2, "load_before": [9, 0, 0],
                  "load_of_others_during": {"rows_above": []}}, "^$"),
                ({"load_of_others_during": {"rows_above": ["a", "b"]}}, "2 rows were timed")):
            self.assertRegex(load.doubt({"machine": machine}), pattern)

    def test_cells_are_judged_by_their_kind(self):
        for name, a, b, whole, same, verdict in (
                ("error_rel", 1.0, 1 + 9e-10, False, True, ""),
                ("error_rel", 1.0, 1 + 2e-9, False, True, "changed value"),
                ("error_rel", 1e-12, 2e-12, False, False, "rounding"),
                ("error_rel", 1e-12, 2e-12, False, True, "changed value"),
                ("error_rel", 1e-15, 9e-15, False, True, ""),
                ("t_s", 1e-12, 2e-12, False, False, "changed value"),
                ("t_s", 1.0, 1 + 9e-6, False, False, "rounding"),
                ("steps", 10, 11, True, True, "changed value"),
                ("steps", 10, 11, True, False, "rounding"),
                ("steps", 10, 12, True, False, "changed value"),
                ("why", "at 0.1 s", "at 0.2 s", False, True, "changed value"),
                ("why", "at 0.1 s", "at 0.2 s", False, False, "rounding"),
                ("status", "ok", "diverged", False, False, "changed outcome"),
                ("passed", 1, 0, True, False, "changed outcome"),
                ("x", 1.0, None, False, False, "changed value"),
                ("x", None, None, False, True, "")):
            self.assertEqual(judge.judge_cell(name, a, b, whole, same), verdict, (name, a, b))

    def test_quartiles(self):
        self.assertEqual(judge.quartiles([2.0]), (2, 2, 2))
        self.assertEqual(judge.quartiles([1.0, 2.0, 3.0, 4.0, 5.0]), (2, 3, 4))

    def test_every_table_of_the_repository_has_a_recipe_or_a_reason(self):
        for table in recipes.OTHER_WAYS:
            self.assertTrue((Path(__file__).parents[2] / f"results/{table}.csv").exists(), table)
        self.assertEqual(archive.commits_of({"a": {"commit": "x"}, "b": {"commit": "y"},
                                             "c": {"commit": "y"}}), [("y", 2), ("x", 1)])


if __name__ == "__main__":
    unittest.main()
