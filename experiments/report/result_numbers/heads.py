"""Cost of grooms."""
from .tables import groups, least, read_table, records
from .words import counted, number, percent, span, table

_PUBLISHED = "experiments/heads/published.csv"


def _all(tables):
    return tables.ok_rows("heads", {})


def _helices(tables):
    """Returns the grooms of super-helices with one solve per step."""
    return tables.ok_rows("heads", {"model": "super_helix", "integrator": "linearly_implicit_euler"})


def _heads(tables):
    rows = _helices(tables)
    return rows[rows["effects"] == "drag"]


def _largest(tables):
    rows = _heads(tables)
    return rows[rows["strands"] == rows["strands"].max()]


def _eight_lanes(rows):
    """Returns the runs with one thread and eight lanes in double precision."""
    return rows[(rows["precision"] == 64) & (rows["simd_width"] == 8) & (rows["threads"] == 1)]


def _difference(row):
    """Returns the difference from double precision; 0 for a run in double precision."""
    return number(row["difference_rel"]) or "0"


def cost_table(tables):
    return table(
        ["hairs", "precision, bits", "SIMD lanes", "threads", "memory per hair, bytes", "a step, ms", "per element, ns",
         "a frame of 1/60 s with its points, ms", "difference from double precision", "checksum of the states"],
        [[row["strands"], row["precision"], row["simd_width"], row["threads"], number(row["bytes_per_strand"]),
          number(1e3 * row["cost_per_step_s"]), number(1e9 * row["cost_per_element_step_s"]),
          number(1e3 * row["cost_per_frame_s"]), _difference(row), row["state_hash"][:8]]
         for row in records(_heads(tables))])


def effect_table(tables):
    """Returns the cost by effect and number of hairs."""
    rows = _eight_lanes(_helices(tables))
    cost = {(row["strands"], row["effects"]): number(1e9 * row["cost_per_element_step_s"]) for row in reversed(records(rows))}
    return table(["hairs", "gravity: ns per element", "and drag", "drag and a head", "drag and interaction"],
                 [[strands, *(cost.get((strands, effects), "") for effects in ("none", "drag", "body", "interaction"))]
                  for strands in rows["strands"].unique()])


def _processors(tables):
    return tables.manifest("heads")["machine"]["cpus"]


def fastest(tables):
    """Returns the fastest run of the largest groom in each precision, with no more threads than
    processors."""
    cpus = _processors(tables)
    rows = _largest(tables)
    words = []
    for bits, precision in ((64, "double"), (32, "single")):
        row = least(rows[(rows["precision"] == bits) & (rows["threads"] <= cpus)], "cost_per_step_s")
        words.append(f"{number(1e3 * row['cost_per_step_s'])} ms in {precision} precision ({row['simd_width']} SIMD lanes, "
                     f"{counted(row['threads'], 'thread')})")
    return f"{', '.join(words)} on {cpus} processors"


def _element_times(tables, bits):
    """Returns pairs of threads and time (s) per hair, element and step of the largest groom: of the
    fastest run with one thread, and of the fastest run with no more threads than processors."""
    rows = _largest(tables)
    rows = rows[(rows["precision"] == bits) & (rows["threads"] <= _processors(tables))]
    runs = (least(some, "cost_per_step_s") for some in (rows[rows["threads"] == 1], rows))
    return dict((row["threads"], row["cost_per_step_s"] / (row["strands"] * row["elements"])) for row in runs if row is not None)


def _with_threads(times, text):
    """Returns "1 s with one thread and 0.5 s with 2 threads"."""
    return " and ".join(f"{text(time)} with {'one thread' if threads == 1 else f'{threads} threads'}" for threads, time in times.items())


def per_element(tables):
    """Returns the time per hair, element and step of the largest groom, by precision and threads."""
    return " ".join(f"In {precision} precision it is {_with_threads(_element_times(tables, bits), lambda time: f'{number(1e9 * time)} ns')}."
                    for bits, precision in ((64, "double"), (32, "single")))


def frame_example(tables):
    """Returns the time of a frame of 100 000 hairs of 10 elements in 5 steps, in double precision."""
    return _with_threads(_element_times(tables, 64), lambda time: f"{number(100_000 * 10 * 5 * time)} s")


def bytes_per_element(tables):
    """Returns the memory per hair and element in double precision."""
    row = _largest(tables)[lambda rows: rows["precision"] == 64].iloc[0]
    return number(row["bytes_per_strand"] / row["elements"])


def oversubscribed(tables):
    """Returns the number of runs with more threads than processors, and the runs whose times are
    unreliable."""
    cpus = _processors(tables)
    rows = _heads(tables)
    over = rows[rows["threads"] > cpus]
    if over.empty:
        return "No row has more threads than processors"
    full = rows[rows["threads"] == cpus].drop_duplicates(["strands", "precision", "simd_width"])
    odd = over.merge(full, on=["strands", "precision", "simd_width"], suffixes=("", "_full"))
    odd = odd[odd["cost_per_step_s_full"] > 1.1 * odd["cost_per_step_s"]]
    words = "; ".join(f"{row['strands']} hairs in {row['precision']}-bit precision take {number(1e3 * row['cost_per_step_s_full'])} ms "
                      f"with {counted(row['threads_full'], 'thread')} and {number(1e3 * row['cost_per_step_s'])} ms with {row['threads']}"
                      for row in records(odd))
    unreliable = f"; where the table has them so, the times are unreliable ({words})" if words else ""
    return (f"{len(over)} of {len(rows)} rows have more threads than the machine's {cpus} processors, to show that the states "
            f"stay the same. More threads cannot be faster there{unreliable}")


def largest_head(tables):
    return _largest(tables).iloc[0]["strands"]


def elements(tables):
    return _largest(tables).iloc[0]["elements"]


def build(tables):
    return number(_largest(tables)["build_s"].max())


def _damped(rows):
    """Selects runs with Euler's methods, in steps that have one solution."""
    return rows["integrator"].str.endswith("_euler") & (rows["dt_s"] <= 1 / 120)


def narrow(tables):
    rows = _all(tables)
    return number(rows["difference_rel"][_damped(rows) & (rows["precision"] == 32)].max())


def narrow_otherwise(tables):
    """Returns the largest difference of the other runs in single precision."""
    rows = _all(tables)
    return number(rows["difference_rel"][~_damped(rows) & (rows["precision"] == 32)].max())


def two_threads(tables):
    """Returns the time of one thread over that of two, for every number of hairs."""
    rows = _heads(tables)
    rows = rows[rows["simd_width"] == 8]
    cost = {(row["strands"], row["precision"], row["threads"]): row["cost_per_step_s"] for row in reversed(records(rows))}
    words = (f"{', '.join(number(cost[strands, bits, 1] / cost[strands, bits, 2]) for bits in (64, 32))} for {strands} hairs"
             for strands in rows["strands"].unique())
    return "; ".join(words)


def effect_noise(tables):
    """Returns the largest gain from an added effect, which is noise of the timing."""
    rows = _eight_lanes(_helices(tables))
    bare, drag = (rows[rows["effects"] == effects].drop_duplicates("strands") for effects in ("none", "drag"))
    both = bare.merge(drag, on="strands", suffixes=("", "_drag"))
    most = (1 - both["cost_per_step_s_drag"] / both["cost_per_step_s"]).max()
    if not most > 0:
        return "No added effect makes a step cheaper"
    return (f"Drag cannot make a step cheaper, yet the table has it {percent(most)} cheaper: differences of that size are noise "
            "of the timing")


def chain_over_helix(tables):
    """Returns the time of a chain's step over that of a super-helix with the same number of elements, by
    method."""
    rows = _eight_lanes(_all(tables))
    rows = rows[rows["effects"] == "drag"]
    same = ["integrator", "dt_s", "strands", "elements"]
    helices = rows[rows["model"] == "super_helix"].drop_duplicates(same)
    pairs = rows[rows["model"] == "articulated_chain"].merge(helices, on=same, suffixes=("", "_helix"))
    ratio = pairs["cost_per_step_s"] / pairs["cost_per_step_s_helix"]
    return ", ".join(f"{span(members)} with `{integrator}`" for integrator, members in groups(ratio, pairs["integrator"]))


def other_heads_table(tables):
    """Returns other models and methods with one thread."""
    rows = _all(tables)
    others = (rows["model"] != "super_helix") | (rows["integrator"] != "linearly_implicit_euler")
    lines = []
    for row in records(rows[others & (rows["threads"] == 1) & (rows["simd_width"] > 1)]):
        iterated = (["1", "1", "0", "0"] if row["integrator"] == "linearly_implicit_euler" else
                    [number(row["iterations_per_step"]), number(row["lanes_per_iteration"]), number(100 * row["retried_share"]),
                     number(100 * row["retry_lane_share"])])
        lines.append([row["model"], row["integrator"], number(1e3 * row["dt_s"]), row["strands"], row["precision"], row["simd_width"],
                      number(row["bytes_per_strand"]), number(1e3 * row["cost_per_step_s"]),
                      number(1e9 * row["cost_per_element_step_s"]), *iterated, row["failed"], _difference(row), row["state_hash"][:8]])
    return table(
        ["model", "method", "step, ms", "hairs", "precision, bits", "SIMD lanes", "memory per hair, bytes", "a step, ms",
         "per element, ns", "iterations a step", "lanes over hairs iterated", "damped steps, %", "lanes they take, %",
         "failed hairs", "difference from double precision", "checksum of the states"], lines)


_EFFECTS = {
    "drag": "gravity and drag",
    "body": "gravity, drag, contact with a head",
    "interaction": "gravity, drag, repulsion and drag between hairs",
}


def published_table(tables):
    """Returns published costs, and the fastest run here of each size and effect. A frame here is 1/60 s."""
    published = read_table(tables.root / _PUBLISHED, _PUBLISHED)
    lines = published[["source", "computed", "machine", "strands", "cost_per_frame_s"]].values.tolist()
    rows = _helices(tables)
    rows = rows[rows["precision"] == 64]
    for strands in rows["strands"].unique():
        for effects, computed in _EFFECTS.items():
            row = least(rows[(rows["strands"] == strands) & (rows["effects"] == effects)], "cost_per_frame_s")
            if row is not None:
                lines.append(["here", f"super-helices of {row['elements']} elements, steps of {number(1e3 * row['dt_s'])} ms; "
                              f"{computed}", counted(row["threads"], "thread"), strands, row["cost_per_frame_s"]])
    return table(["source", "what is computed", "on", "hairs", "a frame, s", "of a hair, µs"],
                 [[*line, strands, number(cost), number(1e6 * cost / strands)] for *line, strands, cost in lines])
