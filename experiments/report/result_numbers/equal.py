"""Cost of one per cent with every strand model."""
from .tables import groups, least, positive
from .words import duration, number, table


def variant_name(model, options):
    """Returns the model with its option: "`der`, inextensible"."""
    return f"`{model}`" + (f", {options.split('=')[-1]}" if options else "")


def _scene_table(tables, scene):
    rows = tables.ok_rows("cost_of_accuracy", {"kind": "method", "scene": scene})
    rows = rows[positive(rows["wall_s_per_sim_s"])]
    names = rows[["model", "options"]].apply(lambda row: variant_name(*row), axis=1)
    best = [(name, least(members, "wall_s_per_sim_s")) for name, members in groups(rows, names)]
    best.sort(key=lambda pair: pair[1]["wall_s_per_sim_s"])
    return table(
        ["model", "time a simulated second", "integrator", "elements, step", "unknowns", "length error", "energy error",
         "linear, angular momentum error"],
        [[name, duration(row["wall_s_per_sim_s"]), f"`{row['integrator']}`", f"{row['elements']:.0f}, {duration(row['dt_s'])}",
          row["unknowns"], number(row["length_error_rel"]), number(row["energy_error_rel"]),
          ", ".join(filter(None, [number(row["linear_error_rel"]), number(row["angular_error_rel"])]))]
         for name, row in best])


def release(tables):
    return _scene_table(tables, "release")


def flight(tables):
    return _scene_table(tables, "flight")
