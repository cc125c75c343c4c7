"""Share of a groom that must be simulated."""
from .tables import first, groups, known, records
from .words import must, number, percent, span, table

_PRECISIONS = {32: "single", 64: "double"}


def answers(tables):
    """Returns the cheapest way to each target error. Where the status is not ok, there is none."""
    return tables.rows("head_accuracy", {"kind": "cheapest"})


def _met(tables):
    rows = answers(tables)
    return rows[rows["status"] == "ok"]


def _every(row):
    return row["guides"] == row["strands"]


def _words(row):
    hairs = f"each of {row['strands']} hairs" if _every(row) else f"{row['guides']:.0f} guides for {row['strands']} hairs"
    return (f"{hairs}, {row['elements']:.0f} elements, steps of {number(1e3 * row['dt_s'])} ms, "
            f"{row['precision']:.0f}-bit precision")


def answer(tables):
    """Returns the answer for the shipped groom and the smallest target error."""
    rows = _met(tables)
    row = first(rows[rows["scene"] == "full_head"].sort_values("target_error_rel", kind="stable"))
    must(row is not None, "the shipped head has an answer")
    following = (f" Hairs that follow {row['best_guides']:.0f} guides have an error of {percent(row['best_interpolation_rel'])}."
                 if _every(row) and row["best_guides"] > 0 else "")
    return (f"For {percent(row['target_error_rel'])} on `{row['scene']}`, take {_words(row)}. Of {row['looked_at']} sampled "
            f"hairs, 95 % have an error below {percent(row['error_p95_rel'])} of their length (mean {percent(row['error_mean_rel'])}, "
            f"largest {percent(row['error_max_rel'])}). A frame takes {number(row['ms_per_frame'])} ms.{following}")


def over(tables):
    return {
        "p95": "The target is the error that 95 % of the sampled hairs do not exceed.",
        "mean": "The target is the mean over the sampled hairs.",
        "largest": "The target is the largest error of the sampled hairs.",
    }[answers(tables).iloc[0]["over"]]


def answers_table(tables):
    def line(row):
        head = [f"`{row['scene']}`", percent(row["target_error_rel"]), row["looked_at"]]
        if row["status"] != "ok":
            return [*head, row["reason"], "", "", "", "", ""]
        return [
            *head, f"all {row['strands']}" if _every(row) else f"{row['guides']:.0f} of {row['strands']}",
            f"{row['elements']:.0f}, {number(1e3 * row['dt_s'])} ms, {row['precision']:.0f}",
            f"{percent(row['error_mean_rel'])}, {percent(row['error_p95_rel'])}, {percent(row['error_max_rel'])}",
            f"none; following {row['best_guides']:.0f}: {percent(row['best_interpolation_rel'])}" if _every(row) else
            percent(row["interpolation_p95_rel"]),
            percent(row["simulated_p95_rel"]), f"{number(row['step_ms_per_frame'])}, {number(row['follow_ms_per_frame'])}"]

    return table(
        ["groom", "target", "sampled hairs", "simulated", "elements, step, bits", "error: mean, 95 %, largest",
         "error of interpolation", "error of elements and step", "ms per frame: simulated, following"],
        map(line, records(answers(tables))))


def by_hair(tables):
    """Returns, for each kind of hair and target error, the stricter part of the answers for every motion: the
    larger number of elements and the shorter step."""
    rows = answers(tables)
    named = rows["scene"].str.extract(r"^(?P<shape>\w+)_(?P<variation>alike|varied)_\w+$")
    lines = []
    of_hair = groups(rows.join(named).dropna(subset="shape"), ["shape", "variation", "target_error_rel"])
    for (shape, variation, target), all_of in of_hair:
        head = [shape, {"alike": "equal", "varied": "different"}[variation], percent(target)]
        if (all_of["status"] != "ok").any():
            lines.append([*head, "no tried run keeps it", "", "", ""])
            continue
        share = "all" if all_of.apply(_every, axis=1).any() else span(all_of["guides"] / all_of["strands"], percent)
        lines.append([*head, share, f"{all_of['elements'].max():.0f}", f"{number(1e3 * all_of['dt_s'].min())} ms",
                      " or ".join(_PRECISIONS[bits] for bits in sorted(all_of["precision"].unique()))])
    return table(["hair", "lengths and curls", "target", "simulated", "elements", "step", "precision"], lines)


def findings(tables):
    """Returns how the variation between hairs decides."""
    rows = _met(tables)
    alike, varied = (rows[rows["scene"].str.contains(kind)] for kind in ("alike", "varied"))
    few = alike[~_every(alike)]
    must(len(few) > 0 and len(few) > len(alike) / 2, "most grooms of equal hairs need few guides")
    must(len(varied) > 0 and _every(varied).all(), "varied hairs must all be simulated")
    off = varied["best_interpolation_rel"]
    return (f"In {len(few)} of {len(alike)} answers for grooms of equal hairs, {span(few['guides'] / few['strands'], percent)} of "
            "the hairs are enough as guides. Hairs that differ in length, curl and phase must all be simulated "
            f"({len(varied)} of {len(varied)} answers): hairs that follow the best guides have errors of {span(off[known(off)], percent)}.")
