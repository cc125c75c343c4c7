"""The numbers of pages, computed from tables: /usr/bin/python3 tests/report/test_result_numbers.py"""
import json
import unittest

from repository import ROOT, Made
from result_numbers import columns, machine, python, references, words
from result_numbers.tables import InputError, Tables, read_table
from result_numbers.words import duration, markdown, must, number, percent, plain, span, table


class Values(unittest.TestCase):
    def test_values_are_written_in_few_digits(self):
        self.assertEqual(number(0.012345), "0.012")
        self.assertEqual(number(123.4), "123")
        self.assertEqual(number(1.5e-7), "1.5e-7")
        self.assertEqual(number(-2e-4), "-2e-4")
        self.assertEqual(number(12345), "1.2e4")
        self.assertEqual(number(9999.6), "10000")
        self.assertEqual(number(0), "0")
        self.assertEqual([number(None), number(float("nan")), number(""), number(float("inf"))], [""] * 4)
        self.assertEqual(percent(0.0137), "1.4 %")
        self.assertEqual(duration(0.0083), "8.3 ms")
        self.assertEqual(duration(6.04e-4), "604 µs")
        self.assertEqual(duration(-1), "")
        self.assertEqual(words.step(0.0333333), "33.3 ms")
        self.assertEqual(span([3, 1, 2]), "1 to 3")
        self.assertEqual(span([2.01, 2.02]), "2")
        self.assertEqual(words.signed_percent(0.1), "+10 %")
        self.assertEqual([words.counted(count, "thread") for count in (0, 1, 2)], ["0 threads", "1 thread", "2 threads"])
        self.assertEqual([plain(3.0), plain(0.5), plain(2.5e-7)], ["3", "0.5", "2.5e-7"])

    def test_halves_are_rounded_away_from_zero(self):
        self.assertEqual([number(x) for x in (0.125, 2.25, 1.125e-5)], ["0.13", "2.3", "1.1e-5"])
        self.assertEqual([number(x, 1) for x in (2.5, 3.5, -2.5)], ["3", "4", "-3"])

    def test_a_table_is_markdown(self):
        self.assertEqual(markdown(table(["a", ""], [["x|y", 3.0], [None, "z"]])), "| a |  |\n|---|---|\n| x\\|y | 3 |\n|  | z |")

    def test_ids_in_tables_are_code(self):
        self.assertEqual(words.coded("super_helix over der, family.csv and t_s.csv"),
                         "`super_helix` over `der`, family.csv and `t_s.csv`")
        for text in ("van der Heijden & Thompson 2000", "`a_b` and [c](d_e.md)", "models/a_b.cpp", '{"a_b": 1}'):
            self.assertEqual(words.coded(text), text)
        self.assertEqual(markdown(table(["rk4"], [["a_b, der"]])), "| `rk4` |\n|---|\n| `a_b`, `der` |")

    def test_a_sentence_whose_condition_failed_is_not_printed(self):
        self.assertEqual(must(True, "A wins"), "A wins")
        with self.assertRaisesRegex(InputError, '"A wins everywhere"'):
            must(False, "A wins everywhere")

    def test_a_unit_stands_at_the_end_of_a_name(self):
        names = ["dt_s", "drag_kg_m_s", "density_kg_m3", "natural_per_m", "steps", "s"]
        self.assertEqual([columns.unit_of(name) for name in names], ["s", "kg/(m s)", "kg/m³", "1/m", "", ""])


class Reading(Made):
    def test_columns_are_numbers_where_all_fields_are(self):
        self.write("results/t.csv", 'n,x,id,word,none\n1,,7_1,"a, b",\n2,1e-3,8_2,nan,\n')
        rows = Tables(self.root)["t"]
        self.assertEqual([str(kind) for kind in rows.dtypes], ["int64", "float64", "object", "object", "object"])
        self.assertEqual(list(rows["word"]), ["a, b", "nan"])
        self.assertEqual(rows["x"][1], 1e-3)

    def test_rows_are_selected_by_value_and_one_row_must_be_one(self):
        self.write("results/t.csv", "n,x,kind,status\n0.1,1,a,ok\n0.2,2,b,lost\n")
        tables = Tables(self.root)
        self.assertEqual(tables.row("t", {"n": 0.1 + 1e-12})["x"], 1)
        self.assertEqual(list(tables.rows("t", {"kind": ["a", "b"], "n": [0.2, 0.3]})["x"]), [2])
        self.assertEqual(list(tables.ok_rows("t", {})["x"]), [1])
        with self.assertRaisesRegex(InputError, "2 rows"):
            tables.row("t", {})

    def test_a_check_of_a_program_is_found_by_its_key_whatever_its_words(self):
        self.write("results/t.meta.json", json.dumps({"checks": [
            {"claim": "some words", "held": True, "value": 0.5, "state": "passed"},
            {"claim": "other words", "key": "hairs", "held": False, "value": 36.0, "state": "figure"},
            {"claim": "not run", "key": "rest", "held": False, "value": None, "state": "not_judged"}]}))
        tables = Tables(self.root)
        self.assertEqual(tables.check("t", "hairs")["claim"], "other words")
        self.assertEqual(tables.count("t", "hairs"), 36)
        self.assertEqual(tables.read, {"t"})
        with self.assertRaisesRegex(InputError, "t.meta.json has 0 checks with the key 'words', expected one; run"):
            tables.check("t", "words")
        with self.assertRaisesRegex(InputError, "t.meta.json: the check 'rest' was not judged; run"):
            tables.check("t", "rest")

    def test_a_file_that_is_no_table_is_named_with_its_line(self):
        for text, message in [("a,b\n1,2\n3\n", "t.csv:3: 1 fields where the header has 2"), ("", "t.csv:1: empty"),
                              ('a\n"x', "t.csv:2: unexpected end of data"), ("a,a\n", "t.csv:1: column 'a' appears twice")]:
            self.write("t.csv", text)
            with self.assertRaisesRegex(InputError, f"^{message}.*; run the experiment again"):
                read_table(self.root / "t.csv", "t.csv")
        (self.root / "t.csv").write_bytes(b"a\n\xff\n")
        with self.assertRaisesRegex(InputError, r"t\.csv cannot be read .*; write it again"):
            read_table(self.root / "t.csv", "t.csv")


class Columns(Made):
    def series(self, description):
        lines = "".join(f'add("c{k}_s", "time {k}");\n' for k in range(8))
        self.write("simulation/run/readout.cpp", f'{lines}add("depth_m",\n    {description});\n')
        self.write("experiments/simulate/head_series.cpp", "".join(f'{{"c{k}_s", "time {k}"}},\n' for k in range(8)))
        return markdown(columns.series(Tables(self.root)))

    def test_adjacent_literals_are_one_description(self):
        self.assertIn("| `depth_m` | m | depth at the ends of all steps |", self.series('"depth at the ends of "\n    "all steps"'))

    def test_a_description_that_ends_in_the_middle_is_refused(self):
        for cut in ("depth at the ends of", "depth in the ", "depth:", "largest depth, "):
            with self.assertRaisesRegex(InputError, "depth_m ends in the middle"):
                self.series(f'"{cut}" + more')

    def test_descriptions_of_the_shipped_columns_are_whole(self):
        self.assertNotRegex(markdown(columns.series(Tables(ROOT))), r"(?m) (?:a|an|and|at|by|from|in|of|or|the|to|with) *\|$")


class Sources(unittest.TestCase):
    def test_a_citation_is_authors_years_and_a_place(self):
        self.assertEqual(references.citations("Bergou et al. 2008, 2010"),
                         [("Bergou et al.", "2008", ""), ("Bergou et al.", "2010", "")])
        self.assertEqual(references.citations(" van der Heijden &  Thompson 2000: closed form"),
                         [("van der Heijden & Thompson", "2000", "closed form")])
        self.assertEqual(references.citations("Newton"), [])

    def test_a_citation_has_its_publication_and_a_publication_its_citation(self):
        known = references.works("# comment\nKutta 1901\tW. Kutta: Beitrag\n")
        self.assertEqual(known, {"Kutta 1901": "W. Kutta: Beitrag"})
        references.match(["Kutta 1901"], known)
        with self.assertRaisesRegex(InputError, "nothing stands there for Heun 1900"):
            references.match(["Kutta 1901", "Heun 1900"], known)
        with self.assertRaisesRegex(InputError, "nothing cites Kutta 1901"):
            references.match([], known)
        with self.assertRaisesRegex(InputError, r"references\.txt:1: expected"):
            references.works("Kutta 1901\n")

    def test_names_of_python_are_found_with_what_is_said_of_them(self):
        source = "\n".join([
            "def _own():", '    """None of yours."""', "def far(", "    a,", "    b=1,", "):",
            '    """Says', "", "    more:", '      that."""', "class Thing(Base):", '    """A thing."""', "",
            "    def __init__(self):", "        pass", "    @property", "    def size(self):",
            '        """m."""', "    def grow(self, by):", "        return by", "", "def last():", "    pass"])
        self.assertEqual(python.names_of(source), [
            {"name": "far", "signature": "far(a, b=1)", "text": "Says\n\nmore:\n  that.", "owner": None},
            {"name": "Thing", "signature": "Thing", "text": "A thing.", "owner": None},
            {"name": "size", "signature": "size", "text": "m.", "owner": "Thing"},
            {"name": "grow", "signature": "grow(by)", "text": "", "owner": "Thing"},
            {"name": "last", "signature": "last()", "text": "", "owner": None}])

    def test_every_source_has_a_line_once_with_all_places_that_cite_it(self):
        text = markdown(references.listing(Tables(ROOT)))
        lines = [line for line in text.split("\n") if line.startswith("| Chung")]
        self.assertEqual(len(lines), 1, "Chung-Hulbert is Chung, Hulbert")
        self.assertRegex(lines[0], r"1993 .*`integrators/generalized_alpha.cpp`")
        self.assertRegex(text, r"Baraff 1996 .*`models/catalogue.cpp`.*`models/maximal/mass_spring.cpp`")
        self.assertRegex(text, r"\| Swope et al\. 1982 \| W\. C\. Swope, .*J\. Chem\. Phys\. 76, 637-649 \|")


class Queries(Made):
    def test_newest_methods_other_simulators_and_flights_count_where_the_tables_have_them(self):
        swing = {"scene": "swing", "status": "ok", "block": 1}
        self.assertRegex(
            self.say("newest.total_table", validation=[], block_descent=[
                {**swing, "integrator": "vbd", "model": "mass_spring", "dt_s": 1e-3, "sweeps": 4, "error_rel": 0.04,
                 "wall_s_per_sim_s": 0.5}]),
            r"\| `vbd` \| 500 ms \| 500 ms \| never \| 4 % in 500 ms")
        self.assertIn("is missing", self.say("newest.other_simulators_table"))
        other_simulators = [
            {"simulator": "MuJoCo", "method": "ball", "status": "ok", "dt_s": 1e-3, "wall_s": 0.2, "total_error_rel": 0.009},
            {"simulator": "ODE", "method": "step", "status": "unstable", "dt_s": 1e-2, "wall_s": 0.1}]
        total = self.say("newest.total_table", other_simulators=other_simulators)
        self.assertRegex(total, r"\| MuJoCo \| 100 ms \| 100 ms \| 100 ms \| 0\.9 %")
        self.assertNotIn("ODE", total)
        self.assertRegex(
            self.say("newest.other_simulators_table", other_simulators=[{**row, "version": "1", "elements": 20} for row in other_simulators]),
            r"\| MuJoCo 1, ball \| 100 ms \(1 ms\) \| .* \| 0\.9 % at 1 ms \|\n\| ODE 1, step \| never .* unstable")
        self.assertRegex(self.say("newest.flight_missing"), "no flight of `xpbd`, .*`vbd`")
        flight = [{"test": "free_flight", "model": "corde", "integrator": "vbd", "dt_s": 1e-3, "status": "ok",
                   "energy_change_rel": -0.02, "angular_error_rel": 0.01}]
        self.assertRegex(self.say("newest.flight_table", validation=flight), r"`vbd` \| `corde` \| -2 %, 1 %")
        self.assertNotIn("`vbd`,", self.say("newest.flight_missing"))

    def test_a_denominator_counts_what_could_have_come_out_otherwise(self):
        def run(dt_s, outcome, **more):
            return {"case": "cone", "model": "der", "integrator": "rk4", "dt_s": dt_s, "outcome": outcome, "error_rel": 0.1,
                    **more}

        self.assertEqual(self.say("hard.broken_at_shorter_count", hard_cases=[
            run(1e-3, "unstable"), run(1e-2, "stable"),
            run(1e-3, "stable", model="corde"), run(1e-2, "stable", model="corde"),
            # One step, and one that is left of two: neither can break at the shorter.
            run(1e-3, "stable", integrator="bdf2"),
            run(1e-3, "refused", model="xpbd"), run(1e-2, "stable", model="xpbd")]), "1 of 2 (50 %)")
        self.assertEqual(self.say("hard.broken_at_shorter"), "`cone`")

        def grazing(name, **more):
            return run(1e-3, more.pop("outcome", "unstable"), case=name, **more)

        self.write("results/hard_cases.meta.json", json.dumps({"checks": [
            {"claim": "w", "key": "exact_contact_survives", "held": True, "value": 1.0, "state": "passed"}]}))
        self.assertEqual(self.say("hard.rising_count", hard_cases=[
            grazing("grazing_contact"), grazing("grazing_exact", outcome="stable"),
            grazing("grazing_contact", integrator="bdf2"), grazing("grazing_exact", integrator="bdf2", outcome="refused",
                                                                             why="rigid: use tr_bdf2, esdirk43"),
            grazing("grazing_impulse", integrator="bdf2", outcome="refused", why="rubs: use rk4 or esdirk43"),
            grazing("cone", model="corde"),
            grazing("cone_exact", model="corde", outcome="refused", why="motion = 'free' is unknown: use one of: fixed")]),
            "1 of 1")
        self.assertRegex(self.say("hard.rising_table"), r"`grazing_contact` \| `rk4` \| 1 ms \| \*\*survives\*\* \| `der` \|\n"
                         r".*\| not available with `bdf2`, but with `tr_bdf2`, `esdirk43`, `rk4` \| `der` \|\n"
                         r".*\| refused: motion = 'free' is unknown \| `corde` \|")
        compared = [run(1e-2, "stable"), run(1e-2, "stable and accurate", case="a"), run(1e-2, "stable", case="b", error_rel="")]
        self.assertRegex(self.say("newest.survived_table", hard_cases=compared, validation=[{"model": "der"}]),
                         r"\| `rk4` \| 10 ms \| 3 \| 2 \| 1 \| 50 % \|")
        # Chains and particles are no strand models.
        self.assertRegex(self.say("newest.survived_table", hard_cases=[*compared, run(1e-2, "stable", model="tinkertoys")]),
                         r"\| `rk4` \| 10 ms \| 3 \|")

    def test_a_limit_without_an_end_of_its_search_is_a_bound(self):
        row = {"study": "grid", "elements": 20, "damping": "none", "scene": "release", "integrator": "backward_euler",
               "jacobian": "exact", "modes": "", "dt_max_s": "", "limited_by": "energy"}
        rows = [{**row, "model": "der", "status": "gave_up", "dt_first_unstable_s": 3.2e-5},
                {**row, "model": "corde", "status": "gave_up", "dt_first_unstable_s": ""},
                {**row, "model": "vbd", "status": "ok", "dt_max_s": 0.1, "limited_by": "cap", "dt_first_unstable_s": ""},
                {**row, "model": "xpbd", "status": "unstable", "dt_first_unstable_s": 1e-6}]
        said = self.say("stability.models_table", stability_limit=rows)
        for model, step in (("der", "< 32 µs"), ("corde", "inconclusive"), ("vbd", "≥ 100 ms"), ("xpbd", "none found")):
            self.assertRegex(said, rf"`{model}` \| not searched \| {step} \|")

    def test_a_tie_is_no_win_and_winners_say_how_near_the_edge_they_are(self):
        row = {"target_error_rel": 0.01, "wall_s_per_sim_s": 1, "status": "ok", "model": "der", "elements": 5, "dt_s": 1e-3}
        winner = {**row, "kind": "winner", "integrator": "esdirk43", "error_rel": 0.009, "error_neighbours_rel": 0.013,
                  "position_tol_rel": 1, "margin": 1.3}
        runner_up = {**row, "kind": "runner_up", "integrator": "tr_bdf2"}
        self.assertEqual(self.say("cost.winning_integrators", cost_of_accuracy=[
            {**winner, "scene": "a"},
            {**winner, "scene": "b", "error_neighbours_rel": 0.0095, "mean_step_s": 0.002},
            {**runner_up, "scene": "a", "tied": "true", "cost_factor": 1.02},
            {**runner_up, "scene": "b", "tied": "false", "cost_factor": 2}]), "`esdirk43` on 1 of 2 scenes (and tied on 1)")
        self.assertEqual(self.say("cost.winning_models"), "`der` on 2 of 2 scenes",
                         "a tie between methods of one model is its win")
        self.assertRegex(self.say("cost.nominal"), r"1 of 2 winners exceed 1 %. The largest of their errors is 1\.3 %")
        self.assertRegex(self.say("cost.step_rule"), "2 of these 2 winners adapt")
        self.assertRegex(self.say("cost.winners_table"), r"adaptive \(tolerance 1, mean step 2 ms\) \| 0\.9 %, 0\.95 %")

    def test_engines_are_not_compared_at_the_floor_of_their_links(self):
        row = {"simulator": "p", "version": "1", "method": "m", "elements": 20, "status": "ok", "precision": "double"}
        lines = self.say("newest.other_simulators_table", other_simulators=[
            {**row, "dt_s": 1e-3, "wall_s": 0.2, "total_error_rel": 0.015},
            {**row, "dt_s": 1e-5, "wall_s": 20, "total_error_rel": 0.00998}]).split("\n")
        self.assertNotIn("within 1 %", lines[0])
        self.assertRegex(lines[2], r"\| 1 % at 10 µs \|$")
        self.assertIn("a target below 2 % compares meshes", self.say("newest.other_simulators_confirm"))

    def test_values_below_what_is_printed_given_parameters_and_signs_are_shown_as_they_are(self):
        cell = {"test": "impact", "model": "der", "elements": 10, "parameter": 1, "measured": 1, "reference": 1, "status": "ok",
                "judged": "true", "passed": "true", "error_rel": 2e-16, "accepted_error_rel": 1e-6}
        self.assertRegex(self.say("validation.matrix", validation=[cell]), r"\| 1e-4 \| 2e-14 \|")
        self.assertRegex(self.say("validation.matrix", validation=[cell, {**cell, "status": "refused", "error_rel": ""}]),
                         r"2e-14 \(in part\)")
        self.assertRegex(self.say("validation.scores_table"), r"\| `der` \| 1 \| 1 \| `impact` \|")
        left = {"test": "knot", "model": "der", "status": "refused", "reason": "takes minutes: left out by --quick"}
        both = [{**cell, "model": "corde"}, {**cell, "model": "corde", "test": "knot"}, cell, left]
        self.assertRegex(self.say("validation.matrix", validation=both), r"`knot` \| 1e-4 \| 2e-14 \| left out \|")
        self.assertIn("`corde` meets the most: 2 of 2. `der` meets 1 of 1 (1 slow test left out).", self.say("validation.scores"))
        self.assertIn("1 pair of model and test, of `knot`", self.say("validation.left_out"))
        self.assertRegex(self.say("friction.fits_table", calibrate=[
            {"data": "a_b", "signal": "s", "fit": "gamma", "integrator": "bdf2", "status": "ok",
             "internal_friction_kg_m3_s": 1e-10, "internal_friction_low_kg_m3_s": 9e-11,
             "internal_friction_high_kg_m3_s": 1.1e-10, "drag_kg_m_s": 2e-5}]),
            r"\| 1 \[0\.9, 1\.1\] \| 2 \(given\) \|")

        def lost(dt_s, energy_lost_rel, status="ok"):
            return {"model": "der", "integrator": "e", "dt_s": dt_s, "energy_lost_rel": energy_lost_rel, "status": status}

        self.assertIn("loses 9 % at 4 ms and 13 % at 1 ms, and is unstable at 16 ms", self.say("damping.not_monotone", damping=[
            lost(1e-3, 0.13), lost(4e-3, 0.09), lost(0.016, "", "unstable")]))

    def test_settings_of_a_kind_of_hair_keep_the_target_for_every_motion(self):
        def row(scene, **more):
            return {"scene": scene, "kind": "cheapest", "target_error_rel": 0.01, "strands": 100, "guides": 20,
                    "elements": 8, "dt_s": 0.004, "precision": 32, "status": "ok", **more}

        said = self.say("head_accuracy.by_hair", head_accuracy=[
            row("full_head"), row("wavy_alike_released"), row("wavy_alike_shaken", guides=30, elements=9, dt_s=0.002),
            row("curly_varied_released"), row("curly_varied_shaken", status="gave_up")])
        self.assertEqual(said.split("\n")[2:], [
            "| wavy | equal | 1 % | 20 % to 30 % | 9 | 2 ms | single |",
            "| curly | different | 1 % | no tried run keeps it |  |  |  |"])

    def test_a_bound_of_tolerances_is_stated_where_the_table_keeps_it(self):
        def said(tolerance):
            return self.say("cost.step_rule", cost_of_accuracy=[
                {"kind": "winner", "target_error_rel": 0.01, "wall_s_per_sim_s": 1, "position_tol_rel": tolerance}])

        self.assertIn("No tolerance is looser than a tenth of the length", said(0.1))
        self.assertNotIn("No tolerance", said(0.5))

    def test_a_time_per_element_is_that_of_the_largest_groom(self):
        def row(precision, threads, cost, strands=1000):
            return {"model": "super_helix", "integrator": "linearly_implicit_euler", "effects": "drag", "elements": 10,
                    "strands": strands, "precision": precision, "threads": threads, "cost_per_step_s": cost, "status": "ok"}

        self.write("results/heads.meta.json", json.dumps({"machine": {"cpus": 2}}))
        rows = [row(64, 1, 6e-4), row(64, 1, 9e-4), row(64, 2, 4e-4), row(64, 3, 1e-4), row(32, 2, 2e-4), row(32, 2, 1e-9, 10)]
        self.assertEqual(
            self.say("heads.per_element", heads=rows),
            "In double precision it is 60 ns with one thread and 40 ns with 2 threads. In single precision it is 20 ns with 2 threads.")
        self.assertEqual(self.say("heads.frame_example", heads=rows), "0.3 s with one thread and 0.2 s with 2 threads")

    def test_a_claim_about_hairs_names_its_best_predictor(self):
        row = {"claim": "super_helix_step_longer", "range": "all", "family": "hair", "hairs": 48, "no_answer": 2,
               "holds_share": 0.88, "decile_1": 0.5, "median": 1, "decile_9": 4, "decided_by": "gravito_bending",
               "threshold": 887, "share_below": 0.88, "share_above": 0.094}
        rods = {**row, "family": "rods", "hairs": 15, "holds_share": 0.4}
        said = self.say("family.model_steps", family_summary=[row, rods])
        self.assertIn("for 88 % of 48 hairs (2 inconclusive). The ratio of the largest steps has a median of 1 and deciles of 0.5 and 4", said)
        self.assertIn("is true for 88 % of the hairs below 887 and for 9.4 % above. The statement is true for 40 % of 15 rods", said)
        by_drive = self.say("family.model_steps", family_summary=[{**row, "decided_by": "drive is gust_of_wind"}, rods])
        self.assertIn("the drive: the statement is true for 9.4 % of the hairs with gust of wind and for 88 % of the others",
                      by_drive)

    def test_claims_about_hairs_are_counted_by_curl(self):
        def hair(kind, curvature, holds, status="ok"):
            return {"family": "hair", "claim": "super_helix_step_longer", "kind": kind, "natural_curvature_per_m": curvature,
                    "holds": holds, "status": status}

        hairs = [hair("wavy", 60, "false"), hair("straight", 10, "true"), hair("straight", 20, "false"),
                 hair("wavy", 50, "", "unresolved")]
        statement = {"family": "hair", "range": "all", "study": "stable_steps", "claim": "super_helix_step_longer"}
        self.assertEqual(self.say("family.by_curl", "super_helix_step_longer", family=hairs), "50 % (straight), 0 % (wavy)")
        self.assertRegex(self.say("family.curls", family=hairs, family_summary=[statement]),
                         r"straight: 10 to 20 1/m \| wavy: 50 to 60 1/m \|\n.*\n.*\| 50 % of 2 \| 0 % of 1; 1 inconclusive \|")

    def test_counts_of_a_study_are_those_that_its_program_stored(self):
        counts = {"hairs": 40, "hairs_at_rest": 29, "hairs_half": 31, "elements": 18, "elements_remeshed": 2,
                  "elements_following": 3, "limit": 10, "limit_remeshed": 1, "hairs_pilot": 39, "hairs_pilot_always": 38}
        self.write("results/adaptive_mesh.meta.json", json.dumps({"checks": [
            {"claim": key, "key": key, "held": False, "value": float(value), "state": "figure"}
            for key, value in counts.items()]}))
        rows = [{"part": "elements", "status": "ok", "gain": 1.2, "gain_following": 1.1, "gain_following_always": 1.6},
                {"part": "in_motion", "status": "ok", "tolerance_rel": 0.005, "tip_error_rel": 0.004},
                {"part": "in_motion", "status": "ok", "tolerance_rel": 0.0025, "tip_error_rel": 0.012},
                {"part": "pilot", "status": "ok", "tolerance_rel": 0.005, "elements": 4, "work_rel": 3}]
        self.assertIn("in 3 of 28 cases, limits included. Numbers of elements that follow the motion gain it in 3 of 18 measured "
                      "cases by the rms error over a run, and in 1 where", self.say("adaptive_mesh.verdict", adaptive_mesh=rows))
        self.assertIn("29 of 40 hairs keep a tolerance of 0.5 % of their length. Meshed for a tolerance of 0.25 %, 31 of 40 keep 0.5 %",
                      self.say("adaptive_mesh.in_motion", adaptive_mesh=rows))
        self.assertIn("Of 40 hairs, 39 keep 0.5 % of their length by the same measure, and 38 at every",
                      self.say("adaptive_mesh.pilot", adaptive_mesh=rows))

    def test_statements_about_gradients_name_the_models_that_they_leave_out(self):
        def row(model, integrator="tr_bdf2", **more):
            return {"part": "time", "start": "damped", "jacobian": "exact", "status": "ok", "model": model, "steps": 40,
                    "integrator": integrator, "gradient_error_rel": 0.02, "tip_error_rel": 0.001,
                    "linearizations_1_percent": 100, **more}

        rows = [row("super_helix"), row("der", linearizations_1_percent=200),
                row("mass_spring", gradient_error_rel=9, linearizations_1_percent="")]
        others = "the 2 models other than `mass_spring` and `inextensible_strand`"
        self.assertEqual(self.say("cost_of_gradient.smooth_models", cost_of_gradient=rows), others)
        self.assertIn("On each of these 2 models, no other method needs fewer", self.say("cost_of_gradient.advice_1_percent", cost_of_gradient=rows))
        self.assertIn(f"On {others}, the relative error of the gradient is 20 to 20 times", self.say("cost_of_gradient.over_tip", cost_of_gradient=rows))

    def test_percentiles_are_interpolated_between_hairs(self):
        hairs = [{"family": "hair", "claim": "exact_step_100ms", "hair": k, "gravito_bending": 10 * k} for k in (4, 1, 3, 2)]
        self.assertEqual(self.say("family.gravito_bending", family=hairs), "12 (5 %), 25 (50 %) and 39 (95 %)")

    def test_tables_of_several_commits_and_loaded_machines_are_named(self):
        def manifest(name, commit, load):
            self.write(f"results/{name}.meta.json", json.dumps({
                "quick": True, "git": {"commit": commit, "dirty": False}, "timings": ["wall_s"],
                "start": "2026-01-01T00:00:00Z", "end": "2026-01-01T00:01:00Z", "sundials_speed_ratio": 1,
                "machine": {"cpu": "X", "cpus": 2, "load_before": [load, 0, 0], "load_after": [1, 0, 0]}}))

        manifest("a", "aaaaaaaaaa", 0.1)
        manifest("b", "aaaaaaaaaa", 0.1)
        self.assertEqual(self.say("machine.one_run"), "The 2 tables of `./tress run` come from commit aaaaaaa")
        self.assertEqual(machine.run_minutes(Tables(self.root)), 2)
        self.assertEqual(machine.provenance(Tables(self.root), ["a", "b", "c"]),
                         "Tables of this page by commit: aaaaaaa: `a`, `b`.")
        manifest("b", "bbbbbbbbbb", 2.8)
        self.assertIn("come from 2 commits, not from one run (1 from aaaaaaa, 1 from bbbbbbb)", self.say("machine.one_run"))
        self.assertRegex(self.say("machine.made_table"), r"`b` \| bbbbbbb .* 2\.80, 1\.00 \| 1 \| uncertain \|")
        self.assertRegex(machine.provenance(Tables(self.root), ["a", "b"]),
                         r"aaaaaaa: `a`; bbbbbbb: `b`\. Times of `b` are uncertain: other programs ran\.$")


if __name__ == "__main__":
    unittest.main()
