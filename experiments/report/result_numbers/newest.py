"""Position-based dynamics, block descent and other simulators on hair."""
from . import hard
from .report import quoted, rows
from .tables import groups, known, least, records
from .words import code, duration, must, number, percent, signed_percent, span, table

# Chains of so few links stay off the rod however short their steps: no total error below
# the floor compares methods.
_LINKS = 20
_FLOOR = 0.02


def _levels_table(runs, levels):
    """Returns, by family, the cheapest run within each error, and the least error."""
    lines = []
    for family, members in groups(runs, "family"):
        cheapest = [least(members[members["error"] <= level], "wall_s") for level in levels]
        best = least(members, "error")
        loose = "loose" in best and best["loose"] is True
        lines.append([family, *("never" if run is None else duration(run["wall_s"]) for run in cheapest),
                      "" if loose else f"{percent(best['error'])} in {duration(best['wall_s'])} ({best['how']})"])
    return table(["family", *(f"within {percent(level)}" for level in levels), "least error"], lines)


def total_table(tables):
    return _levels_table(rows(tables, "runs_by_total_error"), [0.2, 0.05, _FLOOR])


def time_table(tables):
    return _levels_table(rows(tables, "runs_by_time_error"), [0.01, 0.001])


def machines(tables):
    """Returns where the tables were made: "on A", or "`block_descent.csv` on A, `work_precision.csv` on B"."""
    names = [name for name in ("work_precision", "block_descent", "other_simulators") if name in tables.manifests]
    found = {name: tables.manifests[name]["machine"]["cpu"] for name in names}
    if len(set(found.values())) == 1:
        return f"on {found[names[0]]}"
    return ", ".join(f"`{name}.csv` on {cpu}" for name, cpu in found.items())


def _engines(found):
    """Yields (engine, successful runs) with 20 links."""
    for name, members in groups(found[found["elements"] == _LINKS], ["simulator", "version", "method"]):
        yield name, members[members["status"] == "ok"]


def other_simulators_table(tables):
    """Returns, for each engine and method, the time for an error against the continuous rod, and the error at
    the shortest step, which is that of its links."""
    if "other_simulators" not in tables:
        return "The table `results/other_simulators.csv` of other simulators is missing; `./tress other_simulators` makes it."
    bounds = [0.05, _FLOOR]
    lines = []
    for (simulator, version, method), kept in _engines(tables["other_simulators"]):
        cheapest = [least(kept[kept["total_error_rel"] <= error], "wall_s") for error in bounds]
        finest = least(kept, "dt_s")
        lines.append([f"{simulator} {version}, {method}",
                      *("never" if row is None else f"{duration(row['wall_s'] / 2)} ({duration(row['dt_s'])})" for row in cheapest),
                      "unstable" if finest is None else f"{percent(finest['total_error_rel'])} at {duration(finest['dt_s'])}"])
    return table(["engine, method", *(f"within {percent(error)}" for error in bounds), "error at the shortest step"], lines)


def other_simulators_confirm(tables):
    """Returns the errors at the shortest steps, which are those of the links: errors of space."""
    if "other_simulators" not in tables:
        return ""
    finest = [least(kept, "dt_s") for _, kept in _engines(tables.rows("other_simulators", {"precision": "double"})) if len(kept) > 0]
    errors = [row["total_error_rel"] for row in finest]
    must(max(errors) < _FLOOR, "the finest runs of all engines are above the least target")
    mujoco = [row["total_error_rel"] for row in finest if row["simulator"] == "mujoco_3"]
    return (f"At their shortest steps, all {len(finest)} methods in double precision have an error of {span(errors, percent)} against the "
            f"continuous rod, with {_LINKS} links{f' (MuJoCo 3: {span(mujoco, percent)})' if mujoco else ''}. This is the error of the "
            f"links: a target below {percent(_FLOOR)} compares meshes, not methods.")


def _times(ratio):
    """Returns "1.2 times the time", or "the same time" where two digits do not differ."""
    text = number(ratio)
    return "the same time" if text == "1" else f"{text} times the time"


def order_two(tables):
    """Returns how order 2 compares with order 1 of position-based steps with few sweeps."""
    found = tables.ok_rows("block_descent", {"part": "order"})
    first, second = (found[found["integrator"] == name] for name in ("xpbd", "xpbd_bdf2"))
    pairs = first.merge(second, on=["dt_s", "sweeps"], suffixes=("", "_2"))
    if pairs.empty:
        return "The table does not compare `xpbd_bdf2` with `xpbd` yet"
    must((pairs["error_rel_2"] < pairs["error_rel"]).all(), "order 2 is the less wrong at every step and number of sweeps")
    words = (f"With steps of {duration(row['dt_s'])} and {row['sweeps']} sweeps, the tip error is {percent(row['error_rel'])} with `xpbd` "
             f"and {percent(row['error_rel_2'])} with `xpbd_bdf2`, in {_times(row['wall_s_per_sim_s_2'] / row['wall_s_per_sim_s'])}"
             for row in records(pairs))
    return ("Position-based dynamics with steps of second order (`xpbd_bdf2`) are more accurate than those of first order (`xpbd`) at "
            "every step and number of sweeps tested. " + ". ".join(words))


def chain_beside_helix(tables):
    """Returns the least errors of `articulated_chain`, which the method of Zhao et al. is closest to, and of
    `super_helix`."""
    runs = rows(tables, "runs_by_total_error")
    runs = runs[runs["how"].str.endswith(f" {_LINKS} elements")]
    chain, helix = (runs["error"][runs["how"].str.startswith(f"{model},")].min() for model in ("articulated_chain", "super_helix"))
    return (f"with {_LINKS} elements `articulated_chain` comes within {percent(chain)} of the swinging rod, `super_helix` within "
            f"{percent(helix)}")


def step_is_the_limit(tables):
    """Returns the errors of the steps to which sweeps converge."""
    near = tables.ok_rows("block_descent", {"integrator": "vbd_augmented"})
    near = near[near["direct_distance_rel"] <= 1e-3]
    must(len(near) > 0 and ((near["error_rel"] / near["direct_error_rel"] - 1).abs() < 0.05).all(),
         "what sweeps converge to is as far off the rod as the direct step")
    ends = " and ".join(f"{percent(members.iloc[0]['direct_error_rel'])} with steps of {duration(dt)}"
                        for dt, members in groups(near, "dt_s"))
    return ("More sweeps converge to the step of backward Euler, not to the exact rod. Where `vbd_augmented` has converged to that "
            f"step, both have a tip error of {ends}")


_BESIDE = ["backward_euler", "bdf2", "implicit_midpoint"]


def _flights(tables):
    found = tables.rows("validation", {"test": "free_flight"})
    return found[known(found["dt_s"])]


def _compared(tables):
    """Returns the flights of the models that a newest method has flown."""
    found, newest = _flights(tables), quoted(tables, "newest_methods")
    models = found["model"][found["integrator"].isin(newest)]
    return found[found["model"].isin(models) & found["integrator"].isin([*_BESIDE, *newest])]


def flight_table(tables):
    found = _compared(tables)
    steps = sorted(found["dt_s"].unique(), reverse=True)

    def shown(row):
        if row is None:
            return ""
        if row["status"] != "ok":
            return "unstable"
        return f"{signed_percent(row['energy_change_rel'])}, {percent(row['angular_error_rel'])}"

    lines = []
    for integrator in [*_BESIDE, *quoted(tables, "newest_methods")]:
        for model, members in groups(found[found["integrator"] == integrator], "model"):
            by_step = {row["dt_s"]: row for row in reversed(records(members))}
            lines.append([f"`{integrator}`", f"`{model}`", *(shown(by_step.get(dt)) for dt in steps)])
    return table(["integrator", "model", *(f"at {duration(dt)}" for dt in steps)], lines)


def _missing(tables, there, what):
    missing = [name for name in quoted(tables, "newest_methods") if name not in set(there)]
    return f"The table has no {what} of {code(missing)} yet." if missing else ""


def flight_missing(tables):
    return _missing(tables, _flights(tables)["integrator"], "flight")


def order_in_flight(tables):
    """Returns the energy loss of order 1 and of order 2, fully converged."""
    found = _compared(tables)
    found = found[found["status"] == "ok"]
    longest = found["dt_s"].max()
    at = found[found["dt_s"] == longest]
    euler, bdf2 = (at["energy_change_rel"][at["integrator"] == name].abs() for name in ("backward_euler", "bdf2"))
    must(len(euler) > 0 and len(bdf2) > 0 and euler.min() > 5 * bdf2.max(), "`bdf2` loses far less energy than `backward_euler`")
    return (f"The order of the step limits what sweeps can reach: fully converged, `backward_euler` loses {span(euler, percent)} of "
            f"the energy at {duration(longest)}, `bdf2` {span(bdf2, percent)}")


def map_counts(tables):
    """Returns how many runs of `stable_cosserat_rods` finish, and how many are accurate."""
    found = tables.rows("block_descent", {"part": "rods", "scene": "swing"})
    finished = found[found["status"] == "ok"]
    stiffest = found["stretch_over_bending"].max()
    hair = finished["error_rel"][finished["stretch_over_bending"] == stiffest]
    return (f"{len(finished)} of the {len(found)} runs of `stable_cosserat_rods` on the hair finish, "
            f"{(finished['error_rel'] <= 0.01).sum()} of these within 1 % of the rod. With the stretch stiffness of a hair, "
            f"{len(hair)} of {(found['stretch_over_bending'] == stiffest).sum()} runs finish, with errors of {span(hair, percent)}")


def survived_table(tables):
    """Returns how many stable pairs of case and model are accurate, of those with a reference, over strand models at
    the longest step of each integrator, or its tolerance. The best variant of a model counts."""
    pairs = hard.judged(tables)
    pairs = pairs[pairs["survives"] & pairs["model"].isin(tables["validation"]["model"])]
    lines = []
    for integrator, members in groups(pairs, "integrator"):
        if not members["by_tolerance"].all():
            members = members[~members["by_tolerance"]]
        members = members[members["dt_s"] == members["dt_s"].max()]
        compared = (members["outcome"] != "stable, not compared").sum()
        accurate = (members["outcome"] == "stable and accurate").sum()
        lines.append([f"`{integrator}`", hard.pace(members.iloc[0]), len(members), compared, accurate,
                      percent(accurate / compared) if compared > 0 else ""])
    return table(["integrator", "longest step or tolerance", "stable", "of these with a reference", "accurate",
                  "accurate of those with a reference"], lines)


def survived_missing(tables):
    return _missing(tables, tables["hard_cases"]["integrator"], "hard case")


def energy_cases(tables):
    found = tables["hard_cases"]
    return found["case"][found["measure_name"].str.contains("energy")].nunique()


def published_table(tables):
    return table(
        ["code", "simulated", "hardware", "figure", "measured", "not measured", "source", "found there"],
        [[row["name"], row["simulated"], row["hardware"] or "not stated",
          " ".join(filter(None, [row["figure"], row["unit"]])) or "none", row["measured"], row["not_measured"],
          f"[{row['source']}]({row['address']}){'; ' + row['cited_as'] if row['cited_as'] else ''}", row["checked"]]
         for row in records(tables["other_simulators_published"])])


def published_errors(tables):
    """Returns that no published figure is an error of a motion, which would be a row to compare with."""
    found = tables["other_simulators_published"]
    measured = found["measured"][found["figure"] != ""]
    must(not measured.str.contains("error").any(), "no published figure gives the error of the motion")
    return f"{len(found)} entries have {len(measured)} published figures; none of the figures is the error of the motion"
