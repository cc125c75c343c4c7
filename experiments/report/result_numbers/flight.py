"""Momentum and energy of a hair thrown in space, by integrator."""
from .tables import groups, known
from .words import code, duration, number, percent, signed_percent, span, table


def _whole(tables):
    rows = tables.ok_rows("validation", {"test": "free_flight"})
    return rows[known(rows["dt_s"])]


def seconds(tables):
    """Returns the duration: "0.5 s". A last step may pass the end by its rounding."""
    return f"{number(_whole(tables)['t_end_s'].max())} s"


def _changes(members):
    """Returns a line for all models of the same printed changes."""
    models = {}
    for model, own in groups(members, "model"):
        row = own.iloc[0]
        changes = (f"{signed_percent(row['angular_change_rel'])}, {percent(row['angular_error_rel'])}, "
                   f"{signed_percent(row['energy_change_rel'])}")
        models.setdefault(changes, []).append(model)
    return "<br>".join(f"{code(names)}: {changes}" for changes, names in models.items())


def change_table(tables):
    """Returns, by integrator and model, the change of the size of angular momentum, its largest error as a
    vector, and the change of energy."""
    rows = _whole(tables)
    steps = sorted(rows["dt_s"].unique(), reverse=True)
    return table(["integrator", *(f"at {duration(dt)}" for dt in steps)],
                 [[f"`{integrator}`", *(_changes(members[members["dt_s"] == dt]) for dt in steps)]
                  for integrator, members in groups(rows, "integrator")])


def backward_euler_loss(tables):
    """Returns the range of losses over all models that finish at the longest step."""
    rows = _whole(tables)
    rows = rows[rows["integrator"] == "backward_euler"]
    return span(rows[rows["dt_s"] == rows["dt_s"].max()]["angular_change_rel"], percent)
