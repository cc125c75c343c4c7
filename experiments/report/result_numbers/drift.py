"""Length errors of a shaken hair, by formulation."""
from .tables import groups, records
from .words import duration, number, table


def lengths_table(tables):
    rows = tables.rows("constraint_drift", {"study": "strands"})
    steps = sorted(rows["dt_s"].unique(), reverse=True)
    lines = []
    for (system, variant, formulation, integrator), members in groups(
            rows, ["system", "variant", "formulation", "integrator"]):
        by_step = {row["dt_s"]: row for row in reversed(records(members))}
        cells = [by_step.get(dt) for dt in steps]
        lines.append([f"`{system}`{f' ({variant})' if variant else ''}", formulation, f"`{integrator}`",
                      *("" if row is None else number(row["length_error_rel"]) if row["status"] == "ok" else
                        f"fails ({row['status']})" for row in cells)])
    return table(["model", "formulation", "integrator", *(f"at {duration(dt)}" for dt in steps)], lines)
