"""Friction, drag and stiffness that a measured oscillation determines."""
from .tables import known, records
from .words import must, number, spaced, table

_FRICTION, _DRAG, _MODULUS = 1e-10, 1e-5, 1e9  # units of the table


def _estimate(value, low, high, unit):
    """Returns a value and its interval. A value that was given has no interval."""
    value, low, high = (number(x / unit, 3) if x != "" else "" for x in (value, low, high))
    return f"{value} [{low}, {high}]" if low else f"{value} (given)"


def fits_table(tables):
    return table(
        ["records", "fitted", "by", f"γ / {number(_FRICTION)}", f"ν / {number(_DRAG)}", "E / GPa", "verdict"],
        [[f"{spaced(row['data'])}, {row['signal']}", row["fit"], f"`{row['integrator']}`",
          _estimate(row["internal_friction_kg_m3_s"], row["internal_friction_low_kg_m3_s"],
                    row["internal_friction_high_kg_m3_s"], _FRICTION),
          _estimate(row["drag_kg_m_s"], row["drag_low_kg_m_s"], row["drag_high_kg_m_s"], _DRAG),
          _estimate(row["youngs_modulus_pa"], row["youngs_modulus_low_pa"], row["youngs_modulus_high_pa"], _MODULUS),
          "" if row["status"] == "ok" else f"flagged: {row['reason']}"]
         for row in records(tables["calibrate"])])


def truth(tables):
    """Returns the values that all records share: "γ = 1e-10 kg m³/s, ν = 2e-5 kg/(m s) and E = 3 GPa"."""
    rows = tables["calibrate"]

    def of(column):
        found = rows[column][known(rows[column])].unique()
        must(len(found) == 1, f"all records have the same {column}")
        return found[0]

    return (f"γ = {number(of('internal_friction_true_kg_m3_s'))} kg m³/s, ν = {number(of('drag_true_kg_m_s'))} kg/(m s) and "
            f"E = {number(of('youngs_modulus_true_pa') / _MODULUS)} GPa")
