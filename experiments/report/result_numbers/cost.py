"""Cheapest run that reaches a target error."""
import math

from .tables import first, groups, known, positive, records
from .words import duration, is_number, is_set, must, number, percent, span, spaced, step, table

_TARGET = 0.01
_NAMED = 3  # winners in a sentence
_LOOSEST = 0.1  # tolerance that the search tries


def _way(row):
    options = ", ".join(filter(None, [row["modes"], row["jacobian"]]))
    return f"`{row['model']}`{f' ({options})' if options else ''}, `{row['integrator']}`"


def _elements(row):
    """Returns the number of elements; two numbers if the result is extrapolated."""
    count = row["elements"]
    return f"{count:.0f} and {math.ceil(count / 2)}" if row["extrapolated"] == "true" else f"{count:.0f}"


def _steps(row):
    """Returns the time step, or the tolerance of an adaptive run."""
    if not is_number(row["position_tol_rel"]):
        return duration(row["dt_s"])
    mean = step(row["mean_step_s"]) if "mean_step_s" in row else ""
    return f"adaptive (tolerance {number(row['position_tol_rel'], 3)}{f', mean step {mean}' if mean else ''})"


def _of_kind(tables, kind, target=_TARGET):
    return tables.rows("cost_of_accuracy", {"kind": kind, "target_error_rel": target})


def winners(tables, target=None):
    """Returns the cheapest run for each scene and target error, or for one target error."""
    rows = tables.rows("cost_of_accuracy", {"kind": "winner"}) if target is None else _of_kind(tables, "winner", target)
    return rows[positive(rows["wall_s_per_sim_s"])]


def scenes(tables):
    return tables.rows("cost_of_accuracy", {"kind": "winner"})["scene"].nunique()


def _tied_with(tables, winner):
    """Returns the runner-up whose time cannot be told from the winner's; None: there is none."""
    rows = _of_kind(tables, "runner_up", winner["target_error_rel"])
    return first(rows[(rows["scene"] == winner["scene"]) & rows["tied"].map(is_set)])


def _neighbours(row):
    """Returns the largest error of a winner's neighbours (more elements, shorter steps, changed data)."""
    return percent(row["error_neighbours_rel"]) if is_number(row["error_neighbours_rel"]) else "not measured"


def winners_table(tables):
    following = _of_kind(tables, "runner_up")
    given = tables.rows("cost_of_accuracy", {"kind": "as_given"})
    lines = []
    for winner in records(winners(tables, _TARGET)):
        other = first(following[following["scene"] == winner["scene"]])
        shipped = first(given[given["scene"] == winner["scene"]])
        lines.append([
            spaced(winner["scene"]), _way(winner), f"{_elements(winner)}, {_steps(winner)}",
            f"{percent(winner['error_rel'])}, {_neighbours(winner)}", duration(winner["wall_s_per_sim_s"]),
            *(["", ""] if other is None else
              [_way(other), f"{number(other['cost_factor'])}{' (tie)' if is_set(other['tied']) else ''}"]),
            "" if shipped is None else
            f"{percent(shipped['error_rel'])}, {number(shipped['wall_s_per_sim_s'] / winner['wall_s_per_sim_s'])}"])
    return table(
        ["scene", "cheapest at 1 %", "elements, step", "error: nominal, largest of the neighbours",
         "time per simulated second", "next best", "its time over the winner's",
         "scene as shipped: error, time over the winner's"], lines)


def winners_by_target(tables):
    """Returns the cheapest run for every target error, scene by scene."""
    rows = winners(tables)
    targets = sorted(rows["target_error_rel"].unique(), reverse=True)

    def cell(row):
        if row is None or row["status"] != "ok":
            return "none found"
        tie = "" if _tied_with(tables, row) is None else " (tie)"
        return f"{_way(row)}, {_elements(row)}, {_steps(row)}: {duration(row['wall_s_per_sim_s'])}{tie}"

    return table(
        ["scene", *map(percent, targets)],
        [[spaced(scene), *(cell(first(members[members["target_error_rel"] == target])) for target in targets)]
         for scene, members in groups(rows, "scene")])


def _pairs_of_engines(tables):
    """Returns pairs of winners: with two engines, and now."""
    now = {(row["scene"], row["target_error_rel"]): row for row in records(winners(tables))}
    before = records(tables["cost_of_accuracy_two_engines"])
    return [(row, now[row["scene"], row["target_error_rel"]])
            for row in before if (row["scene"], row["target_error_rel"]) in now]


def two_engines_table(tables):
    """Returns the winners at 1 % before and after the models became one engine."""
    following = _of_kind(tables, "runner_up")
    lines = []
    for before, now in _pairs_of_engines(tables):
        if before["target_error_rel"] != _TARGET:
            continue
        other = first(following[following["scene"] == now["scene"]])
        lines.append([spaced(now["scene"]),
                      f"`{before['model']}`, `{before['integrator']}`, {before['elements']:.0f}", number(before["cost_factor"]),
                      f"`{now['model']}`, `{now['integrator']}`, {now['elements']:.0f}",
                      "" if other is None else number(other["cost_factor"])])
    return table(["scene", "before: cheapest, elements", "next best", "now: cheapest, elements", "next best"], lines)


def commit_of_two_engines(tables):
    return next(iter(tables["cost_of_accuracy_two_engines"]["commit"]))


def two_engines(tables):
    """Returns how many winners the engine has changed."""
    pairs = _pairs_of_engines(tables)
    models = sum(before["model"] != now["model"] for before, now in pairs)
    methods = sum(before["integrator"] != now["integrator"] for before, now in pairs)
    return (f"Of {len(pairs)} winners (scenes and targets), {len(pairs) - models} keep their model and "
            f"{len(pairs) - methods} their integrator")


def _tally(tables, column):
    """Returns "`esdirk43` on 3 of 7 scenes (and tied on 1), `bdf2` on 2". A tie is no win."""
    rows = winners(tables, _TARGET)
    counts = []
    for name, members in groups(rows, column):
        others = (_tied_with(tables, row) for row in records(members))
        counts.append((name, len(members), sum(other is not None and other[column] != name for other in others)))
    counts.sort(key=lambda count: count[2] - count[1])
    words = [f"`{name}` on {count - ties}" + (f" of {len(rows)} scenes" if k == 0 else "") + (f" (and tied on {ties})" if ties > 0 else "")
             for k, (name, count, ties) in enumerate(counts[:_NAMED])]
    others = sum(count for _, count, _ in counts[_NAMED:])
    return ", ".join([*words, *([f"others on {others}"] if others > 0 else [])])


def winning_integrators(tables):
    return _tally(tables, "integrator")


def winning_models(tables):
    return _tally(tables, "model")


def horizon(tables):
    """Returns the part of the scenes that the errors cover."""
    rows = winners(tables, _TARGET)
    whole = rows["duration_s"][positive(rows["duration_s"])] if "duration_s" in rows else []
    of = f" of scenes of {span(whole, duration)}" if len(whole) > 0 else " of each scene"
    return f"Errors are compared over the first {span(rows['horizon_s'], duration)}{of}"


def nominal(tables):
    """Returns how many winners at 1 % miss the target when their data change."""
    rows = winners(tables, _TARGET)
    errors = rows["error_neighbours_rel"][known(rows["error_neighbours_rel"])]
    return ("These errors are nominal. With more elements, other steps, or length and modulus changed by 2 %, "
            f"{(errors > _TARGET).sum()} of {len(errors)} winners exceed 1 %. The largest of their errors is {percent(errors.max())}")


def step_rule(tables):
    """Returns the tolerances of the winners that adapt their steps."""
    rows = winners(tables, _TARGET)
    adaptive = rows["position_tol_rel"][positive(rows["position_tol_rel"])]
    if adaptive.empty:
        return "All of these winners take equal steps"
    bound = (" No tolerance is looser than a tenth of the length: a looser one does not control the error."
             if adaptive.max() <= _LOOSEST else "")
    return (f"{len(adaptive)} of these {len(rows)} winners adapt their steps, at tolerances of {span(adaptive)} of the length."
            f"{bound} The search varies the tolerance as it varies the number of elements. The tolerance does not "
            "bound the error: the error column gives the resulting error")


_CHOICES = {
    "elements": "number of elements",
    "dt_s": "time step",
    "position_tol_rel": "step control",
    "extrapolated": "extrapolation",
    "mesh": "mesh",
    "refresh": "refresh of the matrix",
    "radau5": "`radau5`",
    "rodas5p": "`rodas5p`",
}


def choices_table(tables):
    """Returns the cost of replacing each choice by the next best: the median over scenes and errors, and the
    number of replacements."""
    rows = tables.rows("cost_of_accuracy", {"kind": "without"})
    factors = groups(rows[positive(rows["cost_factor"])], "choice")["cost_factor"]
    found = factors.agg(["median", "size"]).sort_values("median", ascending=False, kind="stable")
    return table(["choice", "time over the winner's", "replacements"],
                 [[_CHOICES.get(choice, spaced(choice)), number(factor), f"{count:.0f}"] for choice, factor, count in found.itertuples()])


_FEWEST = 10


def clothoid_step(tables):
    """Returns the cost of an element of a clothoid over that of a helix."""
    rows = tables.ok_rows("scaling", {"structure": "straight", "solver": "recursive", "modes": ["", "bend_twist"]})
    rows = rows[rows["elements"] >= _FEWEST]
    same = ["elements", "jacobian"]
    helices = rows[rows["model"] == "super_helix"].drop_duplicates(same)
    pairs = rows[rows["model"] == "super_clothoid"].merge(helices, on=same, suffixes=("", "_helix"))
    ratio = pairs["cost_per_step_s"] / pairs["cost_per_step_s_helix"]
    return ", ".join(
        f'{span(members)} times that of the same number of helices with `jacobian = "{jacobian}"` '
        f"({len(members)} numbers of elements from {_FEWEST} on)" for jacobian, members in groups(ratio, pairs["jacobian"]))


def clothoid_elements(tables):
    """Returns the fewest clothoids and helices with which a released rod reaches 1 %."""
    rows = tables.ok_rows("cost_of_accuracy", {"kind": "method", "scene": "release"})
    fewest = rows.groupby("model")["elements"].min()
    clothoids, helices = fewest["super_clothoid"], fewest["super_helix"]
    must(clothoids < helices, "a rod that is let go needs fewer clothoids than helices")
    return (f"For a rod that is let go, the cheapest runs within 1 % use {clothoids:.0f} clothoids or more, and "
            f"{helices:.0f} helices or more")


def margins(tables):
    """Returns the range, over all winners, of the largest error of the neighbours over the target."""
    margin = winners(tables)["margin"]
    margin = margin[known(margin)]
    return f"{span(margin)} over all {len(margin)} winners" if len(margin) > 0 else "not known for this table"


def gap(tables):
    """Returns the largest difference between two references of the continuous rod."""
    return number(tables.rows("cost_of_accuracy", {"kind": "winner"})["reference_gap"].max())
