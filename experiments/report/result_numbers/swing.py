"""Accuracy on the swinging strand, compared with other simulators."""
from .report import quoted, rows
from .tables import least, positive
from .words import duration, table


def _ours(tables, runs, error):
    own = rows(tables, runs)
    best = least(own[own["error_rel"] <= error], "wall_s")
    if best is None:
        return "none"
    return f"{duration(best['wall_s'])}, `{best['model']}`, `{best['integrator']}`, {best['elements']} elements"


def _others(tables, column):
    best = least(tables["other_simulators_swing"][positive(tables["other_simulators_swing"][column])], column)
    return f"{duration(best[column])}, {best['simulator']}"


def best_table(tables):
    one, tenth = quoted(tables, "swing_levels")
    return table(
        ["", "1 % in time", "0.1 % in time", "1 % in total"],
        [["tress, best", _ours(tables, "swing_by_time_error", one["error"]),
          _ours(tables, "swing_by_time_error", tenth["error"]), _ours(tables, "swing_by_total_error", one["error"])],
         [f"best of {len(tables['other_simulators_swing'])} others", _others(tables, one["simulator"]), _others(tables, tenth["simulator"]), ""]])
