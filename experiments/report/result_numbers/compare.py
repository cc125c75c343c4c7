"""Verdicts of ./tress compare on a build against itself, and against a slowed build."""
from .words import percent, span


def itself(tables):
    rows = tables["compare_itself"]
    same, slowed = rows[rows["beside"] == "itself"], rows[rows["beside"] == "slowed"]
    found = (slowed["verdict"] == "slower").sum()
    return (f"{same['wrong'].sum()} false verdicts of {same['rows'].sum()} in {len(same)} runs against itself. "
            f"The slowed kernel was found in {found} of {len(slowed)} runs, {span(slowed['ratio'] - 1, percent)} slower, "
            f"with {slowed['wrong'].sum()} wrong verdicts on all rows.")
