"""Energy that methods remove from a hair that swings without friction."""
from .tables import groups, records
from .words import must, percent, span, step, table


def losses(tables):
    rows = tables["damping"]
    steps = sorted(rows["dt_s"].unique(), reverse=True)
    lines = []
    for run, members in groups(rows, ["model", "integrator"]):
        by_step = {row["dt_s"]: row for row in reversed(records(members))}
        cells = [by_step.get(dt) for dt in steps]
        lines.append([*run, *("" if row is None else
                              percent(row["energy_lost_rel"]) if row["status"] == "ok" else row["status"] for row in cells)])
    return table(["model", "method", *map(step, steps)], lines)


def not_monotone(tables):
    """Returns the methods that remove less energy at a longer step, and the steps at which they fail."""
    found = []
    for (model, integrator), members in groups(tables["damping"], ["model", "integrator"]):
        ok = members["status"] == "ok"
        failed = [f"{row['status']} at {step(row['dt_s'])}" for row in records(members[~ok])]
        breaks = f", and is {', '.join(failed)}" if failed else ""
        own = records(members[ok & (members["energy_lost_rel"] > 0.01)].sort_values("dt_s"))
        found += [f"`{model}` with `{integrator}` loses {percent(longer['energy_lost_rel'])} at {step(longer['dt_s'])} "
                  f"and {percent(shorter['energy_lost_rel'])} at {step(shorter['dt_s'])}{breaks}"
                  for shorter, longer in zip(own, own[1:]) if longer["energy_lost_rel"] < shorter["energy_lost_rel"]]
    if not found:
        return "No run that loses more than 1 % loses less at a longer step"
    return f"A smaller loss at a longer step is no merit: {'; '.join(found)}"


def order_two_loss(tables):
    """Returns the losses of the other methods at the longest step, the least first, and the runs that ended early."""
    rows = tables["damping"]
    longest = rows["dt_s"].max()
    rows = rows[(rows["dt_s"] == longest) & ~rows["integrator"].str.endswith("_euler")]
    early = rows[rows["status"] != "ok"]
    losses = {integrator: members["energy_lost_rel"]
              for integrator, members in groups(rows[~rows["integrator"].isin(early["integrator"])], "integrator")}
    (least, loss), *others = sorted(losses.items(), key=lambda one: one[1].abs().max())
    must(least == "tr_bdf2", "the advised method loses least at the longest step")
    ended = [f"`{row['integrator']}` on `{row['model']}` ({row['status']})" for row in records(early)]
    return (f"At steps of {step(longest)}, `{least}` removes {span(loss, percent)} of the energy"
            + "".join(f", `{integrator}` {span(one, percent)}" for integrator, one in others)
            + (f". Runs that ended early: {', '.join(ended)}" if ended else ""))


def euler_loss(tables):
    """Returns the range of losses of the Euler methods over all their steps."""
    rows = tables.ok_rows("damping", {})
    taken = rows[rows["integrator"].str.endswith("_euler")]["energy_lost_rel"]
    must((taken > 0).all(), "Euler methods lose energy")
    return span(taken, percent)
