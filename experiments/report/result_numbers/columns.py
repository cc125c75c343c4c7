"""Meaning of the columns of every table: from the manifests, and from here for tables that no experiment
writes."""
import json
import re

from .tables import REPOSITORY, InputError
from .words import markdown, table

_IN_EVERY_TABLE = {
    "status": "ok, or how the row ended",
    "reason": "reason for a status that is not ok",
    "run_id": "checksum of the settings of the row",
}

_OF_CLAIMS = {
    "study": "question of the family",
    "claim": "statement that is tested",
    "family": "hair, or rods of other materials",
    "model": "catalogue id",
    "integrator": "method",
    "range": "gravito-bending numbers of the hairs or rods that are counted",
    "statement": "the claim in words",
    "value": "quantity measured for each hair",
    "hairs": "hairs or rods that give an answer",
    "no_answer": "number of inconclusive hairs or rods",
    "reasons": "number of inconclusive hairs or rods, by status",
    "holds_share": "share of the hairs or rods for which the claim is true",
    "decile_1": "first decile of the value",
    "median": "median of the value",
    "decile_9": "ninth decile of the value",
    "correlated_with": "property of a hair with the largest rank correlation with the value",
    "rank_correlation": "Spearman's rank correlation with that property",
    "decided_by": "property that best predicts for which hairs the claim is true",
    "threshold": "threshold of that property",
    "share_below": "share of the hairs below the threshold for which the claim is true",
    "share_above": "share of the hairs above the threshold for which the claim is true",
    "told_right_share": "share of all hairs that the threshold predicts correctly",
}

_BY_HAND = {
    "family_summary": _OF_CLAIMS,
    "family_tolerance_summary": _OF_CLAIMS,
    "compare_itself": {
        "beside": "itself, or a build with a slowed kernel",
        "rows": "benchmarks compared",
        "wrong": "verdicts that contradict the build",
        "verdict": "verdict on the slowed kernel",
        "ratio": "time of that kernel over its time in the build itself, median of the rounds",
        "ratio_low": "lower end of the interval of the ratio",
        "ratio_high": "upper end of the interval of the ratio",
    },
    "full_sweeps": {
        "experiment": "experiment of `./tress run`",
        "rows": "number of rows of the experiment",
        "timed_rows": "rows timed, spread over all",
        "cut_off_rows": "timed rows that reached the timeout: their time is a lower bound",
        "row_s": "processor time of a timed row, mean (s)",
        "plan_s": "processor time to plan the rows, in each part (s)",
        "parts": "number of parts of about a quarter of an hour",
        "core_hours": "core hours of all rows in these parts",
        "memory_mb": "memory of the largest process (MB)",
    },
    "mutants": {
        "file": "mutated source file",
        "line": "number of the mutated line",
        "before": "original line",
        "after": "mutated line",
        "outcome": "killed by a test, or survived",
    },
    "question_times": {
        "question": "question of the README, by the program that answers it",
        "options": "options of the program",
        "processor_s": "processor time of one run",
        "wall_s": "wall time of one run",
        "answer": "part of a line that the program printed",
    },
    "player": {
        "draw": "renderer: the canvas alone, or WebGL computed by a processor",
        "colour": "one colour a strand, or hair in light",
        "hairs": "number of hairs drawn",
        "points": "number of points of each hair",
        "width": "width of the picture in pixels",
        "height": "height of the picture in pixels",
        "picture_ms": "wall time of a picture (ms), median of five times ten",
    },
    "cost_of_accuracy_two_engines": {
        "commit": "commit of the table",
        "scene": "scene of the search",
        "target_error_rel": "target error over the length",
        "model": "model of the cheapest run",
        "integrator": "integrator of the cheapest run",
        "elements": "number of elements of the cheapest run",
        "next_model": "model of the next best run",
        "next_integrator": "integrator of the next best run",
        "cost_factor": "time of the next best run over that of the cheapest",
    },
    "other_simulators_published": {
        "name": "name of the method",
        "cited_as": "citation in this repository",
        "source": "publication or program",
        "address": "address of the source",
        "simulated": "simulated system",
        "hardware": "hardware of the run",
        "figure": "published figure",
        "unit": "unit of the figure",
        "measured": "quantity that the figure gives",
        "not_measured": "questions that the figure leaves open",
        "checked": "whether the figure was found at its source",
    },
    "other_simulators_swing": {
        "simulator": "simulator and its joints",
        "stable_dt_n5_s": "largest stable step with 5 links",
        "stable_dt_n20_s": "largest stable step with 20 links",
        "stable_dt_n80_s": "largest stable step with 80 links",
        "us_per_step_n20": "wall time of a step with 20 links (µs)",
        "wall_1pct_s": "wall time of the run for an error of 1 %",
        "dt_1pct_s": "step of that run",
        "wall_0p1pct_s": "wall time of the run for an error of 0.1 %",
    },
}

# solve_ivp.csv is rows of work_precision.
_LIKE = {"solve_ivp": "work_precision"}

# Ends of names that are units: the Python module's own.
_UNITS = json.loads((REPOSITORY / "python/tress/units.json").read_text(encoding="utf-8"))


def unit_of(column):
    words = column.split("_")
    ends = ("_".join(words[k:]) for k in range(1, len(words)))
    return next((_UNITS[end] for end in ends if end in _UNITS), "").replace("^2", "²").replace("^3", "³")


def _texts(tables, name):
    return _BY_HAND.get(name) or tables.manifest(_LIKE.get(name, name))["columns"]


def listing(tables):
    """Returns a table for every CSV file: column, unit, meaning."""
    parts = []
    for name in sorted(path.stem for path in (tables.root / "results").glob("*.csv")):
        texts = _texts(tables, name)
        header = tables.text(f"results/{name}.csv").split("\n", 1)[0].strip().split(",")
        lines = []
        for column in header:
            if column in _IN_EVERY_TABLE:
                continue
            if not texts.get(column):
                raise InputError(f"results/{name}.csv: column '{column}' has no text; give it one in the experiment or columns.py")
            lines.append([f"`{column}`", unit_of(column), texts[column]])
        parts.append(f"## {name}.csv\n\n{markdown(table(['column', 'unit', ''], lines))}")
    return "\n\n".join(parts)


_CUT = re.compile(r"(?:\b(?:a|an|and|at|by|for|from|in|of|on|or|the|to|with)|[\s,:;(])$")


def _found(tables, file, before):
    """Returns (column, description) of each call or entry that begins with `before`. A description may
    be several adjacent literals."""
    text = tables.text(file)
    found = [(column, "".join(re.findall(r'"([^"]*)"', literals)))
             for column, literals in re.findall(before + r'"(\w+)",\s*((?:"[^"]*"\s*)+)', text)]
    if len(found) < 8:
        raise InputError(f"{file}: no columns are found there; correct the pattern in columns.py")
    # A number of the scene may follow.
    found = [(column, what.removesuffix(", of ")) for column, what in found]
    for column, what in found:
        if _CUT.search(what):
            raise InputError(f'{file}: the description of {column} ends in the middle: "{what}"; write it as one literal')
    return found


def _vector(name, unit):
    """Returns the names of the columns of a vector."""
    return ", ".join(f"{name}_{part}_{unit}" for part in "xyz")


def series(tables):
    """Returns the columns of time series, as the sources that write them describe them."""
    strands = [
        *_found(tables, "simulation/run/readout.cpp", r"\badd\("),
        ("tip_x_m, tip_y_m, tip_z_m", "tip, mean over the strands"),
        ("<effect>_j", "potential energy of the effect"),
        ("angle_<body>_rad", "angle by which strands have turned a body, about its axis"),
        ("speed_<body>_rad_per_s", "angular velocity of a body that strands turn"),
        (_vector("position_<body>", "m"), "centre of mass of a free body"),
        (", ".join(f"orientation_<body>_{part}" for part in "wxyz"),
         "quaternion that turns the world's axes to those of a free body"),
        (_vector("velocity_<body>", "m_per_s"), "velocity of the centre of mass"),
        (_vector("spin_<body>", "rad_per_s"), "angular velocity of a free body"),
        (_vector("force_<support>", "n"), "force of a support on the strand"),
        (_vector("moment_<support>", "n_m"), "moment on the strand of a support that holds a direction, about the held point"),
        (_vector("force_joint_<number>", "n"), "force of a joint on its end `b`"),
        (_vector("moment_joint_<number>", "n_m"), "moment of a weld or hinge on its end `b`, about the point"),
    ]
    there = {column for columns, _ in strands for column in columns.split(", ")}
    heads = _found(tables, "experiments/simulate/head_series.cpp", r"\{")
    lines = [*strands, *((column, f"{what} (batches of strands)") for column, what in heads if column not in there)]
    return table(["column", "unit", ""],
                 [[f"`{columns}`", unit_of(columns.split(", ")[0]), what] for columns, what in lines])


def everywhere(tables):
    return table(["column", ""], [[f"`{column}`", what] for column, what in _IN_EVERY_TABLE.items()])
