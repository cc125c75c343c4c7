"""Cost of a groom that processes divide."""
from .tables import groups, known, positive, records
from .words import is_number, number, percent, plain, span, table


def _milli(seconds):
    return number(1e3 * seconds) if is_number(seconds) and seconds > 0 else ""


def _micro(seconds):
    return number(1e6 * seconds) if is_number(seconds) and seconds > 0 else ""


def _measured(tables):
    return tables.ok_rows("divided_heads", {"kind": "measured"})


def measured_table(tables):
    return table(
        ["hairs", "effects with gravity", "processes", "grooms at once", "a step, ms", "model, ms", "model off by",
         "off by, fitted without that number of hairs", "ghosts per hair", "model", "to find them, per element, µs",
         "to exchange them", "to list contacts", "memory of a process, MB", "checksum of the states"],
        [[row["strands"], row["effects"], row["ranks"], row["beside"], _milli(row["cost_per_step_s"]),
          _milli(row["model_cost_per_step_s"]), percent(row["model_off_rel"]), percent(row["held_out_off_rel"]),
          number(row["ghosts_per_strand"]), number(row["model_ghosts_per_strand"]) if row["model_ghosts_per_strand"] > 0 else "",
          _micro(row["ghost_search_per_element_s"]), _micro(row["halo_exchange_per_element_s"]), _micro(row["ghost_contact_per_element_s"]),
          number(row["memory_mb"]), str(row["state_hash"])[:8]]
         for row in records(_measured(tables))])


def weak_table(tables):
    """Returns the weak scaling: the same number of hairs on each of more processes."""
    rows = _measured(tables)
    rows = rows[rows["beside"] == 1]
    own = rows["strands"].min()
    lines = []
    for row in records(rows[rows["strands"] == own * rows["ranks"]]):
        one = rows[(rows["effects"] == row["effects"]) & (rows["strands"] == own) & (rows["ranks"] == 1)].iloc[0]
        lines.append([row["effects"], row["ranks"], row["strands"], _milli(row["cost_per_step_s"]),
                      number(row["cost_per_step_s"] / one["cost_per_step_s"]),
                      number(row["model_cost_per_step_s"] / one["model_cost_per_step_s"])])
    return table(["effects with gravity", "processes", "hairs", "a step, ms", "over that of one process", "model"], lines)


def predicted_table(tables):
    rows = tables.ok_rows("divided_heads", {"kind": "predicted"})
    ranks = sorted(rows["ranks"].unique())
    lines = []
    for (effects, strands), members in groups(rows, ["effects", "strands"]):
        costs = {row["ranks"]: f"{_milli(row['model_cost_per_step_s'])} ({percent(row['efficiency'])})"
                 for row in records(members[positive(members["model_cost_per_step_s"])])}
        lines.append([effects, strands, *(costs.get(count, "") for count in ranks)])
    return table(["effects with gravity", "hairs", *(f"R = {plain(count)}" for count in ranks)], lines)


def _largest(tables, column):
    """Returns the largest difference with one and two processes, which have a core each."""
    rows = _measured(tables)
    rows = rows[(rows["ranks"] <= 2) & (rows["beside"] == 1) & known(rows[column])]
    return percent(rows[column].abs().max())


def off(tables):
    return _largest(tables, "model_off_rel")


def held_out(tables):
    return _largest(tables, "held_out_off_rel")


def exchange(tables):
    rows = _measured(tables)
    return _micro(rows["halo_exchange_per_element_s"][rows["ranks"] == 2].max())


def extent(tables):
    """Returns the numbers of runs, processes, hairs and cores that were measured."""
    rows = _measured(tables)
    ranks, cores = (", ".join(map(plain, sorted(rows[column].unique()))) for column in ("ranks", "cores"))
    return f"{len(rows)} runs with {ranks} processes and {span(rows['strands'])} hairs on {cores} cores"
