"""Other solver packages on published problems: digits and costs of their runs."""
import re

from .machine import minutes_of
from .tables import groups, known, records
from .words import code, counted, duration, is_number, must, number, spaced, span, table


def _tolerances(rows):
    return sorted(rows["rtol"][known(rows["rtol"])].unique(), reverse=True)


def _whole(count):
    """Returns a count with all digits; "": unknown."""
    return str(int(count)) if is_number(count) else ""


def _name(row):
    """Returns package and method, with the largest order where the table has two."""
    order = f", order at most {number(row['max_order'])}" if number(row["max_order"]) else ""
    return f"{row['package']} `{row['solver']}`{order}"


def _common(tables):
    """Returns the runs that have a relative tolerance."""
    rows = tables["other_solvers"]
    return rows[known(rows["rtol"])]


def _digits(rows, tolerance):
    found = records(rows[rows["rtol"] == tolerance])
    return "" if not found else number(found[0]["digits"]) if found[0]["status"] == "ok" else spaced(found[0]["status"])


def problem_table(tables, problem):
    """Returns, for each solver of a problem: digits at each tolerance, and the cost at the middle one."""
    rows = _common(tables)
    levels = _tolerances(rows)
    rows, middle = rows[rows["problem"] == problem], levels[1]
    lines = []
    for _, members in groups(rows, ["package", "solver", "formulation", "max_order"]):
        row = records(members)[0]
        cost = [one for one in records(members) if one["rtol"] == middle and one["status"] == "ok"]
        steps = [_whole(cost[0]["steps"]), _whole(cost[0]["evaluations"]), _whole(cost[0]["jacobians"]),
                 duration(cost[0]["wall_s"])] if cost else [""] * 4
        lines.append([_name(row), row["formulation"], *(_digits(members, level) for level in levels), *steps])
    return table(["solver", "formulation", *(f"digits at {number(level)}" for level in levels), "steps", "evaluations", "Jacobians",
                  "time"], lines)


def own_table(tables):
    """Returns the runs of tress that have no relative tolerance: fixed steps, and errors of a point."""
    rows = tables["other_solvers"]
    lines = [[spaced(row["problem"]), f"`{row['solver']}`", row["formulation"],
              f"step {duration(row['dt_s'], 3)}" if number(row["dt_s"]) else f"tolerance {number(row['position_tol_rel'])}",
              number(row["digits"]) if row["status"] == "ok" else spaced(row["status"]), _whole(row["steps"]),
              _whole(row["evaluations"]), duration(row["wall_s"])]
             for row in records(rows[~known(rows["rtol"])])]
    return table(["problem", "method", "formulation", "step or tolerance", "digits", "steps", "evaluations", "time"], lines)


def failures(tables):
    """Returns every run without an end state, and its reason."""
    rows = tables["other_solvers"]
    lines = [[spaced(row["problem"]), _name(row), row["formulation"],
              next(number(row[key]) for key in ("rtol", "position_tol_rel", "dt_s") if number(row[key])), row["reason"]]
             for row in records(rows[rows["status"] != "ok"])]
    return table(["problem", "solver", "formulation", "tolerance or step", "reason"], lines)


def jacobians(tables):
    """Returns the source of the Jacobian of each solver."""
    rows = tables["other_solvers"]
    lines = [[package, ", ".join(f"`{one}`" for one in dict.fromkeys(members["solver"])), jacobian]
             for (package, jacobian), members in groups(rows, ["package", "jacobian"])]
    return table(["package", "solvers", "Jacobian"], lines)


def counts(tables):
    rows = tables["other_solvers"]
    return f"{counted(len(rows), 'run')}, of which {(rows['status'] == 'ok').sum()} reached the end with at least one correct digit"


def packages(tables):
    """Returns the other packages with their versions."""
    rows = tables["other_solvers"]
    rows = rows[(rows["package"] != "tress") & (rows["version"].astype(str) != "")]
    return ", ".join(f"{package} {version}" for package, version in dict.fromkeys(zip(rows["package"], rows["version"])))


def reference_digits(tables):
    """Returns the digits of each reference."""
    rows = tables["other_solvers"].drop_duplicates("problem")
    return ", ".join(f"{spaced(row['problem'])} {row['reference_digits']}" for row in records(rows))


def limit(tables):
    """Returns the number of runs that reached the time limit."""
    rows = tables["other_solvers"]
    return counted((rows["status"] == "timeout").sum(), "run")


def minutes(tables):
    return minutes_of([tables.manifest("other_solvers")])


def beam_orders(tables):
    """Returns the steps of BDF methods on the Beam at the middle tolerance, by largest order."""
    rows = _common(tables)
    middle = _tolerances(rows)[1]
    rows = rows[(rows["problem"] == "beam") & known(rows["max_order"]) & (rows["rtol"] == middle)]
    lines = []
    for (package, solver), members in groups(rows, ["package", "solver"]):
        cells = {number(row["max_order"]): _whole(row["steps"]) if row["status"] == "ok" else spaced(row["status"])
                 for row in records(members)}
        lines.append([f"{package} `{solver}`", *(cells.get(str(order), "") for order in range(1, 6))])
    return table([f"steps at {number(middle)}", *(f"order at most {order}" for order in range(1, 6))], lines)


def beam_ratio(tables):
    """Returns how often the steps of order 2 orders 3 to 5 of CVODE took."""
    rows = _common(tables)
    rows = rows[(rows["problem"] == "beam") & (rows["solver"] == "cvode_bdf") & (rows["rtol"] == _tolerances(rows)[1])]
    steps = {row["max_order"]: row["steps"] for row in records(rows)}
    high = [steps[order] / steps[2] for order in (3, 4, 5)]
    return must(min(high) > 1, f"{span(high)} times")


def beam_ida(tables):
    """Returns steps and digits of IDA on the Beam at the middle tolerance, and those of CVODE with order 2."""
    rows = _common(tables)
    rows = records(rows[(rows["problem"] == "beam") & (rows["rtol"] == _tolerances(rows)[1])])
    ida = next(row for row in rows if row["solver"] == "ida")
    limited = next(row for row in rows if row["solver"] == "cvode_bdf" and number(row["max_order"]) == "2")
    return must(ida["steps"] > limited["steps"],
                f"`ida` took {_whole(ida['steps'])} steps for {number(ida['digits'])} digits. `cvode_bdf` limited to order 2 took "
                f"{_whole(limited['steps'])} steps for {number(limited['digits'])} digits")


def index3(tables):
    """Returns how many runs of the DAE solvers ended on the forms with positions as constraints."""
    rows = tables["other_solvers"]
    rows = rows[(rows["formulation"] == "index3") & (rows["package"] != "tress")]
    return (f"Here, {code(dict.fromkeys(rows['solver']))} reached the end in {(rows['status'] == 'ok').sum()} of "
            f"{counted(len(rows), 'run')} on `index3`.")


def replaced(tables):
    """Returns how many runs were made later than the others, by commit, from the record of the table."""
    counts = {}
    for line in tables.manifest("other_solvers").get("merged_from", []):
        count, commit = re.fullmatch(r"(\d+) runs? replaced at commit (\w+)", line).groups()
        counts[commit] = counts.get(commit, 0) + int(count)
    of = ", ".join(f"{counted(count, 'run')} at commit {commit}" for commit, count in counts.items())
    return f"Later runs replaced earlier ones of the table: {of}." if counts else ""
