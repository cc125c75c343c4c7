"""Cost of a step against elements, and the published table."""
from .report import quoted
from .tables import groups, positive
from .words import is_number, number, span, spaced, table


def _micro(row):
    cost = row["cost_per_step_s"] if row and row["status"] == "ok" else None
    return number(1e6 * cost) if is_number(cost) and cost > 0 else ""


def _frames(row, column):
    return row[column] if row else None


def source_table(tables):
    pairs = [pair for pair in quoted(tables, "solver_pairs")
             if pair["structure"] != "straight"
             or any((_frames(pair.get(solver), "published_fps") or 0) > 0 for solver in ("composite", "recursive"))]
    return table(
        ["structure", "elements", "recursive, µs a step", "composite, µs a step", "composite / recursive",
         "the published ratio", "recursive, frames/s", "published, recursive", "published, composite"],
        [[spaced(pair["structure"]), pair["elements"], _micro(pair.get("recursive")), _micro(pair.get("composite")),
          number(pair.get("ours")), number(pair.get("source")), number(_frames(pair.get("recursive"), "fps")),
          number(_frames(pair.get("recursive"), "published_fps")), number(_frames(pair.get("composite"), "published_fps"))]
         for pair in pairs])


def element_table(tables):
    """Returns the cost of an element and step (µs) from 20 elements on, by model, solver and Jacobian."""
    rows = tables.ok_rows("scaling", {"structure": "straight"})
    rows = rows[(rows["elements"] >= 20) & positive(rows["cost_per_element_step_s"])]
    return table(
        ["model", "solver", "jacobian", "modes", "elements", "µs an element and step"],
        [[f"`{model}`", solver, jacobian, modes, span(members["elements"]), span(1e6 * members["cost_per_element_step_s"])]
         for (model, solver, jacobian, modes), members in groups(rows, ["model", "solver", "jacobian", "modes"])])
