"""Cost of full sweeps over every row."""
from .tables import records
from .words import counted, number, table


def full_table(tables):
    return table(
        ["experiment", "rows", "of which timed", "a row, s", "core hours", "memory, MB"],
        [[f"`{row['experiment']}`", row["rows"], row["timed_rows"], number(row["row_s"]),
          f"{'more than ' if row['cut_off_rows'] > 0 else ''}{number(row['core_hours'])}", row["memory_mb"]]
         for row in records(tables["full_sweeps"])])


def full_hours(tables):
    """Returns the core hours of the experiments of the table together."""
    return number(sum(tables["full_sweeps"]["core_hours"]))


def full_count(tables):
    return counted(len(tables["full_sweeps"]), "experiment")
