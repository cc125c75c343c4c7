"""Other simulators on the swinging strand: how their table was made, and how well they agree."""
from .machine import minutes_of
from .tables import known
from .words import number, span


def minutes(tables):
    return minutes_of([tables.manifest("other_simulators")])


def load(tables):
    machine = tables.manifest("other_simulators")["machine"]
    before, cpus = machine["load_before"][0], machine["cpus"]
    uncertain = ": its times are uncertain" if before > cpus else ""
    return f"the load before it was {number(before)} on {cpus} processors{uncertain}"


def apart(tables):
    """Returns how far the engines are apart: "1.4 mm with universal joints, 0 to 0.024 mm with other
    joints"."""
    rows = tables.rows("other_simulators", {"precision": "double"})
    rows = rows[known(rows["apart_mm"])]
    universal = rows["method"].str.contains("universal")
    return (f"{span(rows['apart_mm'][universal])} mm with universal joints and {span(rows['apart_mm'][~universal])} mm with other "
            f"joints, over {len(rows)} methods in double precision")


def published(tables):
    return len(tables["other_simulators_swing"])
